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
  const size_t count = sizeof(trb_arrow_block) / sizeof(double);
  for (int j = 0; j < arrow->n; j++) {
    double *values = (double *)&arrow->rollers[j];
    for (size_t i = 0; i < count; i++) values[i] *= c;
    for (int i = 0; i < TRB_NR; i++) arrow->rollers[j].own[i][i] += 1.0;
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

/* Exchanges and forward substitution of one right-hand side, then back. */
static inline void solve(const double *a, const int *pivot, int n, double *x)
{
  for (int c = 0; c < n; c++) {
    const double keep = x[pivot[c]];
    x[pivot[c]] = x[c];
    x[c] = keep;
  }
  for (int i = 1; i < n; i++) {
    double sum = x[i];
    for (int c = 0; c < i; c++) sum -= a[i * n + c] * x[c];
    x[i] = sum;
  }
  back(a, n, x, 1);
}

int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *f)
{
  memcpy(f->lu, arrow->cage, sizeof f->lu);
  for (int j = 0; j < arrow->n; j++) {
    const trb_arrow_block  *b = &arrow->rollers[j];
    trb_arrow_factor_block *g = &f->rollers[j];
    memcpy(g->lu, b->own, sizeof g->lu);
    memcpy(g->solved, b->to_cage, sizeof g->solved);
    const int width = arrow->with_cage ? TRB_NC : 0;
    if (width > 0 ? !factor(&g->lu[0][0], g->pivot, TRB_NR, &g->solved[0][0], TRB_NC) : !factor(&g->lu[0][0], g->pivot, TRB_NR, NULL, 0)) return 0;
    if (width == 0) continue;
    back(&g->lu[0][0], TRB_NR, &g->solved[0][0], TRB_NC);
    for (int i = 0; i < TRB_NC; i++)
      for (int q = 0; q < TRB_NR; q++) {
        const double m = b->from[i][q];
        if (m == 0.0) continue;
        for (int k = 0; k < TRB_NC; k++) f->lu[i][k] -= m * g->solved[q][k];
      }
  }
  return factor(&f->lu[0][0], f->pivot, TRB_NC, NULL, 0);
}

/* Row exchanges were applied to whole rows while factoring, so multipliers stand in final order: exchange first, then substitute. */
void trb_arrow_solve(const trb_arrow *arrow, const trb_arrow_factors *f, double *x)
{
  double *cage = x + arrow->n * TRB_NR;
  for (int j = 0; j < arrow->n; j++) {
    double *xj = x + j * TRB_NR;
    solve(&f->rollers[j].lu[0][0], f->rollers[j].pivot, TRB_NR, xj);
    if (!arrow->with_cage) continue;
    for (int i = 0; i < TRB_NC; i++) {
      double sum = 0.0;
      for (int q = 0; q < TRB_NR; q++) sum += arrow->rollers[j].from[i][q] * xj[q];
      cage[i] -= sum;
    }
  }
  solve(&f->lu[0][0], f->pivot, TRB_NC, cage);
  if (!arrow->with_cage) return;
  for (int j = 0; j < arrow->n; j++)
    for (int q = 0; q < TRB_NR; q++) {
      double sum = 0.0;
      for (int k = 0; k < TRB_NC; k++) sum += f->rollers[j].solved[q][k] * cage[k];
      x[j * TRB_NR + q] -= sum;
    }
}
