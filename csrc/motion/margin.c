#include "motion/margin.h"

#include <math.h>

trb_margin_arms trb_margin_arms_of(const trb_system *system)
{
  trb_margin_arms arms = {.n = 0};
  for (int i = 0; i < system->n_pairs; i++) {
    const trb_pair *pair = &system->pairs[i];
    if (pair->kind->margin == NULL || !pair->on) continue;
    arms.of[arms.n] = pair->kind->margin(system->model, pair);
    arms.row[arms.n++] = i;
  }
  return arms;
}

/* Bound of how a turn of the roller changes the interference at the rib. The interference of a sphere and a cone follows the sphere's
 * centre along the cone's normal. This centre lies far from the roller's centre of mass, so the arm is long. But the normal points
 * nearly along the roller's axis, so a turn moves the centre nearly across the normal. What remains is proportional to the angle between
 * axis and normal, to the skew, and to the turn of the normal about the bearing axis, which can be large as the sphere's centre is close
 * to that axis. */
static double turned_on_end(const trb_margin_arm *a, const double *place, const double *step, double lean)
{
  const double skewed = fabs(step[TRB_ROLLER_skew]), tilted = fabs(step[TRB_ROLLER_tilt]);
  const double skew = fabs(place[TRB_ROLLER_skew]) + skewed, tilt = fabs(place[TRB_ROLLER_tilt]) + tilted;
  const double arm = a->arm, across = arm * (skew + tilt + lean) / (0.5 * a->sphere_offset);
  const double sine = a->normal_sine * trb_min(across, 1.0);
  return arm * (skewed * (sine + skew + lean) + tilted * (a->normal_lean + sine + tilt + lean));
}

trb_ring_offset trb_ring_offset_of(const trb_system *system, const trb_body_at *bodies)
{
  trb_ring_offset most = {.lean = 0.0};
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_ring_pose *ring = &bodies[b].ring;
    if (!trb_is_ring(system->bodies[b].kind)) continue;
    most.lean = fmax(most.lean, hypot(ring->axis.x, ring->axis.y));
    most.aside = fmax(most.aside, hypot(ring->centre.x, ring->centre.y));
  }
  return most;
}

int trb_margin_holds(const trb_margin_arms *arms, const trb_ring_offset *ring, const double *margin, double share, const double *place,
                     const double *step, double turn)
{
  const double around = fabs(step[TRB_ROLLER_psi]) + fabs(turn), shift = fabs(step[TRB_ROLLER_r]) + fabs(step[TRB_ROLLER_z]);
  const double turned = fabs(step[TRB_ROLLER_skew]) + fabs(step[TRB_ROLLER_tilt]);
  for (int i = 0; i < arms->n; i++) {
    const trb_margin_arm *a = &arms->of[i];
    const double          by_turn = a->on_end ? turned_on_end(a, place, step, ring->lean) : a->arm * turned;
    const double          by_ring = around * (ring->aside + ring->lean * a->ring) + (ring->shifted + ring->leaned * a->ring);
    if (!(shift + by_turn + by_ring <= share * margin[arms->row[i]])) return 0;
  }
  return 1;
}
