#include "contact/pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/variant.h"
#include "contact/kernels.h"

const trb_kernel_variant trb_kernel_variants[] = {
#define VARIANT(name) {#name, trb_raceway_kernel_##name, trb_rib_kernel_##name, &trb_modal_kernels_##name},
    TRB_VARIANTS(VARIANT)};
const int trb_n_kernel_variants = (int)(sizeof trb_kernel_variants / sizeof trb_kernel_variants[0]);

int trb_kernel_runs(int variant)
{
  if (variant < 0 || variant >= trb_n_kernel_variants) return 0;
#if defined(TRB_HAVE_AVX2) || defined(TRB_HAVE_AVX512)
  const char *name = trb_kernel_variants[variant].name;
  if (strcmp(name, "avx2") == 0) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (strcmp(name, "avx512") == 0)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("fma");
#endif
  return 1;
}

static trb_status choose_variant(const char *name, int *variant, trb_message *message)
{
  *variant = -1;
  for (int i = 0; i < trb_n_kernel_variants; i++)
    if (trb_kernel_runs(i) && (name[0] == '\0' || strcmp(name, trb_kernel_variants[i].name) == 0)) *variant = i;
  if (*variant < 0) return trb_fail(message, TRB_ERR_INPUT, "instruction_set = '%s': not one that this machine and build run", name);
  return TRB_OK;
}

/* Neighbouring pairs of the same kind make a batch. */
static void choose(const trb_pair *pairs, int n_pairs, trb_workspace *work)
{
  for (int i = 0; i < n_pairs; i++) {
    const int hub = pairs[i].kind->between != NULL;
    if (!pairs[i].on) continue;
    int       *n = hub ? &work->n_hub : &work->n_batches;
    trb_batch *batches = hub ? work->hub : work->batches, *last = *n > 0 ? &batches[*n - 1] : NULL;
    if (hub || last == NULL || last->pairs[0]->kind != pairs[i].kind || last->n == TRB_MOST_TOGETHER) last = &batches[(*n)++];
    last->index[last->n] = i;
    last->pairs[last->n++] = &pairs[i];
  }
}

trb_status trb_workspace_create(const trb_pair *pairs, int n_pairs, const char *variant, trb_workspace **work, trb_message *message)
{
  int chosen;
  *work = NULL;
  const trb_status status = choose_variant(variant, &chosen, message);
  if (status != TRB_OK) return status;
  trb_workspace *w = calloc(1, sizeof *w);
  if (w == NULL || (w->lanes = trb_zeros(1, sizeof *w->lanes)) == NULL) {
    trb_workspace_free(w);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a workspace");
  }
  w->variant = chosen;
  choose(pairs, n_pairs, w);
  *work = w;
  return TRB_OK;
}

void trb_workspace_free(trb_workspace *work)
{
  if (work == NULL) return;
  free(work->lanes);
  free(work);
}

static size_t lane_total(const trb_model *m) { return (size_t)TRB_N_LANE_FIELDS * TRB_N_RACES * (size_t)m->n_rollers * (size_t)m->n_lanes; }

trb_status trb_detail_create(const trb_model *m, const trb_pair *pairs, int n_pairs, trb_detail **detail, trb_message *message)
{
  const size_t rollers = (size_t)m->n_rollers;
  trb_detail  *d = calloc(1, sizeof *d);
  *detail = NULL;
  if (d == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for contact details");
  for (int i = 0; i < n_pairs; i++) d->n_contacts += pairs[i].kind->contact != TRB_CONTACT_NONE;
  for (int i = 0; i < n_pairs; i++) d->n_slots += pairs[i].kind->shape[1] == TRB_SHAPE_POCKETS ? m->n_rollers * m->n_slots : 0;
  const size_t slots = (size_t)d->n_slots;
  d->lanes = trb_memory_zeros(&d->memory, lane_total(m), sizeof(double));
  d->contacts = trb_memory_zeros(&d->memory, (size_t)d->n_contacts * rollers, sizeof *d->contacts);
  d->pocket_force = trb_memory_zeros(&d->memory, slots, sizeof(double));
  d->pocket_friction = trb_memory_zeros(&d->memory, slots, sizeof(double));
  d->pocket_interference = trb_memory_zeros(&d->memory, slots, sizeof(double));
  if (d->memory.lacks) {
    trb_detail_free(d);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for contact details");
  }
  *detail = d;
  return TRB_OK;
}

void trb_detail_free(trb_detail *detail)
{
  if (detail == NULL) return;
  trb_memory_free(&detail->memory);
  free(detail);
}

void trb_detail_clear(const trb_model *m, trb_detail *detail)
{
  const size_t rollers = (size_t)m->n_rollers, slots = (size_t)detail->n_slots;
  if (detail->lanes != NULL) memset(detail->lanes, 0, lane_total(m) * sizeof(double));
  memset(detail->contacts, 0, (size_t)detail->n_contacts * rollers * sizeof *detail->contacts);
  memset(detail->pocket_force, 0, slots * sizeof(double));
  memset(detail->pocket_friction, 0, slots * sizeof(double));
  for (size_t i = 0; i < slots && detail->pocket_interference != NULL; i++) detail->pocket_interference[i] = -INFINITY;
  memset(&detail->land, 0, sizeof detail->land);
}
