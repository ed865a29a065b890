/* Clearances: proofs that a roller does not touch the other body of a fast pair, as its pocket, which hold from one evaluation to later ones
 * (docs/theory/numerics.md#clearances-of-pockets).
 *
 * Most rollers do not touch their pockets most of the time, and to look at all faces in each evaluation would be wasted. Where a pocket was
 * evaluated and nothing touched, a lower bound of the gap is known. When both bodies move, the gap shrinks at most by the sum of the
 * changes of their coordinates, each multiplied by the longest arm by which that coordinate moves anything that may touch: 1 for a
 * displacement, the largest distance from the axis of turning for an angle. As long as this sum is smaller than the gap there can be no
 * contact, and the pocket is not evaluated. */
#ifndef TRB_MOTION_CLEARANCE_H
#define TRB_MOTION_CLEARANCE_H

#include "contact/pair.h"

typedef struct trb_clearance {
  trb_gaps gaps;                         /* lower bounds of the gaps; not above 0: nothing is known */
  double   roller[TRB_CLEARANCE_ROLLER]; /* coordinates at which the gaps were found */
  double   body[TRB_CLEARANCE_BODY];
} trb_clearance;

void trb_clearance_set(const trb_model *m, trb_clearance *c, const trb_gaps *gaps, const double *y_roller, const double *y_body);
/* Whether the roller is proven not to touch the body. deformed: ways by which the body's surfaces have moved by its deformation since then, of
 * each gap, m; NULL: it is rigid. */
int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *deformed, const double *y_roller,
                        const double *y_body);
/* Lower bound of the gap that is left, m; not above 0: the roller may touch. */
double trb_clearance_left(const trb_clearance *c, const trb_clearance_arms *arms, const double *deformed, const double *y_roller,
                          const double *y_body);

#endif
