/* Tangents of the forces of raceways and ribs (docs/theory/numerics.md#tangents-of-raceway-and-rib-forces): between exact evaluations a roller's
 * flow, its part of the right-hand side, is taken from a linear approximation in its coordinates and the angle of the frame R. The same slopes
 * are the part of the Jacobian that belongs to raceways and ribs.
 *
 * A tangent is exact at its origin and used up to a distance from there, its reach, which is measured in tolerances. Beyond it contacts are
 * evaluated exactly: that point is the new origin, and the error of the prediction there corrects the slopes (Broyden's update) and the bend along
 * the way, and sets the new reach. Whatever the reach, no contact may begin or end while a tangent is followed (motion/bound.h), and slip changes
 * within the range in which friction is linear. A ring that moves by itself adds inputs and outputs of its own (stepping/ring_tangent.h). */
#ifndef TRB_STEPPING_TANGENT_H
#define TRB_STEPPING_TANGENT_H

#include <math.h>

#include "motion/bound.h"
#include "motion/rhs.h"
#include "stepping/arrow.h"

/* Index of the angle of the frame R in an origin. */
enum { TRB_TANGENT_TURN = TRB_NR };
_Static_assert(TRB_TANGENT_IN == TRB_NR + 1, "room for a roller's state and an angle");

typedef struct trb_tangent {
  _Alignas(TRB_CACHE_LINE *
           sizeof(double)) double slope[TRB_TANGENT_IN][TRB_TANGENT_OUT]; /* column by column, with Broyden's corrections */
  double value[TRB_TANGENT_OUT];                                          /* flow at the origin */
  double origin[TRB_TANGENT_IN];                                          /* where it is exact */
  double per[TRB_TANGENT_IN];            /* weights of a distance: one over tolerance, scaled so that the sum of squares is a mean */
  double curve[TRB_TANGENT_OUT];         /* bend of the flow along the way on which the origins lie; zero: none is known */
  double along[TRB_TANGENT_IN];          /* times a step: its part of the last step between origins, of which this is the direction */
  int    bends;                          /* 1: the curve is not zero */
  double length;                         /* of the last step between origins; 0: slopes were found at the origin */
  double reach;                          /* distance up to which it is used */
  double margin[TRB_MOST_PAIRS];         /* of the contacts at the origin, m */
  double mean_uses;                      /* for how many evaluations an origin is used: running mean */
  int    uses;                           /* for how many this one was */
  int    has_origin;                     /* 0: there is no origin */
  int    corrected;                      /* how often its slopes were corrected since they were computed by differences */
  double by_differences[TRB_NR][TRB_NR]; /* slopes of the rates as differences gave them, column by column; last, as they are seldom read */
} trb_tangent;

typedef struct trb_tangents {
  const trb_model  *model;
  const trb_system *system;
  trb_tangent      *rollers;
  trb_ring_tangent *rings;                    /* of every roller, one for each ring with coordinates */
  trb_ring_pose    *seen;                     /* scratch: those rings as each roller sees them */
  double (*flows_of_one_ring)[TRB_FLOW_ROOM]; /* scratch: flows of every roller under the contacts with one ring alone */
  double least_mass;                          /* of these rings, for one roller, kg */
  double lower_bound[TRB_TANGENT_OUT], no_bound[TRB_TANGENT_OUT]; /* lower bounds of a flow that follows a tangent; no bounds */
  const struct trb_tangent_measure *measure;                      /* of the evaluation under way */
  int                               under_way;                    /* the prescribed motion is: everything is exact */
  double                            slip;                     /* by which a roller may slip away from its origin in this evaluation, m/s */
  int                              *out_of_bounds;            /* scratch: whether a bound of the tangent is passed */
  trb_ring_offset                   offsets[TRB_MOST_BODIES]; /* of the rings, in this evaluation */
  double                            inputs[TRB_MOST_MOVING_RINGS][TRB_RING_ROOM]; /* of those with coordinates, in this evaluation */
  trb_ring_arms                     arms;                                         /* what bounds the change of an interference */
  double                            time;       /* at which the slopes of all rollers were last evaluated, s */
  int                               has_slopes; /* whether they were at all */
  trb_memory                        memory;     /* of all arrays */
} trb_tangents;

/* Limits of a tangent, and what its error is measured with. */
typedef struct trb_tangent_measure {
  const double            *relative, *scale; /* tolerance of each entry of the state */
  const trb_block_kernels *kernels;
  double                   gamma;        /* of the step's linear system: it turns an error of rates into one of a step; 0: there is none */
  double                   share;        /* of the step's tolerance that an error may be */
  double                   margin_share; /* of the margins that a roller may use up */
  double                   slip_share;   /* of the mean rolling speed that a roller may slip away */
} trb_tangent_measure;

/* Weight of a coordinate in a distance, one over its tolerance; like: a roller's coordinate of the same kind. */
static inline double trb_tangent_weight(const trb_tangent_measure *measure, int like, double value)
{
  return 1.0 / (sqrt((double)TRB_NR) * (measure->relative[like] * fabs(value) + measure->scale[like]));
}

trb_status trb_tangents_create(const trb_system *system, trb_tangents **tangents, trb_message *message);
void       trb_tangents_free(trb_tangents *tangents);
/* Forget origins, reaches and slopes. */
void trb_tangents_forget(trb_tangents *tangents);
/* Computes the slopes of n chosen rollers by differences about a state at which d holds their poses and those of the hub; moved: that state, as
 * scratch. Other rollers are left as they are. */
void trb_tangents_differentiate(trb_tangents *tangents, trb_dynamics *d, const int *chosen, int n, const double *y, double *moved);

/* Whether a roller's slopes were corrected so often that they are to be computed again. */
int trb_tangents_are_worn(const trb_tangents *tangents, int roller);

/* Column of a roller's block of the Jacobian: from its tangent if that is in use, else as differences gave it. */
const double *trb_tangents_column(const trb_tangents *tangents, int roller, int column);
/* A roller's part that belongs to a ring with coordinates, and its slopes, chosen likewise. */
const trb_ring_tangent *trb_tangents_ring(const trb_tangents *tangents, int roller, int ring);
const trb_ring_slopes  *trb_tangents_ring_slopes(const trb_tangents *tangents, int roller, int ring);

/* The tangents as what stands for the forces of raceways and ribs in a right-hand side (motion/rhs.h), by a measure that must stay while it
 * is in use. */
trb_approximation trb_tangents_open(trb_tangents *tangents, const trb_tangent_measure *measure);
/* Right-hand side with tangents in place of the forces of raceways and ribs where their bounds allow it. All forces are exact while the
 * prescribed motion changes. */
void trb_tangents_derivative(trb_tangents *tangents, trb_dynamics *d, const trb_tangent_measure *measure, double time, const double *y,
                             double *rates);

#endif
