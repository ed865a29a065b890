/* Peaks: what happens between records. At the end of every step all loads, pressures, film parameters, skews and spacings are looked
 * at, and their extremes, means and impacts are kept over each record's interval and over the whole run; motion/peak_fields.h lists them.
 *
 * Between the ends of two steps every quantity is taken as a straight line. So the peaks of a run do not depend on its records, and the
 * largest peak of its records is that of the run. motion/peak_look.h says how exact the values are. */
#ifndef TRB_MOTION_PEAKS_H
#define TRB_MOTION_PEAKS_H

#include "motion/peak_fields.h"
#include "motion/record.h"

typedef struct trb_peak_field_info {
  const char   *name;
  const char   *unit;
  const char   *text;
  int           quantity;
  trb_peak_take take;
} trb_peak_field_info;

enum {
#define TRB_PEAK_FIELD_ENUM(name, quantity, take, unit, text) TRB_PEAK_AT_##name,
  TRB_PEAK_FIELDS(TRB_PEAK_FIELD_ENUM)
#undef TRB_PEAK_FIELD_ENUM
      TRB_N_PEAK_FIELDS
};

extern const trb_peak_field_info trb_peak_field_table[TRB_N_PEAK_FIELDS];

trb_field_kind trb_peak_kind(const trb_peak_field_info *field);
/* How a field is joined with that of the next interval, in a word: largest, smallest, time, mean, sum. */
const char *trb_peak_joined(const trb_peak_field_info *field);
/* Offset of a field in a row of peaks; TRB_N_PEAK_FIELDS gives the row's length. */
int trb_peak_offset(const trb_system *s, int field);

typedef struct trb_peaks trb_peaks;

trb_status trb_peaks_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_peaks **peaks,
                            trb_message *message);
void       trb_peaks_free(trb_peaks *peaks);

/* Start at an instant of the last step, whose end is given too. */
void trb_peaks_begin(trb_peaks *p, double time, const double *y, double end, const double *y_end);
/* The end of a step. */
void trb_peaks_step(trb_peaks *p, double time, const double *y);
/* The row of the interval since the last record or the beginning, up to an instant of the last step; the next interval starts there. */
void trb_peaks_record(trb_peaks *p, double time, double *row);
/* The row of everything from the beginning to an instant of the last step. */
void trb_peaks_whole(const trb_peaks *p, double time, double *row);

/* All that a checkpoint needs. Held values are not kept: what follows depends on these numbers and the steps alone. */
int  trb_peaks_length(const trb_peaks *p);
void trb_peaks_save(const trb_peaks *p, double *to);
void trb_peaks_restore(trb_peaks *p, const double *from);

#endif
