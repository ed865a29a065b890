/* Fast pairs: those whose forces jump as a contact begins, as a roller's with its pocket, so that nothing approximates them. A roller is looked
 * at in such a pair unless it is proven clear (motion/bound.h). What is proven is kept with the dynamics, from one evaluation to the next. */
#ifndef TRB_MOTION_FAST_PAIRS_H
#define TRB_MOTION_FAST_PAIRS_H

#include "motion/dynamics.h"

/* The fast pairs of the workspace; 0: no memory. What was made is freed in either case. */
int  trb_fast_create(trb_dynamics *d);
void trb_fast_free(trb_dynamics *d);

/* Forget what was proven at earlier states. */
void trb_fast_forget(trb_dynamics *d);
/* Pairs in which a roller is not proven clear at a state, bit by fast pair. */
unsigned trb_fast_near(const trb_dynamics *d, int roller, const double *y);
/* For a state y near those that were evaluated last: of every roller, the pairs in which it is proven to touch nothing, bit by the pair's row
 * in the system. */
void trb_fast_apart(const trb_dynamics *d, const double *y, unsigned *apart);
/* Lower bound of the gap of a roller that is left in a fast pair at a state, m; not above 0: it may touch. */
double trb_fast_gap_left(const trb_dynamics *d, int fast, int roller, const double *y);
/* Whether a roller is proven to touch no rigid body in a fast pair as long as coordinates are within ways of those of a state: of its place, and of the
 * hub. */
int trb_fast_clear_within(const trb_dynamics *d, int fast, int roller, const double *y, const double *of_roller, const double *of_hub);
/* A fast pair of a roller whose pose is kept (see trb_pair_touch); what is proven of it is kept. */
trb_gaps trb_fast_touch(trb_dynamics *d, int fast, int roller, const double *y, trb_load *load, trb_slopes *slopes, trb_detail *detail);
/* Adds the loads of the pairs in which a roller is near (d->near) to its flow and to the loads of the hub's bodies. */
void trb_fast_add(trb_dynamics *d, int roller, const double *y, double *flow);

#endif
