#include "stepping/followers.h"

#include <stdlib.h>
#include <string.h>

/* Numbers of followers and of entries that are kept. */
static void sort(trb_followers *f, const int (*entries)[2])
{
  int *const place = f->place;
  for (int k = 0; k < f->n; k++) place[entries[k][0]] = -1;
  for (int i = 0, at = 0; i < f->width; i++)
    if (place[i] == 0) place[i] = at, f->kept_entry[at++] = i;
  for (int k = 0; k < f->n; k++) f->entry[k] = entries[k][0], f->leader[k] = place[entries[k][1]];
}

trb_status trb_followers_create(int n_rollers, int hub_width, int n, const int (*entries)[2], trb_followers **followers,
                                trb_message *message)
{
  const int      kept = hub_width - n, room = trb_hub_room(kept);
  trb_followers *f = calloc(1, sizeof *f);
  *followers = NULL;
  if (f != NULL) {
    f->entry = trb_memory_zeros(&f->memory, (size_t)n, sizeof *f->entry);
    f->leader = trb_memory_zeros(&f->memory, (size_t)n, sizeof *f->leader);
    f->kept_entry = trb_memory_zeros(&f->memory, (size_t)kept, sizeof *f->kept_entry);
    f->place = trb_memory_zeros(&f->memory, (size_t)hub_width, sizeof *f->place);
    f->rate = trb_memory_zeros(&f->memory, (size_t)n, sizeof *f->rate);
    f->own = trb_memory_zeros(&f->memory, (size_t)n, sizeof *f->own);
    f->hub = trb_memory_zeros(&f->memory, (size_t)n * (size_t)room, sizeof *f->hub);
    f->rollers = trb_memory_zeros(&f->memory, (size_t)n_rollers * (size_t)n * TRB_NP, sizeof *f->rollers);
    f->folded.to_hub = trb_memory_zeros(&f->memory, (size_t)kept * TRB_NR, sizeof *f->folded.to_hub);
    f->folded.from = trb_memory_zeros(&f->memory, (size_t)room * TRB_NR, sizeof *f->folded.from);
  }
  if (f == NULL || f->memory.lacks) {
    trb_followers_free(f);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the factors of %d rollers", n_rollers);
  }
  f->n = n, f->kept = kept, f->width = hub_width, f->room = room;
  sort(f, entries);
  *followers = f;
  return TRB_OK;
}

void trb_followers_free(trb_followers *followers)
{
  if (followers == NULL) return;
  trb_memory_free(&followers->memory);
  free(followers);
}

void trb_followers_hub(trb_followers *f, const trb_arrow *arrow, double gamma, const trb_hub_factor *hub)
{
  for (int c = 0; c < f->kept; c++) {
    const double *from = arrow->hub + f->kept_entry[c] * arrow->room;
    double       *to = hub->schur + c * hub->room;
    for (int i = 0; i < f->kept; i++) to[i] = (double)(i == c) - gamma * from[f->kept_entry[i]];
    for (int i = f->kept; i < hub->room; i++) to[i] = 0.0;
  }
  for (int k = 0; k < f->n; k++) {
    const double *from = arrow->hub + f->entry[k] * arrow->room;
    double       *own = f->hub + k * f->room, *to = hub->schur + f->leader[k] * hub->room;
    f->rate[k] = gamma * arrow->hub[f->kept_entry[f->leader[k]] * arrow->room + f->entry[k]];
    for (int i = 0; i < f->kept; i++) own[i] = gamma * from[f->kept_entry[i]];
    for (int i = 0; i < f->kept; i++) to[i] -= f->rate[k] * own[i];
  }
}

static int has(const trb_arrow_border *border, int entry) { return (int)(border->parts >> entry / TRB_NP & 1U); }

const trb_arrow_border *trb_followers_border(trb_followers *f, const trb_arrow *arrow, double gamma, int roller)
{
  const trb_arrow_border *whole = &arrow->borders[roller];
  trb_arrow_border       *to = &f->folded;
  double                 *own = f->rollers + (size_t)roller * (size_t)f->n * TRB_NP;
  to->parts = 0U;
  memset(to->from, 0, (size_t)f->room * TRB_NR * sizeof *to->from);
  for (int i = 0; i < f->kept; i++) {
    const int entry = f->kept_entry[i], there = has(whole, entry);
    double   *column = to->to_hub + i * TRB_NR;
    if (there) memcpy(column, whole->to_hub + entry * TRB_NR, TRB_NR * sizeof *column);
    else memset(column, 0, TRB_NR * sizeof *column);
    for (int c = 0; there && c < TRB_NR; c++) to->from[c * f->room + i] = whole->from[c * arrow->room + entry];
    to->parts |= (unsigned)there << i / TRB_NP;
  }
  for (int k = 0; k < f->n; k++, own += TRB_NP) {
    const double *from = whole->to_hub + f->entry[k] * TRB_NR;
    double       *column = to->to_hub + f->leader[k] * TRB_NR;
    const int     there = has(whole, f->entry[k]);
    for (int c = 0; c < TRB_NR; c++) own[c] = there ? gamma * from[c] : 0.0;
    for (int c = 0; there && c < TRB_NR; c++) column[c] += f->rate[k] * from[c];
    to->parts |= (unsigned)there << f->leader[k] / TRB_NP;
  }
  return to;
}

/* Adds the followers' columns times their right-hand sides to n entries, at most TRB_NP of them. */
static void add_columns(const trb_followers *f, const trb_block_kernels *kernels, const double *columns, int stride, int n, double *to)
{
  double sum[TRB_NP] = {0};
  kernels->add(columns, stride, f->n, f->own, sum);
  for (int i = 0; i < TRB_NP && i < n; i++) to[i] += sum[i];
}

void trb_followers_before(trb_followers *f, const trb_block_kernels *kernels, const trb_arrow_factor_border *borders, int n_rollers,
                          double *x)
{
  double *const hub = x + n_rollers * TRB_NR;
  for (int k = 0; k < f->n; k++) f->own[k] = hub[f->entry[k]];
  for (int i = 0; i < f->kept; i++) hub[i] = hub[f->kept_entry[i]];
  for (int part = 0; part < f->room; part += TRB_NP) add_columns(f, kernels, f->hub + part, f->room, f->kept - part, hub + part);
  for (int j = 0; j < n_rollers; j++)
    if (borders[j].parts != 0U) add_columns(f, kernels, f->rollers + (size_t)j * (size_t)f->n * TRB_NP, TRB_NP, TRB_NR, x + j * TRB_NR);
}

void trb_followers_after(const trb_followers *f, int n_rollers, double *x)
{
  double *const hub = x + n_rollers * TRB_NR;
  for (int i = f->kept - 1; i >= 0; i--) hub[f->kept_entry[i]] = hub[i];
  for (int k = 0; k < f->n; k++) hub[f->entry[k]] = f->own[k] + f->rate[k] * hub[f->kept_entry[f->leader[k]]];
}
