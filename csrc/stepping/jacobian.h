/* Jacobian of the right-hand side (docs/theory/numerics.md#jacobian). The part of the slow pairs and of inertia is computed by differences, those of
 * raceways along slopes of their laws (contact/law_slopes.h), all rollers moved at once, and kept until it is old, or poor for single rollers. The part of the fast pairs, which changes with each impact, comes in
 * closed form with their forces, for rollers that touch alone. Pairs without a roller are part of the block of the hub, by differences. A ring
 * with coordinates has borders to all rollers: the slopes that tangents have with its place and motion, times what its coordinates do to these. */
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
  double *
      response; /* scratch, of rings with coordinates, of bodies that deform, and of those of the hub where a roller is added: [force or moment in R][rate]: what a unit of it does */
  double (*with)[TRB_RING_IN]; /* scratch, of rings with coordinates: slopes of their inputs with each coordinate */
  /* scratch, of each ring with coordinates: the response again, and what moves the ring with each of its coordinates */
  double (*ring_response)[TRB_WRENCH][TRB_NP], (*ring_reactions)[TRB_NP][TRB_RING_OUT];
  trb_modal *modal[TRB_MOST_BODIES]; /* of bodies that deform */
  int       *renewed;                /* rollers whose slopes are taken again at the next fill, ascending */
  int        n_renewed;
  long       rings_evaluations;
  trb_memory memory; /* of all arrays */
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
/* Adds one more roller to a system of chosen rollers that was filled so and has no rings with coordinates and no body that deforms: its block, its borders,
 * and what it does to the hub's block. */
void trb_jacobian_add(trb_jacobian *jacobian, double time, const double *y, int roller, trb_arrow *arrow);

#endif
