/* The right-hand side of the equations of motion, y' = f(t, y): Newton's and Euler's equations of each roller and each body of the hub, in
 * frames that orbit with them (docs/theory/motion.md#newtons-equations). One recipe, exact or with an approximation of the slow pairs'
 * forces; its parts, which the Jacobian, records and peaks use, too. All that is found is kept in the dynamics. */
#ifndef TRB_MOTION_RHS_H
#define TRB_MOTION_RHS_H

#include "motion/dynamics.h"

/* What is prescribed at a time, and where bodies without coordinates are then. */
void trb_dynamics_drive(trb_dynamics *d, double time);
/* Bodies without coordinates where the drive that is kept puts them. */
void trb_dynamics_place(trb_dynamics *d);
/* A state with its rollers where a spacer holds them, and the drive of its time kept; the state itself where there is none. */
const double *trb_dynamics_held(trb_dynamics *d, double time, const double *y);
/* Poses at (t, y); those of the hub and of n chosen rollers of a state in which a spacer's rollers are where it holds them. */
void trb_dynamics_pose(trb_dynamics *d, double time, const double *y);
void trb_dynamics_pose_of(trb_dynamics *d, double time, const double *y, const int *chosen, int n);
/* Poses of the bodies of the hub only; of one of them, from its part of a state; of one roller, likewise, rings standing where they were put. */
void trb_dynamics_pose_hub(trb_dynamics *d, const double *y);
void trb_dynamics_pose_body(trb_dynamics *d, int body, const double *y_body);
void trb_dynamics_pose_roller(trb_dynamics *d, int roller, const double *y_roller);
/* A ring as a roller sees it at a pose. */
trb_ring_pose trb_dynamics_ring_seen(const trb_dynamics *d, int body, const trb_roller_pose *roller);
/* The angle that a roller has turned by about its axis, out of a state, where surfaces are off their true form; gives whether one of them may
 * be where the roller is. Rings stand where they were put. */
int trb_dynamics_spin_roller(trb_dynamics *d, int roller, const double *y);
/* The longest step that steps over no part of such a surface, at the speeds that are kept, s. */
double trb_dynamics_longest_step(const trb_dynamics *d);

/* Loads of the rollers of an instant: of the slow pairs, of all bodies or of one alone (TRB_ANY_BODY: all). detail may be NULL. */
enum { TRB_ANY_BODY = -1 };
void trb_dynamics_slow(trb_dynamics *d, const trb_instant *at, int body, trb_detail *detail);
/* Loads of the pairs without a roller. */
void trb_dynamics_hub(trb_dynamics *d, trb_detail *detail);
/* All loads at the poses kept. apart: pairs that are proven not to touch (trb_fast_apart) and are left out, which changes no bit; or NULL. */
void trb_dynamics_loads(trb_dynamics *d, const unsigned *apart, trb_detail *detail);

/* A roller's flow under loads, without fast pairs. */
void trb_dynamics_roller_flow(const trb_dynamics *d, int roller, const trb_loads *loads, double *flow);
/* What a roller's loads do to the rings that have coordinates, in R; its pose is kept. */
void trb_dynamics_roller_reactions(const trb_dynamics *d, int roller, const trb_loads *loads, trb_wrench *reactions);
/* Puts a roller's flow into the rates. */
void trb_dynamics_put(const trb_dynamics *d, int roller, const double *flow, double *rates);
/* Adds what bodies lose in themselves, at the poses kept, to a list of losses. */
void trb_dynamics_book_bodies(const trb_dynamics *d, double *losses);
/* Rates of a body at its pose under a load, by coordinate; of a carried body, whose coordinates another system has, what the load adds. */
void trb_dynamics_body_rates(const trb_dynamics *d, int body, const double *y, const trb_wrench *load, double *rates);

/* What may stand for the slow pairs' forces on a roller between their exact evaluations; stepping/tangent.h makes one. It knows surfaces of
 * true form: it is left out where a roller may be on one that is not, and learns nothing there. */
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

/* The same in two parts, for n chosen rollers and the hub as if there were no others: flows of these rollers (d->flows) with the loads that they
 * put on the hub; then the rates of the hub, with the quadratures of what belongs to no roller, or to those that were put in between
 * (trb_dynamics_put). */
void trb_rhs_rollers(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, const int *chosen, int n,
                     double *rates);
void trb_rhs_hub(trb_dynamics *d, const double *y, double *rates);
/* Flow of one roller that touches nothing which has coordinates: nothing but its own part of a state is read. */
void trb_rhs_alone(trb_dynamics *d, const trb_approximation *instead, double time, int roller, const double *y_roller);

#endif
