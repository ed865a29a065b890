/* Roller in its cage pocket: a list of bounded faces, in the frame of the pocket (docs/theory/contacts.md#bounded-faces-of-pockets).
 *
 * A flank face meets the chain of inscribed spheres, a large-end face the end's sphere: interference = radius - distance of the centre
 * from the bounded polygon. A small-end face meets the roller's end plane with its vertices, each with its share of the stiffness.
 * All three depend on points that are fixed in their bodies, so contacts without friction conserve energy at edges and corners too. */
#include <math.h>
#include <string.h>

#include "contact/deformed.h"
#include "contact/facets.h"
#include "contact/pair.h"
#include "contact/pocket_view.h"
#include "laws/line_contact.h"
#include "surface/sphere.h"

/* Places seen from a face that has moved; then motions, too. Forces are sums over all faces. */
static void see_places(const trb_pocket_view *p, const trb_face_shift *s, trb_pocket_view *seen)
{
  seen->pockets = p->pockets;
  seen->x = trb_point_from(s, p->x);
  seen->a = trb_seen_from(s, p->a);
}

/* The velocity of the face's points is that of a rigid body: the cage's and its own. */
static void see_motions(const trb_pocket_view *p, const trb_face_shift *s, trb_pocket_view *seen)
{
  const trb_vec3 arm = trb_sub(trb_sub(p->cage, s->middle), s->shift);
  seen->cage = trb_point_from(s, p->cage);
  seen->v = trb_seen_from(s, p->v);
  seen->omega = trb_seen_from(s, p->omega);
  seen->cage_omega = trb_seen_from(s, trb_add(p->cage_omega, s->turn_rate));
  seen->cage_v = trb_seen_from(s, trb_add(trb_add(p->cage_v, s->shift_rate), trb_cross(s->turn_rate, arm)));
  seen->force = seen->moment = seen->cage_force = seen->cage_moment = trb_v(0, 0, 0);
}

/* Adds the loads that were found from the face to those of the pocket, and to those of the modes. */
static void add_seen(const trb_pocket_view *seen, const trb_face_shift *s, const trb_deformed *deformed, trb_pocket_view *p)
{
  const trb_wrench on_face = {trb_seen_back(s, seen->cage_force), trb_seen_back(s, seen->cage_moment)};
  p->force = trb_add(p->force, trb_seen_back(s, seen->force));
  p->moment = trb_add(p->moment, trb_seen_back(s, seen->moment));
  p->cage_force = trb_add(p->cage_force, on_face.force);
  p->cage_moment = trb_add(p->cage_moment, on_face.moment);
  trb_push_modes(deformed, s, p->cage, &on_face);
}

/* Exponent of the interference in a point contact's load. */
#define TRB_POINT_EXPONENT 1.5

static void view_places(const trb_roller_pose *r, const trb_rigid_pose *cage, int roller, trb_pocket_view *p)
{
  const trb_frame in_r = trb_compose(&cage->body, &p->pockets->axes[roller]);
  const trb_vec3  from_cage = trb_from_frame(&cage->body, p->pockets->origin[roller]);
  const trb_vec3  origin = trb_turn_z(trb_add(cage->x, from_cage), r->cosine, -r->sine);
  p->axes = (trb_frame){trb_turn_z(in_r.n, r->cosine, -r->sine), trb_turn_z(in_r.t, r->cosine, -r->sine),
                        trb_turn_z(in_r.a, r->cosine, -r->sine)};
  p->x = trb_to_frame(&p->axes, trb_sub(r->x, origin));
  p->a = trb_to_frame(&p->axes, r->frame.a);
}

