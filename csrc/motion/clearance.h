/* Clearances: proofs that a roller does not touch its pocket, kept from one evaluation to the next.
 *
 * Where a pocket is evaluated and nothing touches, a lower bound of the gap is known. No face comes nearer by more than the bodies have
 * moved since, each coordinate times the longest arm it moves anything by; until that sum reaches the gap there is no contact. */
#ifndef TRB_MOTION_CLEARANCE_H
#define TRB_MOTION_CLEARANCE_H

#include "contact/pair.h"

typedef struct trb_clearance {
  trb_gaps gaps;                         /* lower bounds there; not above 0: nothing is known */
  double   roller[TRB_CLEARANCE_ROLLER]; /* where it was found */
  double   cage[TRB_CLEARANCE_CAGE];
} trb_clearance;

void trb_clearance_set(const trb_model *m, trb_clearance *c, const trb_gaps *gaps, const double *y_roller, const double *y_cage);
/* Whether the roller is proven not to touch its pocket. */
int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage);
/* What is left of the gap at least, m; not above 0: the roller may touch. */
double trb_clearance_left(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage);

#endif
