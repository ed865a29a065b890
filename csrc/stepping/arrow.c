#include "stepping/arrow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

trb_status trb_arrow_create(int n_rollers, int with_cage, trb_arrow **arrow, trb_message *message)
{
  trb_arrow *a = calloc(1, sizeof *a);
  *arrow = NULL;
  if (a != NULL) a->rollers = calloc((size_t)n_rollers, sizeof *a->rollers);
  if (a == NULL || a->rollers == NULL) {
    free(a);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian of %d rollers", n_rollers);
  }
  a->n = n_rollers;
  a->with_cage = with_cage;
  *arrow = a;
  return TRB_OK;
}

void trb_arrow_free(trb_arrow *arrow)
{
  if (arrow == NULL) return;
  free(arrow->rollers);
  free(arrow);
}

void trb_arrow_zero(trb_arrow *arrow)
{
  memset(arrow->rollers, 0, (size_t)arrow->n * sizeof *arrow->rollers);
  memset(arrow->cage, 0, sizeof arrow->cage);
}

void trb_arrow_copy(const trb_arrow *from, trb_arrow *to)
{
  memcpy(to->rollers, from->rollers, (size_t)from->n * sizeof *from->rollers);
  memcpy(to->cage, from->cage, sizeof from->cage);
}

void trb_arrow_scale_add_identity(trb_arrow *arrow, double c)
{
  for (int j = 0; j < arrow->n; j++) {
    trb_arrow_block *b = &arrow->rollers[j];
    for (int i = 0; i < TRB_NR * TRB_NR; i++) (&b->own[0][0])[i] *= c;
    for (int i = 0; i < TRB_NR; i++) b->own[i][i] += 1.0;
    if (!b->coupled) continue;
    for (int i = 0; i < TRB_NR * TRB_NC; i++) {
      (&b->to_cage[0][0])[i] *= c;
      (&b->from[0][0])[i] *= c;
    }
  }
  for (int i = 0; i < TRB_NC; i++) {
    for (int k = 0; k < TRB_NC; k++) arrow->cage[i][k] *= c;
    arrow->cage[i][i] += 1.0;
  }
}

trb_status trb_arrow_factors_create(int n_rollers, trb_arrow_factors **factors, trb_message *message)
{
  trb_arrow_factors *f = calloc(1, sizeof *f);
  *factors = NULL;
  if (f != NULL) f->rollers = calloc((size_t)n_rollers, sizeof *f->rollers);
  if (f == NULL || f->rollers == NULL) {
    free(f);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the factors of %d rollers", n_rollers);
  }
  f->n = n_rollers;
  *factors = f;
  return TRB_OK;
}

void trb_arrow_factors_free(trb_arrow_factors *factors)
{
  if (factors == NULL) return;
  free(factors->rollers);
  free(factors);
}

/* LU with row pivoting of a row-major n x n matrix, in place; rows of `right` (width columns) are exchanged and eliminated along with
 * it. Inlined with constant sizes. */
static inline int factor(double *a, int *pivot, int n, double *right, int width)
{
  for (int c = 0; c < n; c++) {
    int best = c;
    for (int i = c + 1; i < n; i++)
      if (fabs(a[i * n + c]) > fabs(a[best * n + c])) best = i;
    pivot[c] = best;
    if (!(fabs(a[best * n + c]) > 0.0) || !isfinite(a[best * n + c])) return 0;
    if (best != c) {
      for (int k = 0; k < n; k++) {
        const double keep = a[c * n + k];
        a[c * n + k] = a[best * n + k];
        a[best * n + k] = keep;
      }
      for (int k = 0; k < width; k++) {
        const double keep = right[c * width + k];
        right[c * width + k] = right[best * width + k];
        right[best * width + k] = keep;
      }
    }
    const double per = 1.0 / a[c * n + c];
    for (int i = c + 1; i < n; i++) {
      const double m = a[i * n + c] *= per;
      if (m == 0.0) continue;
      for (int k = c + 1; k < n; k++) a[i * n + k] -= m * a[c * n + k];
      for (int k = 0; k < width; k++) right[i * width + k] -= m * right[c * width + k];
    }
    /* the reciprocal serves every solve */
    a[c * n + c] = per;
  }
  return 1;
}

