/* Clearances: proofs that a roller does not touch its pocket, kept from one evaluation to the next.
 *
 * Where a pocket is evaluated and nothing touches, a lower bound of the gap is known. No face comes nearer by more than the bodies have
 * moved since, each coordinate times the longest arm it moves anything by; until that sum reaches the gap there is no contact. */
#ifndef TRB_MOTION_CLEARANCE_H
#define TRB_MOTION_CLEARANCE_H

#include "contact/contact.h"

/* Coordinates that come first in a roller's and in the cage's state. */
enum { TRB_CLEARANCE_ROLLER = TRB_ROLLER_tilt + 1, TRB_CLEARANCE_CAGE = TRB_CAGE_psi + 1 };

typedef struct trb_clearance {
  trb_pocket_gaps gaps;                         /* lower bounds there; not above 0: nothing is known */
  double          roller[TRB_CLEARANCE_ROLLER]; /* where it was found */
  double          cage[TRB_CLEARANCE_CAGE];
} trb_clearance;

/* How far a unit of each coordinate moves what can touch, at most, m/m or m/rad. The large end's sphere has its centre far from the roller:
 * flanks, which come nearer, have shorter arms. */
typedef struct trb_clearance_arms {
  double roller[TRB_CLEARANCE_ROLLER];
  double cage[TRB_CLEARANCE_CAGE];
} trb_clearance_arms;

/* arms: of every gap. */
void trb_clearance_arms_of(const trb_model *m, trb_clearance_arms *arms);
void trb_clearance_set(const trb_model *m, trb_clearance *c, const trb_pocket_gaps *gaps, const double *y_roller, const double *y_cage);
/* Whether the roller is proven not to touch its pocket. */
int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage);
/* What is left of the gap at least, m; not above 0: the roller may touch. */
double trb_clearance_left(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage);

#endif