static void view_motions(const trb_roller_pose *r, const trb_rigid_pose *cage, const trb_vec3 *pocket_origin, trb_pocket_view *p)
{
  const trb_vec3 from_cage = trb_turn_z(trb_from_frame(&cage->body, *pocket_origin), r->cosine, -r->sine);
  p->cage = trb_to_frame(&p->axes, trb_scale(-1.0, from_cage));
  p->v = trb_to_frame(&p->axes, r->v);
  p->omega = trb_to_frame(&p->axes, r->omega);
  p->cage_v = trb_to_frame(&p->axes, trb_turn_z(cage->v, r->cosine, -r->sine));
  p->cage_omega = trb_to_frame(&p->axes, trb_turn_z(cage->omega, r->cosine, -r->sine));
  p->force = p->moment = p->cage_force = p->cage_moment = trb_v(0, 0, 0);
}

/* d(-q n - q mu(v) s/v) for every motion: the load q follows interference and its rate, friction the load, and the sliding s of speed v. */
static void add_slopes(const trb_model *m, const trb_pocket_touch *c, const trb_touch *touch, const trb_push *is, trb_vec3 arm,
                       double coefficient, double factor, trb_slopes *slopes)
{
  const double   step = 1e-6 * touch->speed, more = m->pocket_friction ? factor * trb_sliding_coefficient(m, touch->speed + step) : 0.0;
  const double   bend = is->load * (more / (touch->speed + step) - is->mu / touch->speed) / (step * touch->speed);
  const double   stiffness = c->exponent * is->load / c->interference, damping = is->load > 0.0 ? coefficient * c->elastic : 0.0;
  const trb_vec3 load = trb_axpy(c->normal, is->mu / touch->speed, touch->sliding);
  const trb_vec3 units[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 6; k++) {
    const trb_vec3 unit = units[k % 3], moved = k < 3 ? unit : trb_cross(unit, arm);
    const double   deeper = trb_dot(c->normal, moved);
    const trb_vec3 slid = trb_axpy(moved, -deeper, c->normal);
    const trb_vec3 dragged = trb_add(trb_scale(is->drag, slid), trb_scale(bend * trb_dot(touch->sliding, slid), touch->sliding));
    trb_add_slope(&slopes->place[k], arm, trb_scale(-stiffness * deeper, load));
    trb_add_carried(&slopes->place[k], k, unit, c, arm, is->force, is->load);
    trb_add_slope(&slopes->velocity[k], arm, trb_sub(trb_scale(-damping * deeper, load), dragged));
  }
}

/* Adds the wrench of one point. */
static void push(const trb_model *m, const trb_pocket_face *f, trb_pocket_view *p, const trb_pocket_touch *c, trb_counters *counters,
                 trb_load *load, trb_pocket_sums *sums)
{
  const trb_vec3  arm = trb_sub(c->point, p->x);
  const trb_touch touch = trb_pocket_touching(p, c);
  const trb_push  is = trb_push_at(m, &touch, c->normal, c->elastic, p->pockets->damping, f->friction_factor, load->lost);
  p->force = trb_add(p->force, is.force);
  p->moment = trb_add(p->moment, trb_cross(arm, is.force));
  p->cage_force = trb_sub(p->cage_force, is.force);
  p->cage_moment = trb_sub(p->cage_moment, trb_cross(trb_sub(c->point, p->cage), is.force));
  load->elastic += c->elastic * c->interference / (1.0 + c->exponent);
  sums->force += is.load;
  sums->friction += is.load * is.mu;
  counters->pocket_nodes++;
  if (p->slopes != NULL) add_slopes(m, c, &touch, &is, arm, p->pockets->damping, f->friction_factor, p->slopes);
}

/* Interference of a sphere with a face, its centre h above the plane, and the normal from the centre to the nearest point. Without contact
 * it is the plane's, which is no less, unless it is wanted exactly. */
static double sphere_on_face(const trb_pockets *row, const trb_pocket_face *f, trb_vec3 centre, double h, double radius, int exact,
                             trb_vec3 *normal)
{
  if (row->given.edges <= 0.0 || (h >= radius && !exact)) return trb_sphere_on_plane(f->surface.normal, h, radius, normal);
  return trb_sphere_on_polygon(&f->surface, centre, h, radius, normal);
}

