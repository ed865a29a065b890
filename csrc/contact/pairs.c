/* The table of pairs, and the sums over its rows. */
#include <string.h>

#include "contact/pair.h"

const trb_pair *const trb_pair_table[TRB_N_PAIRS] = {
#define ROW(name) &trb_pair_##name,
    TRB_PAIRS(ROW)
#undef ROW
};

int trb_pair_always(const trb_model *m) { return m != NULL; }

int trb_pair_is_on(const trb_model *m, int row) { return !(m->pairs_left_out >> row & 1U) && trb_pair_table[row]->is_on(m); }

/* Neighbouring rows of the same function make a batch. */
void trb_pairs_choose(const trb_model *m, trb_workspace *work)
{
  work->n_batches = work->n_hub = 0;
  for (int row = 0; row < TRB_N_PAIRS; row++) {
    const trb_pair *pair = trb_pair_table[row];
    if (!trb_pair_is_on(m, row)) continue;
    if (pair->between != NULL) {
      work->hub[work->n_hub++] = row;
      continue;
    }
    trb_batch *last = work->n_batches > 0 ? &work->batches[work->n_batches - 1] : NULL;
    if (last == NULL || last->pairs[0]->evaluate != pair->evaluate || last->n == TRB_MOST_TOGETHER) {
      last = &work->batches[work->n_batches++];
      last->n = 0;
    }
    last->index[last->n] = row;
    last->pairs[last->n++] = pair;
  }
}

int trb_pairs_seat(const trb_model *m)
{
  int seats = 0;
  for (int row = 0; row < TRB_N_PAIRS; row++) seats |= trb_pair_table[row]->seats && trb_pair_is_on(m, row);
  return seats;
}

static void clear(const trb_instant *at, trb_loads *loads)
{
  for (int k = 0; k < at->n; k++) {
    memset(&loads[at->chosen[k]], 0, sizeof *loads);
    for (int i = 0; i < TRB_N_PAIRS; i++) loads[at->chosen[k]].margin[i] = TRB_NO_CONTACT;
  }
}

void trb_contact_all(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_loads *loads, trb_detail *detail)
{
  clear(at, loads);
  work->counters.force_evaluations++;
  for (int i = 0; i < work->n_batches; i++) {
    const trb_pair *pair = work->batches[i].pairs[0];
    if (at->cage != NULL || !trb_pair_joins(pair, TRB_BODY_CAGE)) pair->evaluate(m, at, &work->batches[i], work, loads, detail);
  }
}

void trb_contact_slow(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_loads *loads)
{
  clear(at, loads);
  for (int i = 0; i < work->n_batches; i++) {
    const trb_pair *pair = work->batches[i].pairs[0];
    if (pair->pace == TRB_PACE_SLOW) pair->evaluate(m, at, &work->batches[i], work, loads, NULL);
  }
}

void trb_contact_hub(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_loads *loads, trb_detail *detail)
{
  memset(loads, 0, sizeof *loads);
  for (int i = 0; i < work->n_hub; i++) {
    const trb_pair *pair = trb_pair_table[work->hub[i]];
    trb_load        load;
    if (at->cage == NULL && trb_pair_joins(pair, TRB_BODY_CAGE)) continue;
    memset(&load, 0, sizeof load);
    pair->between(m, at, &work->counters, &load, detail);
    trb_add_load(pair, &load, loads);
  }
}
