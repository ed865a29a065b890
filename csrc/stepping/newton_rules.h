/* The rules of Newton's method that hold for every implicit step (docs/theory/numerics.md#newtons-method); newton.c says why. */
#ifndef TRB_STEPPING_NEWTON_RULES_H
#define TRB_STEPPING_NEWTON_RULES_H

#include <math.h>
#include <string.h>

#include "stepping/constants.h"

/* Weighted product of two vectors. Eight sums side by side: one alone would wait for each of its additions. */
static inline double trb_weighted_product(int n, const double *a, const double *b, const double *weight)
{
  double sum[8] = {0};
  int    i = 0;
  for (; i + 8 <= n; i += 8)
    for (int k = 0; k < 8; k++) sum[k] += a[i + k] * weight[i + k] * (b[i + k] * weight[i + k]);
  for (int k = 0; i < n; i++, k++) sum[k] += a[i] * weight[i] * (b[i] * weight[i]);
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

/* Whether equations hold well enough: what they lack, and what they lacked before the last correction; failing: the share of solves that fail. */
static inline int trb_newton_holds(double failing, double off, double before, double tolerance)
{
  if (failing > trb_failing_sometimes) return off <= trb_newton_close * tolerance;
  return off <= trb_newton_negligible * tolerance || (off <= tolerance && off <= trb_newton_contraction * before);
}

/* Turns n entries of the plain correction into those of Broyden's method and stores them; m: number of corrections that were taken before, which are
 * `stride` apart. Broyden's update of M^-1 is a matrix of rank one for each correction s_j, so it is applied without any matrix: with k_j = (s_j .
 * delta)/(s_j . s_j), delta is replaced by delta + k_j s_(j+1) for each earlier correction, and by delta/(1 - k_j) for the last one. The
 * products are those of the weighted entries. square: those of the corrections with themselves. */
static inline void trb_newton_improve(int m, int n, const double *weight, double *delta, double *taken, size_t stride, double *square)
{
  for (int j = 0; j < m; j++) {
    if (!(square[j] > 0.0)) continue;
    const double *s = taken + (size_t)j * stride, kept = trb_weighted_product(n, s, delta, weight) / square[j];
    if (j + 1 < m) {
      const double *next = s + stride;
      for (int i = 0; i < n; i++) delta[i] += kept * next[i];
    } else {
      const double scale = 1.0 / (1.0 - fmin(kept, trb_broyden_most_kept));
      for (int i = 0; i < n; i++) delta[i] *= scale;
    }
  }
  memcpy(taken + (size_t)m * stride, delta, (size_t)n * sizeof *delta);
  square[m] = trb_weighted_product(n, delta, delta, weight);
}

#endif
