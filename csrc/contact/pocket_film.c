/* Film between the flank of a roller and the faces of its pocket, slice by slice, with its slopes
 * (docs/theory/contacts.md#film-between-roller-and-pocket). All is seen from the face, as a rigid body at rest: the surfaces meet at a
 * point, the roller's surface moves there with u1 relative to the slice's centre, and the face's with u2, minus the centre's velocity along
 * the face. The film is drawn in with u = (u1 + u2)/2, and sheared with u1 - u2.
 *
 * The load W acts before the point of contact. Force and couple at the point are F = -W n + H e/2 - eta J (u1 - u2) and the moment of W, R H,
 * about the roller's axis; H is the integral of h dp/dx. What they lose is V W + u H + eta J (u1 - u2)^2: positive, whatever the motion. */
#include "contact/contact.h"
#include "contact/pocket_view.h"
#include "laws/squeeze.h"

/* What makes the force, or a slope of it. */
typedef struct trb_bar_parts {
  double load; /* W, N */
  double pull; /* H, N */
  double drag; /* eta J, N s/m */
} trb_bar_parts;

typedef struct trb_bar_film {
  trb_vec3      force, couple; /* on the roller, at the point of contact */
  trb_vec3      along;         /* e, in which u is counted */
  trb_vec3      lever;         /* couple over H, m */
  trb_bar_parts is;
  trb_bar_parts by_depth, by_rate, by_speed; /* slopes: with minus the gap, with V and with u; where they are asked for */
  double        lost;                        /* W */
} trb_bar_film;

/* A slice near a face. */
typedef struct trb_bar_slice {
  double   gap, radius, width; /* m */
  trb_vec3 normal, axis;       /* from the roller into the face; of the roller */
  trb_vec3 arm;                /* of the point of contact from the slice's centre, m */
  trb_vec3 turning;            /* angular velocity of the roller relative to the face, rad/s */
} trb_bar_slice;

/* The slope of the law's load is taken from a difference; that of its loss is twice the load. */
static trb_bar_film film_on_bar(const trb_model *m, const trb_pocket_inputs *pocket, const trb_bar_slice *at, const trb_touch *touch,
                                int with_slopes)
{
  const trb_params *p = &m->params;
  const double      least = pocket->roughness, h = trb_smooth_max(at->gap, least, least);
  const double      x = trb_clamp(at->gap / pocket->film, 0.0, 1.0), share = 1.0 - x * x * (3.0 - 2.0 * x);
  const trb_vec3    across = trb_cross(at->axis, at->normal), e = trb_scale(1.0 / trb_norm(across), across);
  const double      drawn = trb_dot(e, trb_cross(at->turning, at->arm)) - 0.5 * trb_dot(e, touch->sliding);
  const double      u = sqrt(drawn * drawn + p->friction.speed_floor * p->friction.speed_floor), root = sqrt(2.0 * at->radius / h),
                    s = touch->rate / u * root;
  const trb_squeeze film = trb_squeeze_film(s);
  const double      oil = p->oil.viscosity * at->width * share, scale = 24.0 * oil * u * at->radius / h, flow = 12.0 * oil * drawn * root;
  trb_bar_film      f;
  f.along = e;
  f.lever = trb_scale(-at->radius, trb_cross(at->normal, e));
  f.is = (trb_bar_parts){.load = scale * film.load, .pull = flow * (film.loss - s * film.load), .drag = oil * root * film.shear};
  f.force = trb_axpy(trb_axpy(trb_scale(-f.is.load, at->normal), 0.5 * f.is.pull, e), -f.is.drag, touch->sliding);
  f.couple = trb_scale(f.is.pull, f.lever);
  f.lost = -trb_dot(f.force, trb_axpy(touch->sliding, touch->rate, at->normal)) - trb_dot(f.couple, at->turning);
  f.by_depth = f.by_rate = f.by_speed = (trb_bar_parts){0.0, 0.0, 0.0};
  if (!with_slopes) return f;
  const double      step = 1e-4 * (1.0 + fabs(s)), bit = 1.0 / step;
  const trb_squeeze next = trb_squeeze_film(s + step);
  const double      rise = bit * (next.load - film.load), widens = bit * (next.shear - film.shear), bend = film.load - s * rise;
  const double      thinner = trb_clamp(at->gap / (2.0 * least), 0.0, 1.0) / h;
  const double      more = 6.0 * x * (1.0 - x) / (pocket->film * trb_max(share, 1e-9)), way = drawn / u;
  f.by_depth.load = f.is.load * (more + thinner) + 0.5 * scale * s * rise * thinner;
  f.by_depth.pull = f.is.pull * (more + 0.5 * thinner) + 0.5 * flow * s * bend * thinner;
  f.by_depth.drag = f.is.drag * (more + 0.5 * thinner) + 0.5 * oil * root * widens * s * thinner;
  f.by_rate.load = scale * rise * root / u;
  f.by_rate.pull = flow * bend * root / u;
  f.by_rate.drag = oil * root * widens * root / u;
  f.by_speed.load = scale * bend * way / u;
  f.by_speed.pull = 12.0 * oil * root * (film.loss - s * film.load) - flow * s * bend * way / u;
  f.by_speed.drag = -oil * root * widens * s * way / u;
  return f;
}