static void flank_on_face(const trb_model *m, const trb_facets *near, trb_pocket_view *p, int roller, int exact, trb_counters *counters,
                          trb_load *load, trb_pocket_sums *sums)
{
  const trb_pocket_face *f = near->first;
  const double *centre = m->centre + (size_t)roller * (size_t)m->n_lanes, *sphere = m->sphere + (size_t)roller * (size_t)m->n_lanes;
  const double *weight = m->race[TRB_RACE_OUTER].weight;
  const double  middle = trb_polygon_height(&f->surface, p->x), along = trb_dot(p->a, f->surface.normal), reach = p->pockets->film;
  double        least = -reach; /* interference up to which a node carries nothing */
  if (exact) least = -INFINITY;
  for (int k = 0; k < m->n_nodes; k++) {
    const double           h = middle + centre[k] * along;
    const trb_pocket_face *facet = f;
    trb_vec3               normal;
    const trb_vec3         c = trb_axpy(p->x, centre[k], p->a);
    double                 d;
    if (f->n_facets > 1) d = trb_facets_nearest(near, c, sphere[k], least, &facet, &normal);
    else if (h >= sphere[k] + reach && !exact) continue;
    else d = sphere_on_face(p->pockets, f, c, h, sphere[k], exact || reach > 0.0, &normal);
    sums->deepest = trb_max(sums->deepest, d);
    if (!(d > -reach)) continue;
    trb_pocket_touch touch = {
        trb_axpy(c, trb_sphere_reach(sphere[k], d), normal), normal, d, 0.0, TRB_PALMGREN_EXPONENT, trb_sub(c, p->x), 0};
    if (reach > 0.0) trb_pocket_push_film(m, p, &touch, sphere[k], weight[k], counters, load, sums);
    if (!(d > 0.0)) continue;
    touch.elastic = p->pockets->palmgren * facet->stiffness_factor * weight[k] * pow(d, TRB_PALMGREN_EXPONENT);
    push(m, facet, p, &touch, counters, load, sums);
  }
}

static trb_vec3 end_sphere(const trb_model *m, const trb_pocket_view *p)
{
  return trb_axpy(p->x, m->surfaces.end[TRB_END_LARGE].place, p->a);
}

static void large_end_on_face(const trb_model *m, const trb_facets *near, trb_pocket_view *p, int exact, trb_counters *counters,
                              trb_load *load, trb_pocket_sums *sums)
{
  const trb_pocket_face *f = near->first;
  const trb_geometry    *g = &m->geometry;
  const trb_vec3         c = end_sphere(m, p);
  const trb_pocket_face *facet = f;
  trb_vec3               normal;
  double                 d;
  if (f->n_facets > 1) d = trb_facets_nearest(near, c, g->sphere_radius, -INFINITY, &facet, &normal);
  else d = sphere_on_face(p->pockets, f, c, trb_polygon_height(&f->surface, c), g->sphere_radius, exact, &normal);
  sums->deepest = d;
  if (!(d > 0.0)) return;
  const double           q = p->pockets->wall_stiffness * facet->stiffness_factor * d * sqrt(d);
  const trb_pocket_touch touch = {
      trb_axpy(c, trb_sphere_reach(g->sphere_radius, d), normal), normal, d, q, TRB_POINT_EXPONENT, trb_sub(c, p->x), 0};
  push(m, facet, p, &touch, counters, load, sums);
}

static trb_vec3 small_end(const trb_model *m, const trb_pocket_view *p) { return trb_axpy(p->x, m->surfaces.small_end, p->a); }

