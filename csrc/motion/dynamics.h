/* Equations of motion: y' = f(t, y). Newton-Euler for every roller and the cage, in frames that orbit with them. */
#ifndef TRB_MOTION_DYNAMICS_H
#define TRB_MOTION_DYNAMICS_H

#include "contact/contact.h"
#include "motion/ring_motion.h"

typedef struct trb_dynamics {
  const trb_model  *model;
  const trb_motion *motion;
  trb_workspace    *work;
  trb_drive         drive;   /* at the last time evaluated */
  trb_roller_pose  *rollers; /* at the last state evaluated */
  trb_ring_pose    *inner;   /* the inner ring in each roller's frame */
  trb_cage_pose     cage;
  trb_roller_load  *loads;
} trb_dynamics;

/* motion may be NULL where only poses that the caller places are used. */
trb_status trb_dynamics_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_dynamics **dynamics, trb_message *message);
void       trb_dynamics_free(trb_dynamics *dynamics);

/* Poses at (t, y), kept in the dynamics. */
void trb_dynamics_pose(trb_dynamics *d, double time, const double *y);
/* Pose of one roller only, from its part of a state. */
void trb_dynamics_pose_roller(trb_dynamics *d, int roller, const double *y_roller);
/* All loads at the poses kept; detail may be NULL. */
void trb_dynamics_loads(trb_dynamics *d, trb_detail *detail);
/* What the contacts read. */
trb_instant trb_dynamics_instant(const trb_dynamics *d);

/* Right-hand side of one roller, of the cage under the sum of what the rollers put on it, and of everything. */
void trb_dynamics_roller_rates(const trb_dynamics *d, int roller, const trb_roller_load *load, double *rates);
void trb_dynamics_cage_rates(const trb_dynamics *d, const double *y_cage, trb_vec3 force, trb_vec3 moment, double *rates);
void trb_dynamics_derivative(trb_dynamics *d, double time, const double *y, double *rates);

#endif
