/* Ends of rollers on ribs. First a spherical end on a conical rib of a ring, as the large end on the back-face rib: one point of maximum
 * interference (docs/theory/contacts.md#large-end-on-the-back-face-rib). */
#include <math.h>

#include "contact/friction.h"
#include "contact/kernels.h"
#include "contact/pair.h"
#include "surface/circle.h"

static const trb_rib *rib_of(const trb_pair *pair) { return pair->own; }

/* Height of a contact point above the raceway beside the rib. */
static double height_of(const trb_rib *rib, const trb_ring_pose *ring, trb_vec3 point)
{
  const trb_cone *race = &rib->race;
  return -trb_cone_at(race, ring->axis, trb_sub(point, trb_cone_point(race, ring->centre, ring->axis))).beyond;
}

/* Share of the ellipse's axis across rolling that lies below the rib's lower or above its upper edge. */
static double overhang(const trb_rib *rib, double load, double height)
{
  const double semi = rib->semi_axis_across * cbrt(load);
  const double below = trb_clamp(rib->edge_low - (height - semi), 0.0, 2.0 * semi);
  const double above = trb_clamp(height + semi - rib->edge_high, 0.0, 2.0 * semi);
  return semi > 0.0 ? trb_min((below + above) / (2.0 * semi), 1.0) : 0.0;
}

static void fill_detail(const trb_model *m, const trb_rib *rib, const trb_ring_pose *ring, int lane, const trb_lanes *l,
                        const trb_race_output *out, trb_contact *c)
{
  *c = (trb_contact){.interference = l->interference[lane], .height = height_of(rib, ring, trb_v(l->px[lane], l->py[lane], l->pz[lane]))};
  if (!out->loaded) return;
  c->load = -trb_dot(out->force, trb_v(l->nx[lane], l->ny[lane], l->nz[lane]));
  c->pressure = l->pressure[lane];
  c->mean_speed = l->mean_speed[lane];
  c->sliding_speed = l->sliding_speed[lane];
  c->slide_roll = l->slide_roll[lane];
  c->friction_coefficient = l->friction_coefficient[lane];
  c->friction = c->load * c->friction_coefficient;
  c->overhang = overhang(rib, c->load, c->height);
  if (!m->film) return;
  c->film_elastic = l->film_elastic[lane];
  c->film_rigid = l->film_rigid[lane];
  c->thermal_factor = l->thermal_factor[lane];
  c->film = l->film[lane];
  c->film_parameter = l->film_parameter[lane];
}

static void evaluate_one(const trb_model *m, const trb_instant *at, const trb_pair *pair, int row, trb_workspace *work, trb_loads *loads,
                         trb_detail *detail)
{
  const trb_ring_pose *ring = trb_pair_ring(pair, at);
  trb_race_output      outputs[TRB_TILE_LANES];
  trb_kernel_variants[work->variant].rib(m, rib_of(pair), at, ring, work->lanes, &work->counters, outputs);
  for (int k = 0; k < at->n; k++) {
    const int              j = at->chosen[k];
    const trb_race_output *out = &outputs[k];
    trb_loads             *to = &loads[j];
    if (detail != NULL) fill_detail(m, rib_of(pair), &ring[j], k, work->lanes, out, &trb_pair_contacts(m, pair, detail)[j]);
    to->margin[row] = out->depth;
    if (!out->loaded) continue;
    const trb_load load = trb_load_of_output(out);
    trb_add_load(pair, &load, to);
  }
}

static void evaluate(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                     trb_detail *detail)
{
  for (int i = 0; i < batch->n; i++) evaluate_one(m, at, batch->pairs[i], batch->index[i], work, loads, detail);
}

static void arms_of(const trb_model *m, const trb_pair *pair, trb_arms *arms)
{
  const trb_rib *rib = rib_of(pair);
  *arms = trb_arms_on_cone(m, &rib->face, rib->end.place, rib->end.place, fabs(rib->face.place) + rib->end.radius * fabs(rib->face.sine));
}

static double depth_of(const trb_pair *pair, const trb_roller_pose *roller, const trb_ring_pose *ring)
{
  const trb_rib *rib = rib_of(pair);
  const trb_vec3 centre = trb_axpy(roller->x, rib->end.place, roller->frame.a);
  return rib->end.radius +
         trb_cone_at(&rib->face, ring->axis, trb_sub(centre, trb_cone_point(&rib->face, ring->centre, ring->axis))).beyond;
}

static void look_at(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                    trb_detail *detail, double share)
{
  evaluate(m, at, batch, work, loads, detail);
  for (int k = 0; k < at->n * batch->n; k++) {
    trb_contact *c = &trb_pair_contacts(m, batch->pairs[k % batch->n], detail)[at->chosen[k / batch->n]];
    c->way = trb_look_way(c, share);
    c->speed = c->load > 0.0 ? trb_look_speed(m, c->mean_speed, trb_contact_damping(m, c->interference), share) : (double)INFINITY;
  }
}

/* Its own parameters: trb_rib. */
const trb_pair_kind trb_pair_rib = {.name = "spherical end on a conical rib",
                                    .shape = {TRB_SHAPE_SPHERE, TRB_SHAPE_CONE},
                                    .pace = TRB_PACE_SLOW,
                                    .seats = 1,
                                    .mechanisms = TRB_LOSES(TRB_BY_SLIDING) | TRB_LOSES(TRB_BY_DAMPING),
                                    .contact = TRB_CONTACT_POINT,
                                    .evaluate = evaluate,
                                    .arms = arms_of,
                                    .depth = depth_of,
                                    .look = look_at};