/* All vertices of a surface share its stiffness. */
static void small_end_on_face(const trb_model *m, const trb_pocket_face *surface, trb_pocket_view *p, trb_counters *counters,
                              trb_load *load, trb_pocket_sums *sums)
{
  const trb_vec3 end = small_end(m, p), normal = trb_scale(-1.0, p->a);
  int            vertices = 0;
  for (int j = 0; j < surface->n_facets; j++) vertices += surface[j].surface.n;
  for (const trb_pocket_face *f = surface; f < surface + surface->n_facets; f++) {
    const double stiffness = p->pockets->wall_stiffness * f->stiffness_factor / vertices;
    for (int i = 0; i < f->surface.n; i++) {
      const trb_vec3 point = trb_polygon_vertex(&f->surface, i);
      const double   d = trb_dot(trb_sub(point, end), p->a);
      sums->deepest = trb_max(sums->deepest, d);
      if (!(d > 0.0)) continue;
      const double           q = stiffness * d * sqrt(d);
      const trb_pocket_touch touch = {point, normal, d, q, TRB_POINT_EXPONENT, {0, 0, 0}, 1};
      push(m, f, p, &touch, counters, load, sums);
    }
  }
}

static double small_end_gap(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p)
{
  const trb_vec3 end = small_end(m, p);
  double         gap = INFINITY;
  for (int i = 0; i < f->surface.n; i++) gap = trb_min(gap, trb_dot(trb_sub(end, trb_polygon_vertex(&f->surface, i)), p->a));
  return gap;
}

/* Lower bound of the gap of a facet. A facet that is one of several may have the roller behind its plane: there the ball around it counts. */
static double facet_gap(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, int roller, int is_one_of_several)
{
  if (f->part == TRB_PART_FLANK) {
    const double plane = trb_flank_gap(m, f, p, roller);
    return is_one_of_several && plane <= 0.0 ? trb_max(plane, trb_flank_to_ball(m, f, p, roller)) : plane;
  }
  if (f->part == TRB_PART_SMALL_END) return small_end_gap(m, f, p);
  const trb_vec3 c = end_sphere(m, p);
  const double   plane = trb_polygon_height(&f->surface, c) - m->geometry.sphere_radius;
  if (!is_one_of_several || plane > 0.0) return plane;
  return trb_max(plane, trb_norm(trb_sub(f->middle, c)) - f->extent - m->geometry.sphere_radius);
}

/* Lower bound of the gap of several facets. Only those whose plane is reached are looked at one by one. */
static double facets_gap(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, int roller, trb_near_facets *list,
                         trb_facets *near)
{
  const int         is_flank = f->part == TRB_PART_FLANK;
  const trb_sphere  large = {0.0, m->geometry.sphere_radius}, larges[2] = {large, large};
  const trb_sphere *spheres = is_flank ? &m->end_spheres[2 * roller] : larges;
  const trb_vec3    point = is_flank ? p->x : end_sphere(m, p);
  double            gap = INFINITY;
  for (int j = 0; j < f->n_facets; j += TRB_PLANES_TOGETHER) {
    const trb_planes *planes = &p->pockets->planes[f - p->pockets->faces + j / TRB_PLANES_TOGETHER];
    const double      least = trb_spheres_to_planes(planes, point, p->a, spheres, is_flank ? p->pockets->film : 0.0);
    if (least > 0.0) {
      gap = trb_min(gap, least);
      continue;
    }
    for (int k = j; k < j + TRB_PLANES_TOGETHER && k < f->n_facets; k++) {
      const double of_facet = facet_gap(m, f + k, p, roller, 1);
      gap = trb_min(gap, of_facet);
      if (!(of_facet > 0.0)) trb_add_near(list, near, k);
    }
  }
  return gap;
}

/* Lower bound of the gap of a surface. Facets that the flank may touch are put on a list; at the ends all count, as the exact gap is wanted. */
static double face_gap(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, int roller, trb_near_facets *list,
                       trb_facets *near)
{
  double gap = INFINITY;
  *near = (trb_facets){.first = f, .near = list->number + list->n, .n_facets = f->n_facets};
  if (f->part != TRB_PART_FLANK) near->n = TRB_ALL_FACETS;
  if (f->part != TRB_PART_SMALL_END && f->n_facets > 1) return facets_gap(m, f, p, roller, list, near);
  for (int j = 0; j < f->n_facets; j++) gap = trb_min(gap, facet_gap(m, f + j, p, roller, 0));
  return gap;
}

