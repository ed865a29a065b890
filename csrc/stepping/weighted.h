/* Weighted product of two vectors, on which the norm and the angles of Newton's method are built. */
#ifndef TRB_STEPPING_WEIGHTED_H
#define TRB_STEPPING_WEIGHTED_H

/* Sum of a_i w_i b_i w_i. Eight sums side by side: one alone would wait for each of its additions. */
static inline double trb_weighted_product(int n, const double *a, const double *b, const double *weight)
{
  double sum[8] = {0};
  int    i = 0;
  for (; i + 8 <= n; i += 8)
    for (int k = 0; k < 8; k++) sum[k] += a[i + k] * weight[i + k] * (b[i + k] * weight[i + k]);
  for (int k = 0; i < n; i++, k++) sum[k] += a[i] * weight[i] * (b[i] * weight[i]);
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

#endif
