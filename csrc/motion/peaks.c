#include "motion/peaks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "motion/peak_look.h"
#include "motion/peak_track.h"

const trb_peak_field_info trb_peak_field_table[TRB_N_PEAK_FIELDS] = {
#define TRB_PEAK_FIELD_INFO(name, quantity, take, unit, text) {#name, unit, text, TRB_PEAK_##quantity, TRB_TAKE_##take},
    TRB_PEAK_FIELDS(TRB_PEAK_FIELD_INFO)
#undef TRB_PEAK_FIELD_INFO
};

trb_field_kind trb_peak_kind(const trb_peak_field_info *field) { return trb_field_table[trb_peak_quantities[field->quantity].field].kind; }

const char *trb_peak_joined(const trb_peak_field_info *field)
{
  switch (field->take) {
  case TRB_TAKE_EXTREME: return trb_peak_quantities[field->quantity].sense == TRB_PEAK_MOST ? "largest" : "smallest";
  case TRB_TAKE_HARDEST: return "largest";
  case TRB_TAKE_TIME: return "time";
  case TRB_TAKE_MEAN: return "mean";
  case TRB_TAKE_IMPACTS:
  case TRB_TAKE_IMPULSE: return "sum";
  }
  return "";
}

int trb_peak_offset(const trb_system *s, int field)
{
  int offset = 0;
  for (int i = 0; i < field; i++) offset += trb_field_size(s, trb_peak_quantities[trb_peak_field_table[i].quantity].field);
  return offset;
}

struct trb_peaks {
  trb_peak_look *look;
  trb_peak_sizes n;
  int            offset[TRB_N_PEAK_QUANTITIES + 1]; /* where each quantity begins among the values; the end */
  double        *block;                             /* what is saved, then what is asked between */
  double        *end;                               /* of the last step, s */
  double        *value;                             /* there */
  trb_peak_track whole;                             /* the run up to the start of the last step */
  trb_peak_track interval;                          /* from the last record up to there, or nothing yet */
  trb_peak_track asked;
  double        *between;
};

trb_status trb_peaks_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_peaks **peaks,
                            trb_message *message)
{
  *peaks = NULL;
  trb_peaks *p = calloc(1, sizeof *p);
  if (p == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  p->n = trb_peak_look_sizes(system);
  for (int i = 0; i <= TRB_N_PEAK_QUANTITIES; i++) p->offset[i] = trb_peak_look_offset(system, i);
  const size_t all = (size_t)p->n.all, track = (size_t)trb_peak_track_length(&p->n);
  p->block = trb_zeros(1 + 2 * all + 3 * track, sizeof(double));
  trb_status status = p->block != NULL ? TRB_OK : trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  if (status == TRB_OK) status = trb_peak_look_create(system, motion, variant, &p->look, message);
  if (status != TRB_OK) {
    trb_peaks_free(p);
    return status;
  }
  p->end = p->block;
  p->value = p->end + 1;
  p->whole = trb_peak_track_in(&p->n, p->value + all);
  p->interval = trb_peak_track_in(&p->n, p->value + all + track);
  p->asked = trb_peak_track_in(&p->n, p->value + all + 2 * track);
  p->between = p->value + all + 3 * track;
  *peaks = p;
  return TRB_OK;
}

void trb_peaks_free(trb_peaks *peaks)
{
  if (peaks == NULL) return;
  trb_peak_look_free(peaks->look);
  free(peaks->block);
  free(peaks);
}

void trb_peaks_begin(trb_peaks *p, double time, const double *y, double end, const double *y_end)
{
  trb_peak_look_forget(p->look);
  trb_peak_look_start(p->look, p->value);
  trb_peak_look_at(p->look, time, y, p->value);
  trb_peak_track_start(&p->n, &p->whole, time, p->value, 0);
  trb_peak_track_start(&p->n, &p->interval, time, p->value, 0);
  *p->end = time;
  if (end > time) {
    trb_peak_look_at(p->look, end, y_end, p->value);
    *p->end = end;
  }
  trb_peak_look_forget(p->look); /* as after trb_peaks_restore: a checkpoint may lie here */
}

void trb_peaks_step(trb_peaks *p, double time, const double *y)
{
  trb_peak_track_line(&p->n, &p->whole, *p->end, p->value);
  trb_peak_track_line(&p->n, &p->interval, *p->end, p->value);
  trb_peak_look_at(p->look, time, y, p->value);
  *p->end = time;
}

static double taken(const trb_peak_field_info *field, const trb_peak_track *track, int i)
{
  const double length = track->span[1] - track->span[0];
  const int    least = trb_peak_quantities[field->quantity].sense == TRB_PEAK_LEAST;
  switch (field->take) {
  case TRB_TAKE_EXTREME: return !isfinite(track->most[i]) ? (double)NAN : least ? -track->most[i] : track->most[i];
  case TRB_TAKE_TIME: return track->when[i];
  case TRB_TAKE_MEAN: return length > 0.0 ? track->integral[i] / length : track->value[i];
  case TRB_TAKE_IMPACTS: return track->impacts[i];
  case TRB_TAKE_IMPULSE: return track->integral[i];
  case TRB_TAKE_HARDEST: return track->hardest[i];
  }
  return (double)NAN;
}

static void write_row(const trb_peaks *p, const trb_peak_track *track, double *row)
{
  for (int f = 0; f < TRB_N_PEAK_FIELDS; f++) {
    const trb_peak_field_info *field = &trb_peak_field_table[f];
    for (int i = p->offset[field->quantity]; i < p->offset[field->quantity + 1]; i++) *row++ = taken(field, track, i);
  }
}

void trb_peaks_record(trb_peaks *p, double time, double *row)
{
  /* the line is that of the whole step, so that it does not depend on other records */
  trb_peak_track_between(&p->n, &p->whole, *p->end, p->value, time, p->between);
  trb_peak_track_line(&p->n, &p->interval, time, p->between);
  write_row(p, &p->interval, row);
  trb_peak_track_start(&p->n, &p->interval, time, p->between, 1);
}

void trb_peaks_whole(const trb_peaks *p, double time, double *row)
{
  trb_peak_track asked = p->asked;
  trb_peak_track_between(&p->n, &p->whole, *p->end, p->value, time, p->between);
  memcpy(asked.span, p->whole.span, (size_t)trb_peak_track_length(&p->n) * sizeof(double));
  trb_peak_track_line(&p->n, &asked, time, p->between);
  write_row(p, &asked, row);
}

int trb_peaks_length(const trb_peaks *p) { return 1 + p->n.all + 2 * trb_peak_track_length(&p->n); }

void trb_peaks_save(const trb_peaks *p, double *to) { memcpy(to, p->block, (size_t)trb_peaks_length(p) * sizeof *to); }

void trb_peaks_restore(trb_peaks *p, const double *from)
{
  memcpy(p->block, from, (size_t)trb_peaks_length(p) * sizeof *from);
  trb_peak_look_forget(p->look);
}
