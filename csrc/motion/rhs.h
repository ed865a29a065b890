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

#endif
