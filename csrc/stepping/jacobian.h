/* Jacobian of the right-hand side (docs/theory/numerics.md#jacobian).
 *
 * It is the sum of two parts that change at different rates. The part of the slow pairs is what they and inertia do to each roller. It
 * changes slowly and is computed by differences: one evaluation of these pairs for each coordinate, with all rollers moved at once. It is
 * reused until it is old, or until a second Jacobian is asked for within one step; that of single rollers until Newton's method finds it
 * poor, or has corrected it often. The part of the fast pairs changes with each impact.
 * Only rollers that touch have it, and its slopes are computed in closed form together with the forces. Pairs without a roller are part of
 * the block of the hub, by differences. A ring with coordinates has borders to all rollers: they are the slopes that the tangents have with
 * the ring's place and motion, times what each of its coordinates does to these. */
#ifndef TRB_STEPPING_JACOBIAN_H
#define TRB_STEPPING_JACOBIAN_H

#include "motion/dynamics.h"
#include "stepping/modal.h"
#include "stepping/tangent.h"

typedef struct trb_jacobian {
  trb_dynamics *d;        /* not that of the integration, whose poses must stay */
  trb_tangents *tangents; /* they hold the part of the rings */
  double       *moved;    /* scratch: a state with one coordinate moved */
  double       *rates;    /* scratch: three times the rates of the hub */
  trb_wrench   *changes;  /* scratch: slopes of the loads of the hub's bodies with each of their own coordinates */
  double *response; /* scratch, of rings with coordinates and of bodies that deform: [force or moment in R][rate]: what a unit of it does */
  double (*with)[TRB_RING_IN];       /* scratch, of rings with coordinates: slopes of their inputs with each coordinate */
  trb_modal *modal[TRB_MOST_BODIES]; /* of bodies that deform */
  int       *renewed;                /* rollers whose slopes are taken again at the next fill, ascending */
  int        n_renewed;
  long       rings_evaluations;
} trb_jacobian;

trb_status trb_jacobian_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_jacobian **jacobian,
                               trb_message *message);
void       trb_jacobian_free(trb_jacobian *jacobian);
/* A roller's slopes are to be taken again at the next fill; in ascending order, each once. */
void trb_jacobian_renew(trb_jacobian *jacobian, int roller);
/* Slopes of raceways and ribs of n chosen rollers at a state, of which the other rollers are not read. */
void trb_jacobian_slopes(trb_jacobian *jacobian, double time, const double *y, const int *chosen, int n);
/* Fills the rollers' blocks and borders of its system and adds to the hub's block; the first system of an assembly comes first. fresh:
 * compute the part of the rings of all rollers again, too. */
void trb_jacobian_fill(trb_jacobian *jacobian, double time, const double *y, int fresh, trb_arrow *arrow);
/* The same as if the system had n chosen rollers only; those that are renewed must be among them. */
void trb_jacobian_fill_of(trb_jacobian *jacobian, double time, const double *y, int fresh, const int *chosen, int n, trb_arrow *arrow);

#endif
