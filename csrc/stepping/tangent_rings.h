/* What tangents (stepping/tangent.h) do with the parts that belong to rings with coordinates (stepping/ring_tangent.h). */
#ifndef TRB_STEPPING_TANGENT_RINGS_H
#define TRB_STEPPING_TANGENT_RINGS_H

#include "stepping/tangent.h"

/* A roller's part that belongs to a ring. */
static inline trb_ring_tangent *trb_tangents_ring_of(const trb_tangents *t, int roller, int ring)
{
  return &t->rings[(size_t)roller * (size_t)t->system->n_moving + (size_t)ring];
}
/* Slopes of the reactions with an input, at moved poses whose loads are kept; only: on this ring, or on all for -1. */
void trb_rings_differentiate_reactions(trb_tangents *t, const trb_dynamics *d, int roller, int input, double per, int only);
/* The rings with coordinates as every roller sees them are kept, or put back. */
void trb_rings_see(trb_tangents *t, trb_dynamics *d, int put_back);
/* The origin of each roller's part that belongs to a ring. */
void trb_rings_begin(trb_tangents *t, const trb_dynamics *d, int roller);
/* Slopes of n chosen rollers with the inputs of the rings. Only contacts with the ring that is moved change. */
void trb_rings_differentiate(trb_tangents *t, trb_dynamics *d, const int *chosen, int n);
/* Error of a step of the ring, in tolerances, from an error in a reaction, if those of all rollers are alike; moments count by an arm of
 * half the pitch diameter. */
double trb_rings_error(const trb_tangents *t, const trb_ring_tangent *ring, const trb_tangent_measure *measure, const double *error);
/* The inputs of the rings at the poses kept in the dynamics. */
void trb_rings_place(trb_tangents *t, const trb_dynamics *d);
/* Their steps from a roller's origin, one ring after the other; gives the sum of squares of weighted steps. */
double trb_rings_step(const trb_tangents *t, int roller, double (*steps)[TRB_RING_ROOM]);
/* Broyden's correction of the part of a ring by the errors of flow and reaction. to_roller, to_ring: directions of the correction. */
void trb_rings_correct(trb_ring_tangent *ring, const double *in_flow, const double *in_reaction, const double *to_roller,
                       const double *to_ring);
/* The rings where they are now, and the exact reactions on them, become the origin. */
void trb_rings_move_origin(trb_tangents *t, const trb_dynamics *d, int roller, const trb_tangent_measure *measure,
                           const trb_wrench *reactions);
/* How far the rings with coordinates have moved since a roller's origin: what bounds need is put into their offsets; gives the speed at which
 * surfaces there slide away, m/s. */
double trb_rings_moved(trb_tangents *t, const trb_dynamics *d, int roller);

#endif
