/* The part of a roller's tangent (stepping/tangent.h) that belongs to a ring with coordinates. Its inputs are the ring's place and motion in the
 * frame R, eleven numbers, the same for all rollers, beside the roller's own coordinates; besides the flow it gives the reaction, the wrench on the
 * ring about its centre in R. As R turns, a ring which stands still off the bearing's axis moves in it. */
#ifndef TRB_STEPPING_RING_TANGENT_H
#define TRB_STEPPING_RING_TANGENT_H

#include "motion/dynamics.h"
#include "stepping/constants.h"

/* Of the ring: its centre, its axis (x, y), its velocity, its angular velocity; of the reaction: force, moment, padding. */
enum {
  TRB_RING_IN = 11,
  TRB_RING_ROOM = 12, /* the same, padded by zeros */
  TRB_RING_OUT = 8,
  TRB_WRENCH = 6,
  TRB_RING_OF_ROLLER = 12,
  TRB_RING_ALL = TRB_RING_OF_ROLLER + TRB_RING_IN
};

typedef struct trb_ring_slopes {
  double flow[TRB_RING_IN][TRB_FLOW_ROOM];     /* of the roller's flow with the ring's inputs, column by column */
  double reaction[TRB_RING_ALL][TRB_RING_OUT]; /* of the reaction, with the roller's inputs and then the ring's */
} trb_ring_slopes;

typedef struct trb_ring_tangent {
  _Alignas(TRB_CACHE_LINE * sizeof(double)) trb_ring_slopes slopes; /* with Broyden's corrections */
  double          value[TRB_RING_OUT];                              /* reaction at the origin */
  double          origin[TRB_RING_ROOM];                            /* inputs there */
  double          per[TRB_RING_ROOM];                               /* weights of a distance */
  double          curve[TRB_RING_OUT]; /* of the reaction, and the ring's part of its direction: see trb_tangent */
  double          along[TRB_RING_ROOM];
  trb_ring_pose   from;           /* the ring there, in inertial coordinates */
  trb_ring_slopes by_differences; /* slopes as differences gave them; last, as they are seldom read */
} trb_ring_tangent;

/* A ring's inputs in R, which is turned against the frame of the ring's pose; or the slopes of inputs, from those of a pose. */
void trb_ring_inputs(const trb_ring_pose *ring, const trb_drive *drive, double *inputs);
/* Moves a ring, as a roller sees it, by one of its inputs; cosine, sine: of the roller's angle in R. */
void trb_ring_move(trb_ring_pose *ring, int input, double by, double cosine, double sine);
/* A wrench in R as a reaction, and back. */
void       trb_ring_reaction(const trb_wrench *wrench, double *reaction);
trb_wrench trb_ring_wrench(const double *reaction);

#endif
