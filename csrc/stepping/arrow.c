#include "stepping/arrow.h"

#include <stdlib.h>
#include <string.h>

#include "stepping/constants.h"

/* Entries of an array of the borders, so that the next one starts with a cache line. */
static size_t padded(int rows, int columns)
{
  return ((size_t)rows * (size_t)columns + TRB_CACHE_LINE - 1) / TRB_CACHE_LINE * TRB_CACHE_LINE;
}

trb_status trb_arrow_create(int n_rollers, int hub_width, trb_arrow **arrow, trb_message *message)
{
  const int    room = trb_hub_room(hub_width);
  const size_t n = (size_t)n_rollers, to_hub = padded(TRB_NR, hub_width), from = padded(TRB_NR, room);
  trb_arrow   *a = calloc(1, sizeof *a);
  double      *border = NULL;
  *arrow = NULL;
  if (a != NULL) {
    a->rollers = trb_memory_zeros(&a->memory, n, sizeof *a->rollers);
    a->borders = trb_memory_zeros(&a->memory, n, sizeof *a->borders);
    a->hub = trb_memory_zeros(&a->memory, (size_t)hub_width * (size_t)room, sizeof *a->hub);
    border = trb_memory_zeros(&a->memory, n * (to_hub + from), sizeof *border);
  }
  if (a == NULL || a->memory.lacks) {
    trb_arrow_free(a);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian of %d rollers", n_rollers);
  }
  for (size_t j = 0; j < n; j++) {
    a->borders[j].to_hub = border + j * (to_hub + from);
    a->borders[j].from = a->borders[j].to_hub + to_hub;
  }
  a->n = n_rollers;
  a->width = hub_width;
  a->room = room;
  *arrow = a;
  return TRB_OK;
}

void trb_arrow_free(trb_arrow *arrow)
{
  if (arrow == NULL) return;
  trb_memory_free(&arrow->memory);
  free(arrow);
}

void trb_arrow_add_parts(trb_arrow *arrow, int roller, unsigned parts)
{
  trb_arrow_border *border = &arrow->borders[roller];
  for (int part = 0; part * TRB_NP < arrow->width; part++) {
    const int from = part * TRB_NP, n = arrow->width - from < TRB_NP ? arrow->width - from : TRB_NP;
    if (!(parts & ~border->parts & 1U << part)) continue;
    memset(border->to_hub + from * TRB_NR, 0, (size_t)(n * TRB_NR) * sizeof(double));
    for (int c = 0; c < TRB_NR; c++) memset(border->from + c * arrow->room + from, 0, TRB_NP * sizeof(double));
  }
  border->parts |= parts;
}

trb_status trb_arrow_factors_create(int n_rollers, int hub_width, int variant, trb_arrow_factors **factors, trb_message *message)
{
  const int          room = trb_hub_room(hub_width);
  const size_t       n = (size_t)n_rollers, width = (size_t)hub_width, solved = padded(hub_width, TRB_NP), from = padded(TRB_NR, room);
  trb_arrow_factors *f = calloc(1, sizeof *f);
  double            *border = NULL;
  *factors = NULL;
  if (f != NULL) {
    f->rollers = trb_memory_zeros(&f->memory, n, sizeof *f->rollers);
    f->held = trb_memory_zeros(&f->memory, n, sizeof *f->held);
    f->borders = trb_memory_zeros(&f->memory, n, sizeof *f->borders);
    f->hub.schur = trb_memory_zeros(&f->memory, width * (size_t)room, sizeof *f->hub.schur);
    f->hub.inverse = trb_memory_zeros(&f->memory, width * (size_t)room, sizeof *f->hub.inverse);
    f->hub.scratch = trb_memory_zeros(&f->memory, 2 * (size_t)room + n * TRB_NP, sizeof *f->hub.scratch);
    f->hub.pivot = trb_memory_zeros(&f->memory, width, sizeof *f->hub.pivot);
    border = trb_memory_zeros(&f->memory, n * (solved + from), sizeof *border);
  }
  if (f == NULL || f->memory.lacks) {
    trb_arrow_factors_free(f);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the factors of %d rollers", n_rollers);
  }
  for (size_t j = 0; j < n; j++) {
    f->borders[j].solved = border + j * (solved + from);
    f->borders[j].from = f->borders[j].solved + solved;
  }
  f->n = n_rollers;
  f->hub.width = hub_width;
  f->hub.room = room;
  f->kernels = trb_block_kernels_of(variant);
  *factors = f;
  return TRB_OK;
}

trb_status trb_arrow_factors_follow(trb_arrow_factors *f, int n, const int (*entries)[2], trb_message *message)
{
  const trb_status status = trb_followers_create(f->n, f->hub.width, n, entries, &f->followers, message);
  if (status != TRB_OK) return status;
  f->hub.width = f->followers->kept;
  f->hub.room = f->followers->room;
  return TRB_OK;
}

void trb_arrow_factors_free(trb_arrow_factors *factors)
{
  if (factors == NULL) return;
  trb_followers_free(factors->followers);
  trb_memory_free(&factors->memory);
  free(factors);
}

int trb_arrow_factor_alone(const trb_arrow *arrow, double gamma, int roller, trb_arrow_factors *f)
{
  f->held[roller] = f->kernels->factor(&arrow->rollers[roller], gamma, &f->rollers[roller]) ? gamma : 0.0;
  return f->held[roller] > 0.0;
}

int trb_arrow_factor_again(const trb_arrow *arrow, double gamma, const int *chosen, int n, trb_arrow_factors *f)
{
  const trb_hub_factor *hub = &f->hub;
  f->gamma = 0.0;
  if (f->followers != NULL) trb_followers_hub(f->followers, arrow, gamma, hub);
  else
    for (int c = 0; c < hub->width; c++)
      for (int i = 0; i < hub->room; i++) hub->schur[c * hub->room + i] = (double)(i == c) - gamma * arrow->hub[c * hub->room + i];
  for (int k = 0; k < n; k++) {
    const int j = chosen == NULL ? k : chosen[k];
    if (f->held[j] != gamma && !trb_arrow_factor_alone(arrow, gamma, j, f)) return 0;
  }
  for (int k = 0; k < n; k++) {
    const int               j = chosen == NULL ? k : chosen[k];
    const trb_arrow_border *border = &arrow->borders[j];
    f->borders[j].parts = border->parts;
    if (border->parts == 0U) continue;
    if (f->followers != NULL) border = trb_followers_border(f->followers, arrow, gamma, j);
    f->kernels->border(border, gamma, &f->rollers[j], &f->borders[j], hub);
  }
  if (!f->kernels->invert_hub(hub)) return 0;
  f->gamma = gamma;
  return 1;
}

int trb_arrow_factor(const trb_arrow *arrow, double gamma, const int *chosen, int n, trb_arrow_factors *f)
{
  for (int k = 0; k < n; k++) f->held[chosen == NULL ? k : chosen[k]] = 0.0;
  return trb_arrow_factor_again(arrow, gamma, chosen, n, f);
}

void trb_arrow_solve(const trb_arrow_factors *f, double *x)
{
  if (f->followers != NULL) trb_followers_before(f->followers, f->kernels, f->borders, f->n, x);
  f->kernels->solve(f->rollers, f->borders, NULL, f->n, &f->hub, x);
  if (f->followers != NULL) trb_followers_after(f->followers, f->n, x);
}
