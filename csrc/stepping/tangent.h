/* Tangents of the rollers' flows under the forces of raceways and ribs: what the rings' part of the Jacobian is made of, and, where a
 * run allows it, what stands for these forces between their exact evaluations.
 *
 * Each roller has a tangent of its own. It is exact at an origin and is used within a distance about it, its reach. An evaluation beyond
 * the reach is exact; it becomes the origin, corrects the slopes along the way that was gone (Broyden's update), and the error that it finds
 * sets the reach, so that the error stays near a given share of a step's tolerance. A tangent that would be used too seldom is not used at
 * all: each new origin puts a small step into the forces, which costs the integrator more than it saves.
 *
 * What was learned in one direction says little of another, and a tangent knows nothing of gaps and of oil that yields. So two bounds hold
 * whatever the reach is. No contact with a raceway or a rib can begin or end while a tangent is followed: motion/margin.h proves it, with
 * room to spare. And a roller slips away from the origin by no more than a share of its rolling speed, within which friction is linear. */
#ifndef TRB_STEPPING_TANGENT_H
#define TRB_STEPPING_TANGENT_H

#include "motion/margin.h"
#include "motion/rhs.h"
#include "stepping/arrow.h"

/* Place of the frame's angle in an origin. */
enum { TRB_TANGENT_TURN = TRB_NR };
_Static_assert(TRB_TANGENT_IN == TRB_NR + 1 && (int)TRB_FLOW_ROOM == (int)TRB_TANGENT_OUT,
               "room for a roller's state, an angle and its flow");

typedef struct trb_tangent {
  double slope[TRB_TANGENT_IN][TRB_TANGENT_OUT]; /* column by column, corrected */
  double found[TRB_NR][TRB_NR];                  /* rates' slopes as differences gave them, column by column */
  double value[TRB_TANGENT_OUT];                 /* flow at the origin */
  double origin[TRB_TANGENT_IN];                 /* where it is exact */
  double per[TRB_TANGENT_IN]; /* what measures distances: one over the tolerances there, so that the sum of squares is their mean */
  double reach;               /* distance up to which it is used */
  double margin[TRB_N_PAIRS]; /* of the contacts at the origin, m */
  double usual;               /* evaluations that an origin is used for, running mean */
  int    served;              /* by this origin */
  int    known;               /* 0: there is no origin */
} trb_tangent;

typedef struct trb_tangents {
  const trb_model *model;
  trb_tangent     *rollers;
  double           least[TRB_TANGENT_OUT], anything[TRB_TANGENT_OUT]; /* lower bounds of flows that are followed, and none */
  const struct trb_tangent_measure *measure;                          /* of the evaluation under way */
  int                               under_way;                        /* the prescribed motion is: everything is exact */
  int                              *beyond;                           /* scratch: whether a roller is beyond its reach */
  trb_margin_arms                   arms;                             /* what bounds the change of an interference */
  double                            time;                             /* at which slopes were last evaluated, s */
  int                               has_slopes;                       /* whether they were at all */
} trb_tangents;

/* What the error of a tangent is measured with. */
typedef struct trb_tangent_measure {
  const double            *relative, *scale; /* tolerances, an entry of the state each */
  const trb_arrow_factors *factors;          /* of the integrator's last linear system; an error in rates is one in the state by it */
  double                   share;            /* of the step's tolerance that an error may be */
  double                   margin_share;     /* of the margins that a roller may use up */
  double                   slip_share;       /* of the mean rolling speed that a roller may slip away */
} trb_tangent_measure;

/* Differences by kind of entry: small beside what curves the laws (micrometres of interference, 1e-4 of slip), large beside rounding. */
extern const double trb_difference[TRB_N_TOLERANCES];

trb_status trb_tangents_create(const trb_model *m, trb_tangents **tangents, trb_message *message);
void       trb_tangents_free(trb_tangents *tangents);
/* Forget origins, reaches and slopes. */
void trb_tangents_forget(trb_tangents *tangents);
/* Slopes anew by differences about a state whose poses d holds; moved: scratch as long as a state. */
void trb_tangents_differentiate(trb_tangents *tangents, trb_dynamics *d, const double *y, double *moved);

/* Column of a roller's block of the Jacobian: of its tangent if that is used, else as differences gave it. */
const double *trb_tangents_column(const trb_tangents *tangents, int roller, int column);

/* Right-hand side with tangents in place of the rings' forces where they serve; exact where the prescribed motion is under way. */
void trb_tangents_derivative(trb_tangents *tangents, trb_dynamics *d, const trb_tangent_measure *measure, double time, const double *y,
                             double *rates);

#endif
