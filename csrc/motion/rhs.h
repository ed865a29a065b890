/* The right-hand side of the equations of motion, y' = f(t, y): one recipe, exact or with an approximation of the slow pairs' forces. */
#ifndef TRB_MOTION_RHS_H
#define TRB_MOTION_RHS_H

#include "motion/dynamics.h"

/* What may stand for the slow pairs' forces on a roller between their exact evaluations; stepping/tangent.h makes one. */
typedef struct trb_approximation {
  void *self;
  /* Before the rollers of an instant. */
  void (*begin)(void *self, const trb_dynamics *d, double time);
  /* 1: the roller's flow and its reactions on moving rings are given, without fast pairs; 0: they are to be evaluated exactly. */
  int (*follow)(void *self, const trb_dynamics *d, int roller, const double *y_roller, double *flow, trb_wrench *reactions);
  /* Exact ones, of a roller that follow refused. */
  void (*learn)(void *self, const trb_dynamics *d, int roller, const double *y_roller, const double *flow, const trb_wrench *reactions);
} trb_approximation;

/* instead: NULL for exact forces of all pairs. */
void trb_rhs(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, double *rates);

/* The same in two parts, for n chosen rollers and the hub as if there were no others: flows of these rollers, kept in d->flows, with the loads that they
 * put on the hub; then the rates of the hub, with the quadratures of what belongs to no roller, or to those that were put in between
 * (trb_dynamics_put). */
void trb_rhs_rollers(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, const int *chosen, int n,
                     double *rates);
void trb_rhs_hub(trb_dynamics *d, const double *y, double *rates);
/* Flow of one roller that touches nothing which has coordinates: nothing but its own part of a state is read. It is kept in d->flows. */
void trb_rhs_alone(trb_dynamics *d, const trb_approximation *instead, double time, int roller, const double *y_roller);

#endif
