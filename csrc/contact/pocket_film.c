/* Film between the flank of a roller and the faces of its pocket (contact/bar_film.h), with its slopes. */
#include "contact/bar_film.h"
#include "contact/pocket_view.h"

static void add_film_slope(trb_wrench *to, trb_vec3 arm, trb_wrench change)
{
  trb_add_slope(to, arm, change.force);
  to->moment = trb_add(to->moment, change.moment);
}

/* How the film's wrench follows the roller's motion: gap and approach, the speed with which oil is drawn in, and sliding. */
static void add_film_slopes(const trb_bar_film *film, const trb_bar_slice *slice, const trb_pocket_touch *c, const trb_touch *touch,
                            trb_vec3 arm, trb_slopes *slopes)
{
  for (int k = 0; k < 6; k++) {
    const trb_vec3 unit = trb_v(k % 3 == 0, k % 3 == 1, k % 3 == 2), moved = k < 3 ? unit : trb_cross(unit, arm);
    const double   deeper = trb_dot(c->normal, moved);
    const trb_vec3 slid = trb_axpy(moved, -deeper, c->normal);
    const double   turned = k < 3 ? 0.0 : trb_dot(film->along, trb_cross(unit, slice->arm));
    const double   faster = turned - 0.5 * trb_dot(film->along, slid);
    add_film_slope(&slopes->place[k], arm, trb_bar_change(film, &film->by_depth, deeper, c->normal, touch->sliding));
    if (k >= 3) trb_add_carried(&slopes->place[k], k, unit, c, arm, film->force, film->is.load);
    add_film_slope(&slopes->velocity[k], arm, trb_bar_change(film, &film->by_rate, deeper, c->normal, touch->sliding));
    add_film_slope(&slopes->velocity[k], arm, trb_bar_change(film, &film->by_speed, faster, c->normal, touch->sliding));
    trb_add_slope(&slopes->velocity[k], arm, trb_scale(-film->is.drag, slid));
  }
}

void trb_pocket_push_film(const trb_model *m, trb_pocket_view *p, const trb_pocket_touch *c, double radius, double width,
                          trb_counters *counters, trb_load *load, trb_pocket_sums *sums)
{
  const trb_vec3  arm = trb_sub(c->point, p->x), cage_arm = trb_sub(c->point, p->cage);
  const trb_touch touch =
      trb_touching(trb_add(p->v, trb_cross(p->omega, arm)), trb_add(p->cage_v, trb_cross(p->cage_omega, cage_arm)), c->normal);
  const trb_bar_slice slice = {.gap = -c->interference,
                               .radius = radius,
                               .width = width,
                               .normal = c->normal,
                               .axis = p->a,
                               .arm = trb_sub(arm, c->carried),
                               .turning = trb_sub(p->omega, p->cage_omega)};
  const trb_bar_film  film = trb_film_on_bar(m, &slice, &touch, p->slopes != NULL);
  counters->pocket_films++;
  p->force = trb_add(p->force, film.force);
  p->moment = trb_add(p->moment, trb_add(trb_cross(arm, film.force), film.couple));
  p->cage_force = trb_sub(p->cage_force, film.force);
  p->cage_moment = trb_sub(p->cage_moment, trb_add(trb_cross(cage_arm, film.force), film.couple));
  load->lost[TRB_BY_FILM] += film.lost;
  sums->force += film.is.load;
  sums->friction += trb_norm(trb_axpy(film.force, film.is.load, c->normal));
  if (p->slopes != NULL) add_film_slopes(&film, &slice, c, &touch, arm, p->slopes);
}
