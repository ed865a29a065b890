#include "motion/hold.h"

#include <math.h>
#include <string.h>

/* Across the bearing's axis. */
static double across(trb_vec3 v) { return fabs(v.x) + fabs(v.y); }

trb_hold_ring trb_hold_ring_of(const trb_system *system, const trb_body_at *bodies)
{
  const trb_model *m = system->model;
  const double     outside = 2.0 * m->geometry.roller_centre_radius;
  /* what meets the ring, and the centres of its curvature: that of the large end is far away, near the axis */
  const double  far = outside + fabs(m->surfaces.end[TRB_END_LARGE].place) + m->params.total_length;
  trb_hold_ring most = {.far = far, .n = system->n_moving};
  for (int k = 0; k < most.n; k++) most.moving[k] = bodies[system->moving[k]].ring;
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_ring_pose *ring = &bodies[b].ring;
    if (!trb_is_ring(system->bodies[b].kind)) continue;
    most.place = fmax(most.place, across(ring->centre) + far * across(ring->axis));
    most.speed = fmax(most.speed, across(ring->velocity) + outside * across(ring->omega));
  }
  return most;
}

trb_hold_arms trb_hold_arms_of(const trb_model *m, const trb_batch *batch)
{
  trb_hold_arms most = batch->pairs[0]->kind->hold(m, batch->pairs[0]);
  for (int i = 1; i < batch->n && i < TRB_MOST_TOGETHER; i++) {
    const trb_hold_arms arms = batch->pairs[i]->kind->hold(m, batch->pairs[i]);
    most = (trb_hold_arms){fmax(most.radial, arms.radial), fmax(most.axial, arms.axial), fmax(most.tilt, arms.tilt),
                           fmax(most.skew, arms.skew),     fmax(most.reach, arms.reach), fmin(most.off, arms.off)};
  }
  return most;
}

void trb_hold_set(const trb_hold_ring *ring, const double *y_roller, double turn, double way, double speed, trb_hold *hold)
{
  for (int k = 0; k < ring->n; k++) hold->ring[k] = ring->moving[k];
  hold->way = way;
  hold->speed = speed;
  hold->turn = turn;
  memcpy(hold->y, y_roller, sizeof hold->y);
}

int trb_hold_holds(const trb_hold *hold, const trb_hold_arms *arms, const trb_hold_ring *ring, const double *y, double turn)
{
  const double *from = hold->y;
  if (!(hold->way >= 0.0)) return 0;
  const double turned = fabs(turn - hold->turn), aside = arms->skew * fabs(y[TRB_ROLLER_skew] - from[TRB_ROLLER_skew]);
  /* the normal's part across the axial plane, times off */
  const double slant = arms->skew * fabs(y[TRB_ROLLER_skew]) + aside + ring->place;
  double       by_ring = 0.0, speed = turned * ring->speed;
  for (int k = 0; k < ring->n; k++) {
    const trb_ring_pose *to = &ring->moving[k], *was = &hold->ring[k];
    by_ring += trb_norm(trb_sub(to->centre, was->centre)) + ring->far * trb_norm(trb_sub(to->axis, was->axis));
    speed += trb_norm(trb_sub(to->velocity, was->velocity)) + ring->far * trb_norm(trb_sub(to->omega, was->omega));
  }
  const double way = arms->radial * fabs(y[TRB_ROLLER_r] - from[TRB_ROLLER_r]) + arms->axial * fabs(y[TRB_ROLLER_z] - from[TRB_ROLLER_z]) +
                     arms->tilt * fabs(y[TRB_ROLLER_tilt] - from[TRB_ROLLER_tilt]) + turned * ring->place + by_ring;
  if (!(way * arms->off + aside * trb_min(slant, arms->off) <= hold->way * arms->off)) return 0; /* nor what is not a number */
  for (int i = TRB_ROLLER_v_r; i <= TRB_ROLLER_v_z; i++) speed += fabs(y[i] - from[i]);
  for (int i = TRB_ROLLER_omega_n; i <= TRB_ROLLER_omega_a; i++) speed += arms->reach * fabs(y[i] - from[i]);
  return speed <= hold->speed;
}
