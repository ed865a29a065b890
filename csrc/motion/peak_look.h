/* What peaks are made of: all loads, pressures, film parameters, skews and spacings at a state. Friction is left out, as none of them
 * needs it. A contact with a ring keeps its values while its load or its film's entrainment speed cannot have changed by TRB_PEAK_SHARE since it was evaluated
 * last (motion/bound.h); where its kind has slopes (trb_pair_follow), they follow the motion beyond that. Otherwise it is evaluated again, and so are bounds while
 * the drive moves a ring or changes its speed. Pockets are evaluated always, unless they are proven clear. */
#ifndef TRB_MOTION_PEAK_LOOK_H
#define TRB_MOTION_PEAK_LOOK_H

#include "motion/dynamics.h"
#include "motion/peak_fields.h"
#include "motion/peak_track.h"
#include "motion/record.h"

/* Share by which a held load or entrainment speed may be off. */
#define TRB_PEAK_SHARE 2e-3

enum {
#define TRB_PEAK_QUANTITY_ENUM(name, field, sense) TRB_PEAK_##name,
  TRB_PEAK_QUANTITIES(TRB_PEAK_QUANTITY_ENUM)
#undef TRB_PEAK_QUANTITY_ENUM
      TRB_N_PEAK_QUANTITIES
};

typedef struct trb_peak_quantity {
  int            field; /* of records, that has as many values */
  trb_peak_sense sense;
} trb_peak_quantity;

extern const trb_peak_quantity trb_peak_quantities[TRB_N_PEAK_QUANTITIES];

typedef struct trb_peak_look trb_peak_look;

trb_status trb_peak_look_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_peak_look **look,
                                trb_message *message);
void       trb_peak_look_free(trb_peak_look *look);

/* How many values of each sort there are, and where those of a quantity begin; TRB_N_PEAK_QUANTITIES gives the end. */
trb_peak_sizes trb_peak_look_sizes(const trb_system *s);
int            trb_peak_look_offset(const trb_system *s, int quantity);

/* Evaluate everything at the next look. */
void trb_peak_look_forget(trb_peak_look *look);
/* Before the first look: films of contacts that the scene has not carry no load. */
void trb_peak_look_start(const trb_peak_look *look, double *values);
/* All values at a state. Held ones stay as they are in `values`, which come from the look before. */
void trb_peak_look_at(trb_peak_look *look, double time, const double *y, double *values);

#endif
