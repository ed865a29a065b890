/* Holds: bounds, to first order in small displacements, which show that a load that was found at one state has changed little at
 * another, so that peaks need not evaluate it again (docs/theory/numerics.md#records-peaks-and-restarts). A load depends on an
 * interference and so on the place of a roller; by damping and by the film it depends on velocities too. The change of each coordinate
 * is multiplied by the longest arm by which it moves the contact along its normal. The prescribed motion must be the same at both
 * states. */
#ifndef TRB_MOTION_HOLD_H
#define TRB_MOTION_HOLD_H

#include "contact/bounds.h"
#include "system/system.h"

typedef struct trb_hold {
  double way;   /* displacement up to which it holds, m; negative: it does not hold */
  double speed; /* change of velocity up to which it holds, m/s */
  /* where it was set */
  double        y[TRB_ROLLER_SIZE];
  double        turn;                        /* of the roller about the bearing's axis, rad */
  trb_ring_pose ring[TRB_MOST_MOVING_RINGS]; /* rings with coordinates */
} trb_hold;

/* How far a ring is off the bearing's axis, which a roller sees turning as it orbits; and the rings with coordinates. */
typedef struct trb_hold_ring {
  double        place; /* m */
  double        speed; /* m/s */
  double        far;   /* distance of what meets a ring from its centre, m */
  int           n;
  trb_ring_pose moving[TRB_MOST_MOVING_RINGS]; /* in inertial coordinates */
} trb_hold_ring;

/* The largest over all bodies of a system. */
trb_hold_ring trb_hold_ring_of(const trb_system *system, const trb_body_at *bodies);
/* Of pairs that are held together: whatever bounds one of them bounds all. */
trb_hold_arms trb_hold_arms_of(const trb_model *m, const trb_batch *batch);
/* turn: of the roller about the bearing's axis, rad. */
void trb_hold_set(const trb_hold_ring *ring, const double *y_roller, double turn, double way, double speed, trb_hold *hold);
int  trb_hold_holds(const trb_hold *hold, const trb_hold_arms *arms, const trb_hold_ring *ring, const double *y_roller, double turn);

#endif
