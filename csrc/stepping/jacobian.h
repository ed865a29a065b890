/* Jacobian of the right-hand side.
 *
 * It is the sum of two parts. Slow pairs: what they do to each roller, and the roller's own inertia, by differences; it changes slowly and
 * costs one evaluation of these pairs a column, for all rollers at once. Fast pairs: it changes with every impact; only rollers that touch
 * have it, and it comes with their evaluation. Both are kept apart, and the first is reused until it is old or Newton's method fails. */
#ifndef TRB_STEPPING_JACOBIAN_H
#define TRB_STEPPING_JACOBIAN_H

#include "motion/dynamics.h"
#include "stepping/tangent.h"

typedef struct trb_jacobian {
  trb_dynamics *d;        /* of its own, so that poses of the integration stay */
  trb_tangents *tangents; /* the part of the rings */
  double       *moved;    /* state with a difference */
  long          rings_evaluations;
} trb_jacobian;

trb_status trb_jacobian_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_jacobian **jacobian,
                               trb_message *message);
void       trb_jacobian_free(trb_jacobian *jacobian);
/* fresh: evaluate the rings' part anew, too. */
void trb_jacobian_fill(trb_jacobian *jacobian, double time, const double *y, int fresh, trb_arrow *arrow);

#endif
