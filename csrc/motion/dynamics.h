/* Equations of motion y' = f(t, y): Newton's and Euler's equations of each roller and the cage, in frames that orbit with them
 * (docs/theory/motion.md#newtons-equations). */
#ifndef TRB_MOTION_DYNAMICS_H
#define TRB_MOTION_DYNAMICS_H

#include "contact/contact.h"
#include "motion/clearance.h"
#include "motion/ring_motion.h"

typedef struct trb_dynamics {
  const trb_model   *model;
  const trb_motion  *motion;
  trb_workspace     *work;
  trb_drive          drive;   /* at the last time evaluated */
  trb_roller_pose   *rollers; /* at the last state evaluated */
  trb_ring_pose     *inner;   /* the inner ring in each roller's frame */
  trb_cage_pose      cage;
  trb_roller_load   *loads;
  int               *everyone; /* 0, 1, ...: all rollers */
  trb_clearance     *clearances;
  trb_clearance_arms arms[TRB_N_GAPS];
} trb_dynamics;

/* motion may be NULL where only poses that the caller places are used. */
trb_status trb_dynamics_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_dynamics **dynamics,
                               trb_message *message);
void       trb_dynamics_free(trb_dynamics *dynamics);

/* Poses at (t, y), kept in the dynamics. */
void trb_dynamics_pose(trb_dynamics *d, double time, const double *y);
/* Pose of one roller only, from its part of a state. */
void trb_dynamics_pose_roller(trb_dynamics *d, int roller, const double *y_roller);
/* All loads at the poses kept; detail may be NULL. */
void trb_dynamics_loads(trb_dynamics *d, trb_detail *detail);
/* What the contacts read. */
trb_instant trb_dynamics_instant(const trb_dynamics *d);

/* A roller's share of the right-hand side: rates of its state, of its spin angle, and its powers in the quadratures
 * (docs/theory/energy.md#quadratures). It is affine in the loads: a part from inertia and gravity, and a part that is linear in the
 * loads (the response). */
enum {
  TRB_FLOW_spin = TRB_ROLLER_SIZE,
  TRB_FLOW_quadrature = TRB_ROLLER_SIZE + 1,
  TRB_FLOW_SIZE = TRB_FLOW_quadrature + TRB_N_QUADRATURES
};
void trb_dynamics_roller_inertia(const trb_dynamics *d, int roller, double *flow);
/* Added to a flow; the load is one that puts nothing on the inner ring. */
void trb_dynamics_roller_response(const trb_dynamics *d, int roller, const trb_roller_load *load, double *flow);
/* Both, and the work of the inner ring. */
void trb_dynamics_roller_flow(const trb_dynamics *d, int roller, const trb_roller_load *load, double *flow);

/* A right-hand side is made in three steps: start it, put in the flow of each roller, compute the rates of the cage. */
void trb_dynamics_start(const trb_dynamics *d, double *rates);
void trb_dynamics_put(const trb_dynamics *d, int roller, const double *flow, double *rates);
/* Whether a roller is proven not to touch its pocket at a state. */
int trb_dynamics_clear(const trb_dynamics *d, int roller, const double *y);
/* Adds the loads between a roller, whose pose is kept, and its pocket to the roller's flow and to the sums of the cage. */
void trb_dynamics_pocket(trb_dynamics *d, int roller, const double *y, double *flow, trb_vec3 *cage_force, trb_vec3 *cage_moment);
/* Rates of the cage under the sum of what the rollers put on it. */
void trb_dynamics_cage_rates(const trb_dynamics *d, const double *y_cage, trb_vec3 force, trb_vec3 moment, double *rates);
/* Right-hand side of everything. */
void trb_dynamics_derivative(trb_dynamics *d, double time, const double *y, double *rates);

#endif
