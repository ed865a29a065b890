/* Spherical ends on a conical rib, all chosen rollers at once; each roller has one lane. The loops of films and friction are those of
 * the raceways (docs/theory/contacts.md#large-end-on-the-back-face-rib). */
#include <math.h>

#include "contact/passes.h"

#define TRB_KERNEL_NAME TRB_JOIN(trb_rib_kernel_, TRB_KERNEL_VARIANT)

/* Deepest point of the end's sphere in the rib's cone, and the velocities there; turning: of roller against ring about the normal, rad/s. */
static void pass_geometry(const trb_rib *rib, const trb_instant *at, const trb_ring_pose *rings, double *turning, trb_lanes *l)
{
  const trb_cone   face = rib->face;
  const trb_sphere end = rib->end;
  for (int j = 0; j < at->n; j++) {
    const trb_roller_pose *r = &at->rollers[at->chosen[j]];
    const trb_ring_pose   *ring = &rings[at->chosen[j]];
    const trb_vec3         centre = trb_axpy(r->x, end.place, r->frame.a);
    const trb_cone_foot    foot = trb_cone_at(&face, ring->axis, trb_sub(centre, trb_cone_point(&face, ring->centre, ring->axis)));
    const double           d = end.radius + foot.beyond;
    const trb_vec3         normal = foot.normal, point = trb_axpy(centre, trb_sphere_reach(end.radius, d), normal);
    const trb_vec3         v1 = trb_add(r->v, trb_cross(r->omega, trb_sub(point, r->x)));
    const trb_vec3         v2 = trb_add(ring->velocity, trb_cross(ring->omega, trb_sub(point, ring->centre)));
    const trb_vec3         relative = trb_sub(v1, v2), orbit = trb_v(-r->orbit_speed * point.y, r->orbit_speed * point.x, 0.0);
    const trb_vec3         middle = trb_sub(trb_scale(0.5, trb_add(v1, v2)), orbit);
    const double           rate = trb_dot(relative, normal);
    const trb_vec3         sliding = trb_axpy(relative, -rate, normal), mean = trb_axpy(middle, -trb_dot(middle, normal), normal);
    turning[j] = trb_dot(trb_sub(r->omega, ring->omega), normal);
    l->interference[j] = d;
    l->approach[j] = rate;
    l->nx[j] = normal.x, l->ny[j] = normal.y, l->nz[j] = normal.z;
    l->px[j] = point.x, l->py[j] = point.y, l->pz[j] = point.z;
    l->sx[j] = sliding.x, l->sy[j] = sliding.y, l->sz[j] = sliding.z;
    l->mx[j] = mean.x, l->my[j] = mean.y, l->mz[j] = mean.z;
  }
}

/* The lanes that fill up the last vector repeat the last roller, so that they need no special treatment. */
static void pad(int n, int padded, trb_lanes *l)
{
  double *const fields[] = {l->interference, l->approach, l->sx, l->sy, l->sz, l->mx, l->my, l->mz};
  for (int f = 0; f < (int)(sizeof fields / sizeof fields[0]); f++)
    for (int i = n; n > 0 && i < padded; i++) fields[f][i] = fields[f][n - 1];
}

/* Hertz: Q = K d^1.5, semi-axis along rolling and largest pressure with Q^(1/3). */
static void pass_load(const trb_rib *rib, int n, trb_lanes *l)
{
  const double stiffness = rib->stiffness, log_stiffness = log(stiffness), rolling = rib->semi_axis_rolling;
  const double per_area = 1.5 / (TRB_PI * rolling * rib->semi_axis_across);
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double d = trb_max(l->interference[i], TRB_SMALLEST_INTERFERENCE), log_d = log(d),
                 root = exp((log_stiffness + 1.5 * log_d) / 3.0);
    l->log_d[i] = log_d;
    l->load[i] = l->interference[i] > 0.0 ? stiffness * d * sqrt(d) : 0.0;
    l->half_width[i] = rolling * root;
    l->pressure[i] = per_area * root;
  }
}

/* (12) and (13), or (12) alone, before the thermal factor. */
static void pass_film(const trb_model *m, const trb_rib *rib, int n, trb_lanes *l)
{
  const double log_rx = log(rib->rx), rx = rib->rx, log_g = m->log_g, shape = rib->film_shape;
  const double base_w = log(rib->stiffness) - m->log_modulus - 2.0 * log_rx, base_u = m->log_viscosity - m->log_modulus - log_rx;
  const double rigid = rx * rib->film_rigid;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double log_w = base_w + 1.5 * l->log_d[i], log_u = base_u + l->log_u[i];
    l->film_elastic[i] = rx * trb_film_point_elastic(log_w, log_u, log_g, shape);
    l->film_rigid[i] = rigid * exp(2.0 * (log_u - log_w));
    l->thermal_factor[i] = 1.0;
  }
}

