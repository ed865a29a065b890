/* Jacobian of the right-hand side by local differences: one evaluation of the contacts a column of a roller, for all rollers at once, and
 * one of the pockets a column of the cage. */
#ifndef TRB_STEPPING_JACOBIAN_H
#define TRB_STEPPING_JACOBIAN_H

#include "motion/dynamics.h"
#include "stepping/arrow.h"

typedef struct trb_jacobian {
  trb_dynamics    *d;        /* of its own, so that poses of the integration stay */
  trb_roller_load *base;     /* loads at the state */
  trb_roller_load *pocket;   /* pocket loads at the state */
  double          *rates;    /* of every roller at the state */
  double          *moved;    /* state with a difference */
} trb_jacobian;

trb_status trb_jacobian_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_jacobian **jacobian, trb_message *message);
void       trb_jacobian_free(trb_jacobian *jacobian);
void       trb_jacobian_fill(trb_jacobian *jacobian, double time, const double *y, trb_arrow *arrow);

#endif
