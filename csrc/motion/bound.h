/* Bounds: proofs that a gap or an interference has changed by less than a length since it was found (docs/theory/numerics.md#bounds-of-gaps).
 * A gap changes at most by the sum of the changes of both bodies' coordinates, each multiplied by the longest arm by which it moves anything that
 * may touch along its normal. The sum is an upper bound and not an estimate; csrc/tests/test_bounds.c tries to break it. A roller that was clear
 * of its pocket is not evaluated, a tangent is followed, and a load is not looked at again for peaks as long as the sum is small enough; loads
 * depend on velocities, too, which have a bound of their own. */
#ifndef TRB_MOTION_BOUND_H
#define TRB_MOTION_BOUND_H

#include "system/system.h"

/* What is proven of the gaps of a roller and another body. */
typedef struct trb_bound {
  double
      length[TRB_N_GAPS]; /* by which each gap may change, m; a ring has the first one alone; negative or not a number: nothing is proven */
  /* where it was found */
  double roller[TRB_PLACE_OF_ROLLER]; /* with a ring the angle is that of the roller about the bearing's axis */
  double body[TRB_PLACE_OF_BODY];
} trb_bound;

/* How far a ring is off the bearing's axis, and how far it has moved since a bound was found. */
typedef struct trb_ring_offset {
  double lean;            /* distance of its axis, a unit vector, from the bearing's */
  double aside;           /* of its reference point from the bearing's axis, m */
  double speed;           /* of what meets it, across the bearing's axis, m/s */
  double shifted, leaned; /* the same of a ring with coordinates: since the bound was found */
} trb_ring_offset;

/* Of every body of a system that is a ring; nothing has moved. */
void trb_ring_offsets_of(const trb_system *system, const trb_body_at *bodies, trb_ring_offset *offsets);

/* By how much a gap between a roller and a ring has changed, at most, m. place: the roller's coordinates where the bound was found; step: from
 * there; around: by how much the roller has turned about the bearing's axis since then, rad; enough: the first bound that is no larger will do. */
static inline double trb_way_on_ring(const trb_arms *a, const trb_ring_offset *ring, const double *place, const double *step, double around,
                                     double enough)
{
  const double dr = fabs(step[TRB_ROLLER_r]), dz = fabs(step[TRB_ROLLER_z]);
  const double skewed = fabs(step[TRB_ROLLER_skew]), tilted = fabs(step[TRB_ROLLER_tilt]);
  /* the largest of each on the way */
  const double skew = fabs(place[TRB_ROLLER_skew]) + skewed, tilt = fabs(place[TRB_ROLLER_tilt]) + tilted;
  const double lean = ring->lean + ring->leaned, aside = ring->aside + ring->shifted, arm = a->roller[TRB_ROLLER_skew];
  /* how far spheres' centres are off their nominal places, and the ring's axis there off the bearing's */
  const double off = (fabs(place[TRB_ROLLER_r]) + dr + fabs(place[TRB_ROLLER_z]) + dz) + arm * (skew + tilt);
  const double axis = aside + lean * (a->axial + off), by_lean = a->body[3] + 1.5 * (off + axis);
  const double by_ring = around * (aside + lean * by_lean) + (ring->shifted + ring->leaned * by_lean);
  /* as if the normal pointed along every displacement */
  const double coarse = (dr + dz) + arm * (skewed + tilted) + by_ring;
  if (coarse <= enough) return coarse;
  /* sine of the angle by which the normal turns about the ring's axis; the parts of the normal along each displacement */
  const double sine = off + axis < a->room ? a->swing * (arm * skew + axis) : 1.0, turned = sine + lean;
  const double by_r = trb_min(a->roller[TRB_ROLLER_r] + lean, 1.0), by_z = trb_min(a->roller[TRB_ROLLER_z] + lean, 1.0);
  const double by_skew = trb_min(a->skew + turned + skew * (a->along + tilt + turned), 1.0);
  const double by_tilt = trb_min(a->tilt + tilt + turned, 1.0);
  return (by_r * dr + by_z * dz) + arm * (by_skew * skewed + by_tilt * tilted) + by_ring;
}

/* Of the pairs of rollers with rings that are on. */
typedef struct trb_ring_arms {
  trb_arms of[TRB_MOST_PAIRS];
  int      row[TRB_MOST_PAIRS];  /* number of the pair in the system */
  int      body[TRB_MOST_PAIRS]; /* the ring */
  int      n;
} trb_ring_arms;

trb_ring_arms trb_ring_arms_of(const trb_system *system);
/* Pairs, bit by arm, whose interference is not proven to have changed by less than a share of its size. rings: of every body; interference: one a
 * row; place, step: as above; turn: of the frame R since then, rad. */
unsigned trb_bounds_open(const trb_ring_arms *arms, const trb_ring_offset *rings, const double *interference, double share,
                         const double *place, const double *step, double turn);

/* Of one interference with a ring; ring: in inertial coordinates, NULL where it is known to be where the bound was found; angle: of the roller
 * about the bearing's axis, rad. */
void trb_bound_set_on_ring(trb_bound *bound, double length, const trb_ring_pose *ring, const double *y_roller, double angle);
int  trb_bound_holds_on_ring(const trb_bound *bound, const trb_arms *arms, const trb_ring_offset *offset, const trb_ring_pose *ring,
                             const double *y_roller, double angle);

/* What is proven, to first order in small displacements, of the velocities at a roller's contacts with rings. */
typedef struct trb_speed_bound {
  double        length; /* by which they may change, m/s */
  double        angle;  /* where it was found: of the roller about the bearing's axis, rad */
  double        roller[TRB_ROLLER_SIZE];
  trb_ring_pose ring[TRB_MOST_MOVING_RINGS]; /* rings with coordinates */
} trb_speed_bound;

void trb_speed_bound_set(trb_speed_bound *bound, double length, const trb_system *system, const trb_body_at *bodies, const double *y_roller,
                         double angle);
int trb_speed_bound_holds(const trb_speed_bound *bound, const trb_system *system, const trb_ring_offset *offsets, const trb_body_at *bodies,
                          const double *y_roller, double angle);

#endif