/* Small end on the plane front rib of the inner ring of a tapered bearing (docs/theory/contacts.md#small-end-on-the-front-rib). Each of the two
 * circles that bound the rib's face meets the roller's end plane in its deepest point, with half of the stiffness, along the roller's axis. */
static void edge_on_end(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *ring, int edge, const trb_pair *pair, int row,
                        trb_counters *counters, trb_loads *to, trb_contact *c)
{
  const trb_vec3   a = r->frame.a, end = trb_axpy(r->x, m->surfaces.small_end, a);
  const trb_circle circle = ((const trb_circle *)pair->own)[edge];

  const trb_circle_meeting meeting =
      trb_circle_on_plane(trb_axpy(ring->centre, circle.place, ring->axis), ring->axis, circle.radius, end, a);
  const double d = meeting.depth;
  counters->front_rib_tests++;
  c->interference = edge == 0 ? d : trb_max(d, c->interference);
  to->margin[row] = trb_min(to->margin[row], fabs(d));
  if (!(d > 0.0)) return;
  counters->front_rib_contacts++;
  const trb_vec3  point = trb_circle_deepest(&meeting, circle.radius), arm = trb_sub(point, r->x), ring_arm = trb_sub(point, ring->centre);
  const trb_vec3  normal = trb_scale(-1.0, a);
  const trb_touch touch =
      trb_touching(trb_add(r->v, trb_cross(r->omega, arm)), trb_add(ring->velocity, trb_cross(ring->omega, ring_arm)), normal);
  const double   elastic = 0.5 * m->params.roller.end_stiffness * d * sqrt(d);
  trb_load       load = {.elastic = 0.4 * elastic * d};
  const trb_push push = trb_push_at(m, &touch, normal, elastic, trb_contact_damping(m, d), 1.0, load.lost);
  const trb_vec3 torque = trb_cross(ring_arm, push.force);
  load.on_a = (trb_wrench){push.force, trb_cross(arm, push.force)};
  load.on_b = (trb_wrench){trb_scale(-1.0, push.force), trb_scale(-1.0, torque)};
  load.torque[TRB_BY_SLIDING] = -trb_dot(torque, ring->axis);
  trb_add_load(pair, &load, to);
  c->load += push.load;
  c->friction += push.load * push.mu;
  c->friction_coefficient = push.mu;
  c->sliding_speed = touch.speed;
}

static void evaluate_edges(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                           trb_detail *detail)
{
  for (int i = 0; i < batch->n; i++)
    for (int k = 0; k < at->n; k++) {
      const int   j = at->chosen[k];
      trb_contact c = {0};
      for (int edge = 0; edge < 2; edge++)
        edge_on_end(m, &at->rollers[j], &trb_pair_ring(batch->pairs[i], at)[j], edge, batch->pairs[i], batch->index[i], &work->counters,
                    &loads[j], &c);
      if (detail != NULL) trb_pair_contacts(m, batch->pairs[i], detail)[j] = c;
    }
}

/* The interference is that of the deepest point of a circle beyond the end, and the way of this point along the roller's axis for a turn is
 * its distance from the roller's centre of mass. A turn of the roller against the ring moves it round the circle: by less than half a radian as
 * long as all angles together are below a third of that between both axes, which `room` says, and anywhere beyond. */
static void arms_of_edges(const trb_model *m, const trb_pair *pair, trb_arms *arms)
{
  const trb_circle *edges = pair->own;
  double            arm = 0.0, near = 0.0, turn = 0.0;
  for (int i = 0; i < 2; i++) {
    const double along = fabs(edges[i].place) + fabs(m->geometry.roller_mass_offset) + trb_bound_play(m);
    const double centre = m->geometry.roller_centre_radius, radius = edges[i].radius;
    arm = fmax(arm, hypot(along, centre + radius));
    near = fmax(near, hypot(along, centre - radius) + 0.5 * radius);
    turn = fmax(turn, hypot(along, radius));
  }
  const double room = arm * fabs(m->axis_sine) / 3.0;
  near = fmin(near + room, arm);
  *arms = (trb_arms){.roller = {1.0, 0.0, 1.0, arm, arm},
                     .body = {1.0, 1.0, 1.0, 1.01 * turn, 1.01 * turn, 0.0},
                     .skew = near / arm,
                     .tilt = near / arm,
                     .room = room,
                     .axial = arm};
}

static void look_at_edges(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                          trb_detail *detail, double share)
{
  evaluate_edges(m, at, batch, work, loads, detail);
  for (int k = 0; k < at->n * batch->n; k++) {
    trb_contact *c = &trb_pair_contacts(m, batch->pairs[k % batch->n], detail)[at->chosen[k / batch->n]];
    c->way = c->interference > 0.0 ? -1.0 : trb_look_way(c, share);
    c->speed = INFINITY;
  }
}

/* Its own parameters: two circles (surface/circle.h), the edges of the face. */
const trb_pair_kind trb_pair_front_rib = {.name = "end on a plane rib",
                                          .shape = {TRB_SHAPE_PLANE, TRB_SHAPE_CIRCLES},
                                          .pace = TRB_PACE_SLOW,
                                          .mechanisms = TRB_LOSES(TRB_BY_SLIDING) | TRB_LOSES(TRB_BY_DAMPING),
                                          .contact = TRB_CONTACT_EDGE,
                                          .evaluate = evaluate_edges,
                                          .arms = arms_of_edges,
                                          .look = look_at_edges};
