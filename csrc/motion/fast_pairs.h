/* Fast pairs: those whose forces jump as a contact begins, as a roller's with its pocket, so that nothing approximates them. A roller is looked
 * at in such a pair unless it is proven clear (motion/bound.h). What is proven is kept with the dynamics, from one evaluation to the next. */
#ifndef TRB_MOTION_FAST_PAIRS_H
#define TRB_MOTION_FAST_PAIRS_H

#include "motion/dynamics.h"

/* What is proven of the gaps of a fast pair: nothing where one is not above zero, or not a number. */
void trb_bound_set(const trb_model *m, trb_bound *bound, const trb_gaps *gaps, const double *y_roller, const double *y_body);
/* Whether the roller is proven not to touch the body. deformed: ways by which the body's surfaces have moved by its deformation since then, of
 * each gap, m; NULL: it is rigid. */
int trb_bound_clear(const trb_bound *bound, const trb_arms *arms, const double *deformed, const double *y_roller, const double *y_body);
/* Lower bound of the gap that is left, m; not above 0: the roller may touch. */
double trb_bound_left(const trb_bound *bound, const trb_arms *arms, const double *deformed, const double *y_roller, const double *y_body);

/* Forget what was proven at earlier states. */
void trb_fast_forget(trb_dynamics *d);
/* Pairs in which a roller is not proven clear at a state, bit by fast pair. */
unsigned trb_fast_near(const trb_dynamics *d, int roller, const double *y);
/* For a state y near those that were evaluated last: of every roller, the pairs in which it is proven to touch nothing, bit by the pair's row
 * in the system. */
void trb_fast_apart(const trb_dynamics *d, const double *y, unsigned *apart);
/* Lower bound of the gap of a roller that is left in a fast pair at a state, m; not above 0: it may touch. */
double trb_fast_gap_left(const trb_dynamics *d, int fast, int roller, const double *y);
/* A fast pair of a roller whose pose is kept (see trb_pair_touch); what is proven of it is kept. */
trb_gaps trb_fast_touch(trb_dynamics *d, int fast, int roller, const double *y, trb_load *load, trb_slopes *slopes, trb_detail *detail);
/* Adds the loads of the pairs in which a roller is near (d->near) to its flow and to the loads of the hub's bodies. */
void trb_fast_add(trb_dynamics *d, int roller, const double *y, double *flow);

#endif
