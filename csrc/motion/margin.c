#include "motion/margin.h"

#include <math.h>

trb_margin_arms trb_margin_arms_of(const trb_system *system)
{
  trb_margin_arms arms = {.n = 0};
  for (int i = 0; i < system->n_pairs; i++) {
    const trb_pair *pair = &system->pairs[i];
    if (pair->kind->margin == NULL || !pair->on) continue;
    arms.of[arms.n] = pair->kind->margin(system->model, pair);
    arms.body[arms.n] = pair->b;
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

/* The distant centre of an end's sphere is elsewhere if the roller skews or tilts, which the arm of the ring's turns counts as zero: what that
 * adds to it is the way across the ring's axis and along it, times the parts of the normal, and a tenth. */
static double wandered(const trb_margin_arm *a, const double *place, const double *step)
{
  const double angles =
      fabs(place[TRB_ROLLER_skew]) + fabs(step[TRB_ROLLER_skew]) + fabs(place[TRB_ROLLER_tilt]) + fabs(step[TRB_ROLLER_tilt]);
  return 1.6 * a->arm * angles;
}

void trb_ring_offsets_of(const trb_system *system, const trb_body_at *bodies, trb_ring_offset *offsets)
{
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_ring_pose *ring = &bodies[b].ring;
    offsets[b] = (trb_ring_offset){.lean = 0.0};
    if (!trb_is_ring(system->bodies[b].kind)) continue;
    offsets[b].lean = hypot(ring->axis.x, ring->axis.y);
    offsets[b].aside = hypot(ring->centre.x, ring->centre.y);
  }
}

unsigned trb_margin_open(const trb_margin_arms *arms, const trb_ring_offset *rings, const double *margin, double share, const double *place,
                         const double *step, double turn)
{
  const double around = fabs(step[TRB_ROLLER_psi]) + fabs(turn), shift = fabs(step[TRB_ROLLER_r]) + fabs(step[TRB_ROLLER_z]);
  const double turned = fabs(step[TRB_ROLLER_skew]) + fabs(step[TRB_ROLLER_tilt]);
  unsigned     open = 0U;
  for (int i = 0; i < arms->n; i++) {
    const trb_margin_arm  *a = &arms->of[i];
    const trb_ring_offset *ring = &rings[arms->body[i]];
    const double           by_lean = a->ring + (a->on_end ? wandered(a, place, step) : 0.0);
    const double           lean = ring->lean + ring->leaned, aside = ring->aside + ring->shifted;
    const double           by_turn = a->on_end ? turned_on_end(a, place, step, lean) : a->arm * turned;
    const double           by_ring = around * (aside + lean * by_lean) + (ring->shifted + ring->leaned * by_lean);
    if (!(shift + by_turn + by_ring <= share * fabs(margin[arms->row[i]]))) open |= 1U << i;
  }
  return open;
}
