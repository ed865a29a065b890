/* A record: every quantity of motion/fields.h at one instant, in inertial coordinates, as one row of doubles. */
#ifndef TRB_MOTION_RECORD_H
#define TRB_MOTION_RECORD_H

#include "motion/dynamics.h"
#include "motion/fields.h"

typedef struct trb_field_info {
  const char    *name;
  const char    *group;
  trb_field_kind kind;
  const char    *unit;
  const char    *text;
} trb_field_info;

enum {
#define TRB_FIELD_ENUM(name, group, kind, unit, text) TRB_FIELD_AT_##name,
  TRB_FIELDS(TRB_FIELD_ENUM)
#undef TRB_FIELD_ENUM
      TRB_N_FIELDS
};

extern const trb_field_info trb_field_table[TRB_N_FIELDS];

/* Name of a kind, in small letters. */
const char *trb_field_kind_name(trb_field_kind kind);
/* Shape of a kind: fills up to two extents, gives their number. */
int trb_field_shape(const trb_model *m, trb_field_kind kind, int shape[2]);
/* Offset of a field in a record; TRB_N_FIELDS gives the record's length. */
int trb_record_offset(const trb_model *m, int field);
/* Fill a record at (time, y). detail: buffers of the caller. apart: what is known not to touch there (trb_fast_apart), saves time; may
 * be NULL. */
void trb_record_fill(trb_dynamics *d, const unsigned *apart, double time, const double *y, trb_detail *detail, double *record);

#endif
