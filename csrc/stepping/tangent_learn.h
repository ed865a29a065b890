/* How a tangent (stepping/tangent.h) learns from an exact evaluation: the point becomes its origin, its slopes explain what was found there, and its
 * reach and bend follow from how wrong it was (docs/theory/numerics.md#tangents-of-raceway-and-rib-forces). */
#ifndef TRB_STEPPING_TANGENT_LEARN_H
#define TRB_STEPPING_TANGENT_LEARN_H

#include "stepping/tangent_rings.h"

_Static_assert(TRB_TANGENT_IN % 4 == 0, "sums of four");

/* No bend is known, as slopes were found at the origin. */
void trb_tangent_straighten(trb_tangents *t, int roller);
/* An exact flow of a roller, with the reactions on the rings, at a state whose margins the dynamics have. */
void trb_tangent_learn(trb_tangents *t, const trb_dynamics *d, int roller, const double *y, const double *flow,
                       const trb_wrench *reactions);

/* A step along the way of the origins, over the last step between them. */
static inline double trb_tangent_share(const trb_tangents *t, int roller, const double *step, double (*of_ring)[TRB_RING_ROOM])
{
  const double *along = t->rollers[roller].along;
  double        sum[4] = {0}; /* side by side: one sum alone would wait for each of its additions */
  for (int i = 0; i < TRB_TANGENT_IN; i += 4)
    for (int k = 0; k < 4; k++) sum[k] += along[i + k] * step[i + k];
  for (int k = 0; k < t->system->n_moving; k++) {
    const double *of = trb_tangents_ring_of(t, roller, k)->along;
    for (int i = 0; i < TRB_RING_ROOM; i += 4)
      for (int q = 0; q < 4; q++) sum[q] += of[i + q] * of_ring[k][i + q];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* What the bend counts at a share of that step: nothing at both origins. */
static inline double trb_tangent_bend(double share) { return share * (share + 1.0); }

#endif
