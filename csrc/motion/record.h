/* A record: every quantity of motion/fields.h at one instant, in inertial coordinates, as one row of doubles. */
#ifndef TRB_MOTION_RECORD_H
#define TRB_MOTION_RECORD_H

#include "motion/rhs.h"
#include "motion/fields.h"

typedef struct trb_field_info {
  const char    *name;
  const char    *group;
  const char    *unit;
  const char    *text;
  size_t         from; /* place in trb_contact of what a contact has */
  trb_field_kind kind;
  int            pair; /* whose contact it is; -1: of none */
} trb_field_info;

enum {
#define TRB_FIELD_ENUM(name, group, kind, unit, text) TRB_FIELD_AT_##name,
  TRB_FIELDS(TRB_FIELD_ENUM)
#undef TRB_FIELD_ENUM
      TRB_N_FIELDS
};

extern const trb_field_info trb_field_table[TRB_N_FIELDS];

/* What a record is made from. */
typedef struct trb_seen {
  trb_dynamics *d;      /* posed, with all loads */
  trb_detail    detail; /* neither the nodes of raceways nor the gaps of pockets */
  double        time;
  const double *y;
  int           of; /* number of the body whose quantities are asked for */
} trb_seen;

/* What fills the quantities of a kind, in the order of its list. */
typedef void trb_show(const trb_seen *seen, double *const *to);

/* The rows of TRB_SHOWN. */
typedef struct trb_shown {
  trb_show *fill; /* NULL: of contacts, which the table of fields describes */
  int       of;
  int       n; /* fields */
} trb_shown;

extern const trb_shown trb_shown_table[];
extern const int       trb_n_shown;

/* Name of a kind, in small letters. */
const char *trb_field_kind_name(trb_field_kind kind);
/* Shape of a kind: fills up to two extents, gives their number. */
int trb_field_shape(const trb_model *m, trb_field_kind kind, int shape[2]);
/* How many numbers of a record are a field's; 0: the system does not have it. */
int trb_field_size(const trb_system *s, int field);
/* Offset of a field in a record; TRB_N_FIELDS gives the record's length. */
int trb_record_offset(const trb_system *s, int field);
/* Energies that are functions of the state (docs/theory/energy.md#stored-energy): the kinetic one at the poses kept, and the elastic one of all
 * contacts at the loads kept and within bodies, J. Works and losses are quadratures (bearing/losses.h). */
double trb_audit_kinetic(const trb_dynamics *d);
double trb_audit_elastic(const trb_dynamics *d);
/* Fill a record at (time, y). detail: buffers of the caller. apart: what is known not to touch there (trb_fast_apart), saves time; may
 * be NULL. */
void trb_record_fill(trb_dynamics *d, const unsigned *apart, double time, const double *y, trb_detail *detail, double *record);

#endif