static trb_pocket_sums face_forces(const trb_model *m, const trb_facets *near, trb_pocket_view *p, int roller, int exact,
                                   trb_counters *counters, trb_load *load)
{
  const trb_pocket_face *f = near->first;
  trb_pocket_sums        sums = {0.0, 0.0, -INFINITY};
  if (f->part == TRB_PART_FLANK) flank_on_face(m, near, p, roller, exact, counters, load, &sums);
  else if (f->part == TRB_PART_LARGE_END) large_end_on_face(m, near, p, exact, counters, load, &sums);
  else small_end_on_face(m, f, p, counters, load, &sums);
  return sums;
}

static void add_detail(const trb_model *m, const trb_pair *pair, int roller, const trb_pocket_face *f, const trb_pocket_sums *sums,
                       trb_detail *detail)
{
  const int slot = pair->slots + roller * m->n_slots + f->slot;
  detail->pocket_force[slot] += sums->force;
  detail->pocket_friction[slot] += sums->friction;
  if (detail->pocket_interference == NULL) return;
  detail->pocket_interference[slot] = trb_max(detail->pocket_interference[slot], sums->deepest);
}

/* The smallest gap of each kind of face. */
static void note_gap(trb_gaps *gaps, const trb_pocket_face *f, double gap)
{
  double *of = &gaps->of[f->part == TRB_PART_FLANK ? TRB_GAP_FLANK : TRB_GAP_ENDS];
  *of = trb_min(*of, gap);
}

/* A surface of a pocket, and how near its roller is. */
typedef struct near_surface {
  trb_facets     facets;
  double         gap;   /* lower bound, m */
  trb_face_shift shift; /* its place, where it is deformed */
} near_surface;

/* Finds the gap of a surface, deformed or not. */
static void look_at(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, const trb_deformed *deformed, int roller,
                    trb_near_facets *list, near_surface *surface)
{
  trb_pocket_view seen;
  if (deformed != NULL) {
    trb_face_place(deformed, (int)(f - p->pockets->faces), &surface->shift);
    see_places(p, &surface->shift, &seen);
  }
  surface->gap = face_gap(m, f, deformed != NULL ? &seen : p, roller, list, &surface->facets);
}

/* Adds its loads. */
static trb_pocket_sums forces_of(const trb_model *m, near_surface *surface, trb_pocket_view *p, const trb_deformed *deformed, int roller,
                                 int exact, trb_counters *counters, trb_load *load)
{
  if (deformed == NULL) return face_forces(m, &surface->facets, p, roller, exact, counters, load);
  trb_face_shift *shift = &surface->shift;
  trb_slopes      slopes;
  trb_pocket_view seen;
  seen.slopes = p->slopes != NULL ? &slopes : NULL;
  if (seen.slopes != NULL) slopes = (trb_slopes){.axes = p->axes};
  trb_face_motion(deformed, shift);
  see_places(p, shift, &seen);
  see_motions(p, shift, &seen);
  const trb_pocket_sums sums = face_forces(m, &surface->facets, &seen, roller, exact, counters, load);
  if (!(sums.force > 0.0)) return sums;
  add_seen(&seen, shift, deformed, p);
  if (p->slopes == NULL) return sums;
  for (int k = 0; k < 6; k++) {
    trb_add_wrench(&p->slopes->place[k], &slopes.place[k]);
    trb_add_wrench(&p->slopes->velocity[k], &slopes.velocity[k]);
  }
  if (p->slopes->modal != NULL) trb_slopes_of_modes(deformed, shift, &slopes, p->x, p->slopes->modal);
  return sums;
}

