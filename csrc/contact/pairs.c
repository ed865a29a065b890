/* The sums over pairs. */
#include <string.h>

#include "contact/pair.h"

static void clear(const trb_instant *at, trb_loads *loads)
{
  for (int k = 0; k < at->n; k++) {
    memset(&loads[at->chosen[k]], 0, sizeof *loads);
    for (int i = 0; i < TRB_MOST_PAIRS; i++) loads[at->chosen[k]].margin[i] = TRB_NO_CONTACT;
  }
}

void trb_contact_all(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_loads *loads, trb_detail *detail)
{
  clear(at, loads);
  work->counters.force_evaluations++;
  for (int i = 0; i < work->n_batches; i++) work->batches[i].pairs[0]->kind->evaluate(m, at, &work->batches[i], work, loads, detail);
}

void trb_contact_slow(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_loads *loads, trb_detail *detail)
{
  clear(at, loads);
  for (int i = 0; i < work->n_batches; i++) {
    const trb_pair_kind *kind = work->batches[i].pairs[0]->kind;
    if (kind->pace == TRB_PACE_SLOW) kind->evaluate(m, at, &work->batches[i], work, loads, detail);
  }
}

void trb_contact_slow_of(const trb_model *m, const trb_instant *at, int body, trb_workspace *work, trb_loads *loads)
{
  clear(at, loads);
  for (int i = 0; i < work->n_batches; i++) {
    const trb_batch *all = &work->batches[i];
    trb_batch        some = {.n = 0};
    if (all->pairs[0]->kind->pace != TRB_PACE_SLOW) continue;
    for (int k = 0; k < all->n; k++)
      if (all->pairs[k]->b == body) some.pairs[some.n] = all->pairs[k], some.index[some.n++] = all->index[k];
    if (some.n > 0) some.pairs[0]->kind->evaluate(m, at, &some, work, loads, NULL);
  }
}

void trb_contact_hub(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_loads *loads, trb_detail *detail)
{
  memset(loads, 0, sizeof *loads);
  for (int i = 0; i < work->n_hub; i++) {
    const trb_pair *pair = work->hub[i].pairs[0];
    trb_load        load;
    memset(&load, 0, sizeof load);
    pair->kind->between(m, pair, at, &work->counters, &load, detail);
    trb_add_load(pair, &load, loads);
  }
}
