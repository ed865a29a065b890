#include "motion/record.h"

#include <stddef.h>

const char *trb_field_kind_name(trb_field_kind kind)
{
#define NAME(kind, name, n, first, second) name,
  static const char *const names[] = {TRB_FIELD_KINDS(NAME)};
  return names[kind];
}

int trb_field_shape(const trb_model *m, trb_field_kind kind, int shape[2])
{
#define SHAPE(kind, name, n, first, second) \
  case TRB_FIELD_##kind: shape[0] = first, shape[1] = second; return n;
  shape[0] = shape[1] = 1;
  switch (kind) {
    TRB_FIELD_KINDS(SHAPE)
  }
  return 0;
}

/* Whether a system has a field: that of a contact if it has the pair, and its kind the quantity. */
static int is_there(const trb_system *s, const trb_field_info *field)
{
  if (field->pair < 0) return 1;
  const trb_contact_form form = field->pair < s->n_pairs ? s->pairs[field->pair].kind->contact : TRB_CONTACT_NONE;
  return form == TRB_CONTACT_EDGE ? field->from == offsetof(trb_contact, load) : form != TRB_CONTACT_NONE;
}

int trb_field_size(const trb_system *s, int field)
{
  int shape[2];
  (void)trb_field_shape(s->model, trb_field_table[field].kind, shape);
  return is_there(s, &trb_field_table[field]) ? shape[0] * shape[1] : 0;
}

int trb_record_offset(const trb_system *s, int field)
{
  int offset = 0;
  for (int i = 0; i < field; i++) offset += trb_field_size(s, i);
  return offset;
}

static void put_contact(const trb_seen *seen, const trb_field_info *field, double *to)
{
  const trb_model   *m = seen->d->model;
  const trb_contact *contacts = trb_pair_contacts(m, &seen->d->system->pairs[field->pair], &seen->detail);
  for (int j = 0; j < m->n_rollers; j++) to[j] = *(const double *)((const char *)&contacts[j] + field->from);
}

void trb_record_fill(trb_dynamics *d, const unsigned *apart, double time, const double *y, trb_detail *detail, double *record)
{
  trb_seen           seen = {.d = d, .detail = *detail, .time = time, .y = trb_dynamics_held(d, time, y)};
  const trb_counters keep = d->work->counters;
  double            *at[TRB_N_FIELDS];
  seen.detail.lanes = seen.detail.pocket_interference = NULL;
  trb_dynamics_pose(d, time, y);
  trb_detail_clear(d->model, &seen.detail);
  trb_dynamics_loads(d, apart, &seen.detail);
  d->work->counters = keep; /* looking is not integrating */
  for (int i = 0; i < TRB_N_FIELDS; i++) {
    const int size = trb_field_size(d->system, i);
    at[i] = record;
    if (trb_field_table[i].pair >= 0 && size > 0) put_contact(&seen, &trb_field_table[i], record);
    record += size;
  }
  for (int i = 0, first = 0; i < trb_n_shown; first += trb_shown_table[i++].n) {
    seen.of = trb_shown_table[i].of;
    if (trb_shown_table[i].fill != NULL) trb_shown_table[i].fill(&seen, at + first);
  }
}