/* Compiled for a rigid cage and for one that deforms. */
static inline trb_gaps touch(const trb_model *m, const trb_pair *pair, const trb_roller_pose *r, const trb_rigid_pose *cage,
                             const trb_deformed *deformed, int roller, trb_counters *counters, trb_load *load, trb_slopes *slopes,
                             trb_detail *detail)
{
  const trb_pockets     *row = pair->own;
  const trb_pocket_face *first = &row->faces[row->first_face[roller]], *end = &row->faces[row->first_face[roller + 1]];
  const trb_gaps         far = {{INFINITY, INFINITY}};
  const int              exact = detail != NULL && detail->pocket_interference != NULL;
  near_surface           surfaces[TRB_MOST_SLOTS], *last = surfaces;
  trb_near_facets        list;
  trb_pocket_view        p;
  trb_gaps               gaps = far;
  p.pockets = row;
  view_places(r, cage, roller, &p);
  counters->pocket_tests += end - first;
  list.n = 0;
  for (const trb_pocket_face *f = first; f < end; f += f->n_facets, last++) {
    look_at(m, f, &p, deformed, roller, &list, last);
    note_gap(&gaps, f, last->gap);
  }
  if (trb_gaps_clear(&gaps) && !exact) {
    counters->pocket_culled += end - first;
    return gaps;
  }
  view_motions(r, cage, &row->origin[roller], &p);
  memset(load, 0, sizeof *load);
  if (slopes != NULL) *slopes = (trb_slopes){.modal = slopes->modal, .axes = p.axes};
  p.slopes = slopes;
  gaps = far;
  for (near_surface *surface = surfaces; surface < last; surface++) {
    const trb_pocket_face *f = surface->facets.first;
    const double           gap = surface->gap;
    if (gap > 0.0 && !exact) {
      counters->pocket_culled += f->n_facets;
      note_gap(&gaps, f, gap);
      continue;
    }
    if (exact) surface->facets.n = TRB_ALL_FACETS;
    const trb_pocket_sums sums = forces_of(m, surface, &p, deformed, roller, exact, counters, load);
    note_gap(&gaps, f, f->part == TRB_PART_FLANK ? gap : -sums.deepest);
    if (detail != NULL) add_detail(m, pair, roller, f, &sums, detail);
  }
  load->on_a.force = trb_from_frame(&p.axes, p.force);
  load->on_a.moment = trb_from_frame(&p.axes, p.moment);
  load->on_b.force = trb_turn_z(trb_from_frame(&p.axes, p.cage_force), r->cosine, r->sine);
  load->on_b.moment = trb_turn_z(trb_from_frame(&p.axes, p.cage_moment), r->cosine, r->sine);
  return gaps;
}

trb_gaps trb_contact_pocket_of(const trb_model *m, const trb_pair *pair, const trb_instant *at, int roller, trb_counters *counters,
                               trb_load *load, trb_slopes *slopes, trb_detail *detail)
{
  const trb_body_at     *cage = &at->bodies[pair->b];
  const trb_roller_pose *r = &at->rollers[roller];
  if (cage->deformed == NULL) return touch(m, pair, r, &cage->pose, NULL, roller, counters, load, slopes, detail);
  return touch(m, pair, r, &cage->pose, cage->deformed, roller, counters, load, slopes, detail);
}

void trb_contact_pocket(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                        trb_detail *detail)
{
  for (int i = 0; i < batch->n; i++)
    for (int k = 0; k < at->n; k++) {
      const int roller = at->chosen[k];
      trb_load  load;
      if (at->apart != NULL && at->apart[roller] >> batch->index[i] & 1U) continue;
      const trb_gaps gaps = trb_contact_pocket_of(m, batch->pairs[i], at, roller, &work->counters, &load, NULL, detail);
      if (!trb_gaps_clear(&gaps)) trb_add_load(batch->pairs[i], &load, &loads[roller]);
    }
}