/* Back substitution of `width` right-hand sides with the upper factor. */
static inline void back(const double *a, int n, double *right, int width)
{
  for (int i = n - 1; i >= 0; i--) {
    for (int c = i + 1; c < n; c++) {
      const double u = a[i * n + c];
      for (int k = 0; k < width; k++) right[i * width + k] -= u * right[c * width + k];
    }
    for (int k = 0; k < width; k++) right[i * width + k] *= a[i * n + i];
  }
}

/* Row exchanges were applied to whole rows while factoring, so multipliers stand in final order: exchange first, then substitute. */
static void solve_cage(const trb_arrow_factors *f, double *x)
{
  const double *a = &f->lu[0][0];
  for (int c = 0; c < TRB_NC; c++) {
    const double keep = x[f->pivot[c]];
    x[f->pivot[c]] = x[c];
    x[c] = keep;
  }
  for (int i = 1; i < TRB_NC; i++) {
    double sum = x[i];
    for (int c = 0; c < i; c++) sum -= a[i * TRB_NC + c] * x[c];
    x[i] = sum;
  }
  back(a, TRB_NC, x, 1);
}

/* One roller: its inverse, and where it touches the cage, inverse times border and its share of the Schur complement. */
static int factor_roller(const trb_arrow_block *b, trb_arrow_factor_block *g, double (*schur)[TRB_NC])
{
  double lu[TRB_NR][TRB_NR], inverse[TRB_NR][TRB_NP] = {{0}};
  int    pivot[TRB_NR];
  memcpy(lu, b->own, sizeof lu);
  for (int i = 0; i < TRB_NR; i++) inverse[i][i] = 1.0;
  if (!factor(&lu[0][0], pivot, TRB_NR, &inverse[0][0], TRB_NP)) return 0;
  back(&lu[0][0], TRB_NR, &inverse[0][0], TRB_NP);
  for (int c = 0; c < TRB_NR; c++)
    for (int i = 0; i < TRB_NR; i++) g->inverse[c][i] = inverse[i][c];
  g->coupled = b->coupled;
  if (!b->coupled) return 1;
  memset(g->solved, 0, sizeof g->solved);
  for (int c = 0; c < TRB_NC; c++)
    for (int q = 0; q < TRB_NR; q++) {
      const double m = b->to_cage[q][c];
      for (int i = 0; i < TRB_NP; i++) g->solved[c][i] += m * g->inverse[q][i];
    }
  for (int i = 0; i < TRB_NC; i++)
    for (int q = 0; q < TRB_NR; q++) g->from[q][i] = b->from[i][q];
  for (int i = 0; i < TRB_NC; i++)
    for (int k = 0; k < TRB_NC; k++)
      for (int q = 0; q < TRB_NR; q++) schur[i][k] -= b->from[i][q] * g->solved[k][q];
  return 1;
}

int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *f)
{
  memcpy(f->lu, arrow->cage, sizeof f->lu);
  for (int j = 0; j < arrow->n; j++)
    if (!factor_roller(&arrow->rollers[j], &f->rollers[j], f->lu)) return 0;
  return factor(&f->lu[0][0], f->pivot, TRB_NC, NULL, 0);
}

/* to += sign times a sum of columns */
static inline void add_columns(const double *columns, int stride, const double *x, int n, double sign, double *to, int length)
{
  for (int c = 0; c < n; c++) {
    const double m = sign * x[c];
    for (int i = 0; i < length; i++) to[i] += m * columns[c * stride + i];
  }
}

void trb_arrow_solve(const trb_arrow_factors *f, double *x)
{
  double *cage = x + f->n * TRB_NR;
  for (int j = 0; j < f->n; j++) {
    const trb_arrow_factor_block *g = &f->rollers[j];
    double                        xj[TRB_NP] = {0};
    add_columns(&g->inverse[0][0], TRB_NP, x + j * TRB_NR, TRB_NR, 1.0, xj, TRB_NP);
    memcpy(x + j * TRB_NR, xj, TRB_NR * sizeof *x);
    if (g->coupled) add_columns(&g->from[0][0], TRB_NC, xj, TRB_NR, -1.0, cage, TRB_NC);
  }
  solve_cage(f, cage);
  for (int j = 0; j < f->n; j++)
    if (f->rollers[j].coupled) add_columns(&f->rollers[j].solved[0][0], TRB_NP, cage, TRB_NC, -1.0, x + j * TRB_NR, TRB_NR);
}