/* Sliding that turns within the ellipse. With the semi-axes a and b and Hertz's pressure the load has the second moment Q (a^2 + b^2)/5 about the
 * normal, so the mean square of the sliding speed is v^2 + w^2 (a^2 + b^2)/5 for the speed v in the middle and the turning w. Friction that has
 * everywhere the direction of sliding, over this speed, has the force mu Q v/S and the moment mu Q w (a^2 + b^2)/(5 S): S = w e sqrt(1 + 0.2 (b/e)^2) where
 * it turns about a point at the distance e beside a narrow ellipse, for which Houpert (2002) gives 0.18. arm2: (a^2 + b^2)/5. */
static void pass_turning(const trb_rib *rib, const double *turning, int n, int padded, double *arm2, trb_lanes *l)
{
  const double across = rib->semi_axis_across / rib->semi_axis_rolling, round = 0.2 * (1.0 + across * across);
  for (int i = 0; i < padded; i++) {
    const double w = turning[i < n ? i : n - 1];
    arm2[i] = round * l->half_width[i] * l->half_width[i];
    l->sliding_speed[i] = sqrt(l->sliding_speed[i] * l->sliding_speed[i] + w * w * arm2[i]);
    l->slide_roll[i] = l->sliding_speed[i] / l->mean_speed[i];
  }
}

/* The moment of such sliding about the normal. */
static void add_turning(double turning, double arm2, int j, const trb_lanes *l, trb_race_output *out)
{
  const trb_vec3 normal = trb_v(l->nx[j], l->ny[j], l->nz[j]);
  const double   load = -trb_dot(out->force, normal), moment = load * l->friction_coefficient[j] * turning * arm2 / l->sliding_speed[j];
  out->moment = trb_axpy(out->moment, -moment, normal);
  out->ring_moment = trb_axpy(out->ring_moment, moment, normal);
  out->power_traction += moment * turning;
}

static void sum_roller(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *ring, int j, const trb_lanes *l,
                       trb_race_output *out)
{
  const trb_vec3 normal = trb_v(l->nx[j], l->ny[j], l->nz[j]), point = trb_v(l->px[j], l->py[j], l->pz[j]),
                 sliding = trb_v(l->sx[j], l->sy[j], l->sz[j]);
  const double   elastic = l->load[j];
  double         load = elastic;
  if (m->contact_damping > 0.0) load *= trb_max(1.0 + trb_contact_damping(m, l->interference[j]) * l->approach[j], 0.0);
  const double   drag = load * l->friction_coefficient[j] / l->sliding_speed[j];
  const trb_vec3 force = trb_axpy(trb_scale(-load, normal), -drag, sliding), torque = trb_cross(trb_sub(point, ring->centre), force);
  out->loaded = 1;
  out->force = force;
  out->moment = trb_cross(trb_sub(point, r->x), force);
  out->ring_force = trb_scale(-1.0, force);
  out->ring_moment = trb_scale(-1.0, torque);
  out->torque_traction = -trb_dot(torque, ring->axis);
  out->elastic = 0.4 * elastic * l->interference[j];
  out->power_traction = drag * trb_dot(sliding, sliding);
  out->power_damping = (load - elastic) * l->approach[j];
}

void TRB_KERNEL_NAME(const trb_model *m, const trb_rib *rib, const trb_instant *at, const trb_ring_pose *rings, trb_lanes *l,
                     trb_counters *counters, trb_race_output *outputs)
{
  const int           n = at->n, all = (n + TRB_LANE_PAD - 1) / TRB_LANE_PAD * TRB_LANE_PAD, turns = m->params.effects.rib_turning > 0.0;
  const trb_pass_kind kind = {.mean_pressure = TRB_POINT_MEAN_PRESSURE,
                              .roughness = rib->roughness,
                              .boundary_limit = m->params.friction.rib_boundary_limit,
                              .asperity_factor = m->params.friction.rib_asperity_factor,
                              .asperity_exponent = m->params.friction.rib_asperity_exponent};
  double              turning[TRB_TILE_LANES], arm2[TRB_TILE_LANES];
  if (n == 0) return;
  pass_geometry(rib, at, rings, turning, l);
  pad(n, all, l);
  counters->rib_tests += n;
  int touching = 0;
  for (int j = 0; j < n; j++) touching += l->interference[j] > 0.0;
  for (int j = 0; j < n; j++) outputs[j] = (trb_race_output){.depth = l->interference[j]};
  if (touching == 0) return;
  counters->rib_contacts += touching;
  pass_load(rib, all, l);
  pass_speeds(m, all, l);
  if (turns) pass_turning(rib, turning, n, all, arm2, l);
  if (m->film) pass_film(m, rib, all, l);
  pass_oil(m, &kind, all, l, counters);
  if (m->contact_damping > 0.0) counters->damping_nodes += touching;
  for (int j = 0; j < n; j++) {
    const trb_ring_pose *ring = &rings[at->chosen[j]];
    if (!(l->interference[j] > 0.0)) continue;
    sum_roller(m, &at->rollers[at->chosen[j]], ring, j, l, &outputs[j]);
    if (!turns) continue;
    add_turning(turning[j], arm2[j], j, l, &outputs[j]);
    outputs[j].torque_traction = trb_dot(outputs[j].ring_moment, ring->axis);
  }
}
