#include "stepping/arrow.h"

#include <stdlib.h>

#include "base/memory.h"

trb_status trb_arrow_create(int n_rollers, int with_cage, trb_arrow **arrow, trb_message *message)
{
  trb_arrow *a = calloc(1, sizeof *a);
  *arrow = NULL;
  if (a != NULL) {
    a->rollers = trb_zeros((size_t)n_rollers, sizeof *a->rollers);
    a->borders = trb_zeros((size_t)n_rollers, sizeof *a->borders);
  }
  if (a == NULL || a->rollers == NULL || a->borders == NULL) {
    trb_arrow_free(a);
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
  free(arrow->borders);
  free(arrow);
}

trb_status trb_arrow_factors_create(int n_rollers, int variant, trb_arrow_factors **factors, trb_message *message)
{
  trb_arrow_factors *f = calloc(1, sizeof *f);
  *factors = NULL;
  if (f != NULL) {
    f->rollers = trb_zeros((size_t)n_rollers, sizeof *f->rollers);
    f->borders = trb_zeros((size_t)n_rollers, sizeof *f->borders);
  }
  if (f == NULL || f->rollers == NULL || f->borders == NULL) {
    trb_arrow_factors_free(f);
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
  free(factors->borders);
  free(factors);
}

int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *f)
{
  double schur[TRB_NC][TRB_NC]; /* column by column */
  f->gamma = 0.0;
  for (int c = 0; c < TRB_NC; c++)
    for (int i = 0; i < TRB_NC; i++) schur[c][i] = (double)(i == c) - arrow->gamma * arrow->cage[c][i];
  for (int j = 0; j < arrow->n; j++)
    if (!f->kernels->factor(&arrow->rollers[j], arrow->gamma, &f->rollers[j])) return 0;
  for (int j = 0; j < arrow->n; j++) {
    f->borders[j].coupled = arrow->borders[j].coupled;
    if (arrow->borders[j].coupled) f->kernels->border(&arrow->borders[j], arrow->gamma, &f->rollers[j], &f->borders[j], schur);
  }
  if (!f->kernels->invert_cage((const double (*)[TRB_NC])schur, f->cage)) return 0;
  f->gamma = arrow->gamma;
  return 1;
}

void trb_arrow_solve(const trb_arrow_factors *f, double *x)
{
  f->kernels->solve(f->rollers, f->borders, f->n, (const double (*)[TRB_NC])f->cage, x);
}
