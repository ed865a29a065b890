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
  arrow->gamma = -c;
  for (int j = 0; j < arrow->n; j++) {
    trb_arrow_block *b = &arrow->rollers[j];
    for (int i = 0; i < TRB_NR * TRB_NP; i++) (&b->own[0][0])[i] *= c;
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

trb_status trb_arrow_factors_create(int n_rollers, int variant, trb_arrow_factors **factors, trb_message *message)
{
  trb_arrow_factors *f = calloc(1, sizeof *f);
  *factors = NULL;
  if (f != NULL) f->rollers = calloc((size_t)n_rollers, sizeof *f->rollers);
  if (f == NULL || f->rollers == NULL) {
    free(f);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the factors of %d rollers", n_rollers);
  }
  f->n = n_rollers;
  f->kernels = trb_block_kernels_of(variant);
  *factors = f;
  return TRB_OK;
}

void trb_arrow_factors_free(trb_arrow_factors *factors)
{
  if (factors == NULL) return;
  free(factors->rollers);
  free(factors);
}

/* LU with row pivoting in place. Multipliers are exchanged with their rows, so that they stand in final order. */
static int factor_cage(double (*a)[TRB_NC], int *pivot)
{
  for (int c = 0; c < TRB_NC; c++) {
    int best = c;
    for (int i = c + 1; i < TRB_NC; i++)
      if (fabs(a[i][c]) > fabs(a[best][c])) best = i;
    pivot[c] = best;
    if (!(fabs(a[best][c]) > 0.0) || !isfinite(a[best][c])) return 0;
    for (int k = 0; best != c && k < TRB_NC; k++) {
      const double keep = a[c][k];
      a[c][k] = a[best][k];
      a[best][k] = keep;
    }
    /* the reciprocal serves every solve */
    const double per = a[c][c] = 1.0 / a[c][c];
    for (int i = c + 1; i < TRB_NC; i++) {
      const double m = a[i][c] *= per;
      for (int k = c + 1; k < TRB_NC; k++) a[i][k] -= m * a[c][k];
    }
  }
  return 1;
}

static void solve_cage(const trb_arrow_factors *f, double *x)
{
  for (int c = 0; c < TRB_NC; c++) {
    const double keep = x[f->pivot[c]];
    x[f->pivot[c]] = x[c];
    x[c] = keep;
  }
  for (int i = 1; i < TRB_NC; i++)
    for (int c = 0; c < i; c++) x[i] -= f->lu[i][c] * x[c];
  for (int i = TRB_NC - 1; i >= 0; i--) {
    for (int c = i + 1; c < TRB_NC; c++) x[i] -= f->lu[i][c] * x[c];
    x[i] *= f->lu[i][i];
  }
}

int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *f)
{
  double schur[TRB_NC][TRB_NC]; /* column by column */
  f->gamma = 0.0;
  for (int i = 0; i < TRB_NC; i++)
    for (int k = 0; k < TRB_NC; k++) schur[k][i] = arrow->cage[i][k];
  for (int j = 0; j < arrow->n; j++)
    if (!f->kernels->factor(&arrow->rollers[j], &f->rollers[j], schur)) return 0;
  for (int i = 0; i < TRB_NC; i++)
    for (int k = 0; k < TRB_NC; k++) f->lu[i][k] = schur[k][i];
  if (!factor_cage(f->lu, f->pivot)) return 0;
  f->gamma = arrow->gamma;
  return 1;
}

void trb_arrow_solve(const trb_arrow_factors *f, double *x)
{
  double *cage = x + f->n * TRB_NR;
  f->kernels->eliminate(f->rollers, f->n, x, cage);
  solve_cage(f, cage);
  f->kernels->substitute(f->rollers, f->n, x, cage);
}