/* Change of the wrench by changes of gap, V or u. */
static trb_wrench change_of(const trb_bar_film *f, const trb_bar_parts *by, double change, trb_vec3 normal, trb_vec3 sliding)
{
  const trb_vec3 force = trb_axpy(trb_axpy(trb_scale(-by->load, normal), 0.5 * by->pull, f->along), -by->drag, sliding);
  return (trb_wrench){trb_scale(change, force), trb_scale(change * by->pull, f->lever)};
}

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
    add_film_slope(&slopes->place[k], arm, change_of(film, &film->by_depth, deeper, c->normal, touch->sliding));
    if (k >= 3) trb_add_carried(&slopes->place[k], k, unit, c, arm, film->force, film->is.load);
    add_film_slope(&slopes->velocity[k], arm, change_of(film, &film->by_rate, deeper, c->normal, touch->sliding));
    add_film_slope(&slopes->velocity[k], arm, change_of(film, &film->by_speed, faster, c->normal, touch->sliding));
    trb_add_slope(&slopes->velocity[k], arm, trb_scale(-film->is.drag, slid));
  }
}

void trb_pocket_push_film(const trb_model *m, trb_pocket_view *p, const trb_pocket_touch *c, double radius, double width,
                          trb_counters *counters, trb_load *load, trb_pocket_sums *sums)
{
  const trb_vec3      arm = trb_sub(c->point, p->x);
  const trb_touch     touch = trb_pocket_touching(p, c);
  const trb_bar_slice slice = {.gap = -c->interference,
                               .radius = radius,
                               .width = width,
                               .normal = c->normal,
                               .axis = p->a,
                               .arm = trb_sub(arm, c->carried),
                               .turning = trb_sub(p->omega, p->cage_omega)};
  const trb_bar_film  film = film_on_bar(m, &p->pockets->given, &slice, &touch, p->slopes != NULL);
  counters->pocket_films++;
  p->force = trb_add(p->force, film.force);
  p->moment = trb_add(p->moment, trb_add(trb_cross(arm, film.force), film.couple));
  p->cage_force = trb_sub(p->cage_force, film.force);
  p->cage_moment = trb_sub(p->cage_moment, trb_add(trb_cross(trb_sub(c->point, p->cage), film.force), film.couple));
  load->lost[TRB_BY_FILM] += film.lost;
  sums->force += film.is.load;
  sums->friction += trb_norm(trb_axpy(film.force, film.is.load, c->normal));
  if (p->slopes != NULL) add_film_slopes(&film, &slice, c, &touch, arm, p->slopes);
}
