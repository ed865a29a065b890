/* Static equilibrium at speed: where the inner ring and the rollers settle under a load, without friction, gravity or cage
 * (docs/theory/motion.md#equilibrium-of-the-ring).
 *
 * Unknowns: (r, z, tilt, skew) of each roller and five coordinates of the ring (dx, dy, dz, rx, ry), each free under its load or prescribed.
 * Rollers are coupled only through the ring, so a Newton step solves one small system for each roller and one of five equations.
 * Contacts are gradients of an energy: steps are damped until the total potential falls (Levenberg-Marquardt).
 *
 * The stiffness of the ring at the solution is that of its five coordinates, all free, with rollers that stay in equilibrium: their
 * unknowns are eliminated (docs/theory/motion.md#stiffness). */
#ifndef TRB_MOTION_EQUILIBRIUM_H
#define TRB_MOTION_EQUILIBRIUM_H

#include "motion/dynamics.h"

enum { TRB_RING_FREEDOMS = 5, TRB_ROLLER_FREEDOMS = 4, TRB_EQUILIBRIUM_LOADS = 3 };

typedef struct trb_equilibrium {
  double  load[TRB_RING_FREEDOMS];         /* in: force (3), N, and moment about x, y (2), N m, applied to the ring */
  int     fixed[TRB_RING_FREEDOMS];        /* in: 1 where the displacement is prescribed */
  double  displacement[TRB_RING_FREEDOMS]; /* in: prescribed values and the guess; out: m and rad */
  double  shaft_speed, carried_speed;      /* in: of the rings, rad/s */
  double *angles;                          /* in: orbit angles of the rollers, rad */
  int     warm;                            /* in: 1 where displacement and rollers are a guess close to the solution */
  double *rollers;                         /* in: guess; out: n_rollers rows of (r, z, tilt, skew) offsets */
  double *loads;     /* out: n_rollers rows of normal loads of the first three pairs (outer, inner, rib), N; NULL: not wanted */
  double *stiffness; /* out: of the ring with rollers in equilibrium, [force][displacement]; NULL: not wanted */
  double *follow;    /* out, with stiffness: n_rollers blocks of [roller's coordinate][displacement of the ring] */
  double  reaction[TRB_RING_FREEDOMS]; /* out: force, N, and moment about x, y, N m, that hold the ring against its rollers */
  double  on_other[TRB_RING_FREEDOMS]; /* out: of the rollers on the ring that is not driven: force, N, and moment about x, y through its
                                          reference point, N m */
  double  energy;                      /* out: elastic energy with the potentials of the rollers' inertia, whose slope is the reaction, J */
  double  residual;                    /* out: largest unbalanced force, N */
  int     iterations;                  /* out */
} trb_equilibrium;

trb_status trb_equilibrium_solve(const trb_system *system, trb_equilibrium *e, trb_message *message);

#endif
