/* A body that holds all rollers at even spacing (docs/theory/motion.md#cage-as-a-spacer): they orbit at its speed. One degree of freedom
 * takes the place of the orbits of all rollers.
 *
 * The orbit angle and the tangential velocity of each roller follow from the spacer's turn and angular velocity: these entries of a state
 * are put in before anything reads them, and their rates are zero. */
#ifndef TRB_MOTION_SPACER_H
#define TRB_MOTION_SPACER_H

#include "body/roller.h"
#include "system/system.h"

/* A roller that the spacer holds. */
typedef struct trb_spaced {
  double radius; /* of its orbit, m */
  double speed;  /* of the orbit, rad/s */
  double share;  /* of its tangential acceleration in the spacer's angular acceleration, 1/m */
} trb_spaced;

/* Where the spacer's turn and angular velocity are in a state. */
typedef struct trb_spacer_at {
  int turn, turning;
} trb_spacer_at;

trb_spacer_at trb_spacer_where(const trb_system *system);
/* Puts the rollers of a state where the spacer holds them, and the spacer in the middle of the bearing; nothing where there is none. */
void trb_spacer_hold(const trb_system *system, const trb_drive *drive, double *y);
/* Moment of inertia of spacer and rollers about the bearing's axis at a state where it holds them, kg m2. */
double trb_spacer_inertia(const trb_system *system, const trb_drive *drive, const double *y);
/* A roller there, with that moment of inertia. */
trb_spaced trb_spacer_part(const trb_system *system, const trb_drive *drive, int roller, const double *y, double inertia);
/* Rates of the spacer from those that every roller and the spacer would have alone, and zero for what follows from them. */
void trb_spacer_join(const trb_system *system, const trb_drive *drive, const double *y, double *rates);

#endif
