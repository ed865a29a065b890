/* Peaks: straight lines of known values; the looks of a run against records at every step's end; save and restore. */
#include "motion/peak_track.h"
#include "motion/peaks.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"
#include "stepping/simulation.h"

static void test_track(void)
{
  enum { POCKET, LOAD, FILM, N };
  const trb_peak_sizes n = {1, 2, N};
  double               block[32], between[N];
  trb_peak_track       track = trb_peak_track_in(&n, block);
  CHECK(trb_peak_track_length(&n) <= 32);
  const double inf = (double)INFINITY, at[][1 + N] = {{0, 0, 5, -inf}, {1, 4, 7, -3}, {3, 0, 1, -2}, {4, 0, 1, -4}, {5, 2, 9, -inf}};
  trb_peak_track_start(&n, &track, at[0][0], at[0] + 1, 0);
  for (int i = 1; i < 5; i++) trb_peak_track_line(&n, &track, at[i][0], at[i] + 1);
  CHECK(track.span[0] == 0.0 && track.span[1] == 5.0);
  CHECK(track.most[POCKET] == 4.0 && track.when[POCKET] == 1.0);
  CHECK(track.most[LOAD] == 9.0 && track.when[LOAD] == 5.0);
  CHECK(track.most[FILM] == -2.0 && track.when[FILM] == 3.0);
  CHECK(track.integral[POCKET] == 2.0 + 4.0 + 0.0 + 1.0);
  CHECK(track.integral[LOAD] == 6.0 + 8.0 + 1.0 + 5.0);
  CHECK(track.impacts[0] == 2.0 && track.hardest[0] == 6.0 && track.impulse[0] == 1.0);
  /* a contact under way keeps its impulse over the border of two intervals, and is not counted twice */
  trb_peak_track_start(&n, &track, 5.0, at[4] + 1, 1);
  trb_peak_track_line(&n, &track, 6.0, at[4] + 1);
  CHECK(track.impacts[0] == 0.0 && track.impulse[0] == 3.0 && track.hardest[0] == 3.0 && track.integral[POCKET] == 2.0);
  trb_peak_track_start(&n, &track, 6.0, at[3] + 1, 1);
  CHECK(track.impulse[0] == 0.0 && track.hardest[0] == 0.0);
  /* between two ends, never beyond them */
  trb_peak_track_start(&n, &track, 1.0, at[1] + 1, 0);
  trb_peak_track_between(&n, &track, 3.0, at[2] + 1, 2.0, between);
  CHECK(between[POCKET] == 2.0 && between[LOAD] == 4.0 && between[FILM] == -2.5);
  trb_peak_track_between(&n, &track, 5.0, at[4] + 1, 2.0, between);
  CHECK(between[FILM] == -inf);
  trb_peak_track_between(&n, &track, 3.0, at[2] + 1, 9.0, between);
  CHECK(between[POCKET] == 0.0 && between[LOAD] == 1.0);
  for (int i = 0; i <= 1000; i++) {
    const double close[] = {0.0, nextafter(7.0, 8.0), -3.0};
    trb_peak_track_between(&n, &track, 3.0, close, 1.0 + 0.002 * i, between);
    CHECK(between[LOAD] >= 7.0 && between[LOAD] <= close[1]);
  }
}

static trb_system      *built;
static const trb_model *m;
static trb_motion      *motion;
static double           start[512];

enum { STEPS = 400 };

static trb_simulation *disturbed(unsigned long long seed)
{
  const trb_settings settings = rig_settings();
  trb_simulation    *s = NULL;
  double             state[512];
  memcpy(state, start, sizeof state);
  rig_disturb(built, &seed, state);
  CHECK(rig_create(built, motion, "bdf", "", &settings, 0.0, state, &s, NULL) == TRB_OK);
  return s;
}

/* Largest difference of a field of the row from values, over the largest value. */
static double off(const double *row, int field, const double *values, int n)
{
  const double *found = row + trb_peak_offset(built, field);
  double        worst = 0.0, size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs(values[i]));
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(found[i] - values[i]));
  return size > 0.0 ? worst / size : worst;
}

/* The peaks of a run are those of records at the ends of its steps: of pockets to the last bit, of rings to what may be held. */
static void test_against_records(void)
{
  enum { WIDTH = 64 };
  const int       length = trb_record_offset(built, TRB_N_FIELDS), z = m->n_rollers, pockets = z * m->n_slots;
  trb_simulation *s = disturbed(3);
  double *record = calloc((size_t)length, sizeof *record), *row = calloc((size_t)trb_peak_offset(built, TRB_N_PEAK_FIELDS), sizeof *row);
  double  pocket[WIDTH] = {0}, mean[WIDTH] = {0}, before[WIDTH], outer[WIDTH] = {0}, pressure[WIDTH] = {0}, rib[WIDTH] = {0}, film[WIDTH];
  double  skew[WIDTH] = {0}, last = 0.0;
  for (int i = 0; i < WIDTH; i++) film[i] = INFINITY;
  if (!CHECK(s != NULL && record != NULL && row != NULL && pockets <= WIDTH)) return;
  CHECK(trb_simulation_begin_peaks(s, 0.0, NULL) == TRB_OK);
  for (int step = 0; step <= STEPS; step++) {
    if (step > 0) CHECK(trb_simulation_step(s, NULL) == TRB_OK);
    trb_record_fill(s->parts[0].onlooker, NULL, s->integrator.time, s->integrator.y, s->parts[0].detail, record);
    const double *force = record + trb_record_offset(built, TRB_FIELD_AT_pocket_force);
    const double  h = s->integrator.time - last;
    for (int i = 0; i < pockets; i++) {
      pocket[i] = fmax(pocket[i], force[i]);
      if (step > 0) mean[i] += 0.5 * h * (before[i] + force[i]);
      before[i] = force[i];
    }
    for (int j = 0; j < z; j++) {
      outer[j] = fmax(outer[j], record[trb_record_offset(built, TRB_FIELD_AT_outer_load) + j]);
      pressure[j] = fmax(pressure[j], record[trb_record_offset(built, TRB_FIELD_AT_inner_pressure) + j]);
      rib[j] = fmax(rib[j], record[trb_record_offset(built, TRB_FIELD_AT_rib_load) + j]);
      const double parameter = record[trb_record_offset(built, TRB_FIELD_AT_outer_film_parameter) + j];
      if (parameter > 0.0) film[j] = fmin(film[j], parameter); /* a record of an unloaded contact says 0 */
      skew[j] = fmax(skew[j], fabs(record[trb_record_offset(built, TRB_FIELD_AT_roller_skew) + j]));
    }
    last = s->integrator.time;
  }
  for (int i = 0; i < pockets; i++) mean[i] /= last;
  trb_peaks_whole(s->parts[0].peaks, last, row);
  CHECK(off(row, TRB_PEAK_AT_pocket_force_peak, pocket, pockets) == 0.0);
  CHECK(off(row, TRB_PEAK_AT_pocket_force_mean, mean, pockets) < 1e-12);
  CHECK(off(row, TRB_PEAK_AT_skew_peak, skew, z) == 0.0);
  CHECK(off(row, TRB_PEAK_AT_outer_load_peak, outer, z) < 2e-3);
  CHECK(off(row, TRB_PEAK_AT_inner_pressure_peak, pressure, z) < 2e-3);
  CHECK(off(row, TRB_PEAK_AT_rib_load_peak, rib, z) < 2e-3);
  CHECK(off(row, TRB_PEAK_AT_outer_film_parameter_min, film, z) < 2e-3);
  CHECK(row[trb_peak_offset(built, TRB_PEAK_AT_pocket_force_peak)] >= 0.0);
  double most = 0.0;
  for (int i = 0; i < pockets; i++) most = fmax(most, pocket[i]);
  CHECK(most > 1.0); /* there was something to see */
  free(record);
  free(row);
  trb_simulation_free(s);
}

/* What is saved and restored goes on to the same numbers; another length or time is refused. */
static void test_restore(void)
{
  const int       length = trb_peak_offset(built, TRB_N_PEAK_FIELDS);
  trb_simulation *s = disturbed(5), *other = disturbed(5);
  trb_message     message = {TRB_OK, ""};
  double         *rows = calloc(2 * (size_t)length, sizeof *rows), state[512];
  if (!CHECK(s != NULL && other != NULL && rows != NULL)) return;
  CHECK(trb_simulation_begin_peaks(s, 0.0, NULL) == TRB_OK);
  for (int i = 0; i < STEPS / 2; i++) CHECK(trb_simulation_step(s, NULL) == TRB_OK);
  const int saved_length = trb_peaks_length(s->parts[0].peaks);
  double   *saved = calloc((size_t)saved_length, sizeof *saved);
  if (!CHECK(saved != NULL)) return;
  trb_peaks_save(s->parts[0].peaks, saved);
  memcpy(state, s->integrator.y, sizeof(double) * (size_t)trb_state_size(built));
  const double time = s->integrator.time;
  CHECK(trb_simulation_set_state(other, time, state, NULL) == TRB_OK);
  CHECK(trb_simulation_restore_peaks(other, saved, saved_length - 1, &message) == TRB_ERR_INPUT && !other->with_peaks);
  CHECK_SAYS(message.text, "peaks:");
  saved[0] += 1.0;
  CHECK(trb_simulation_restore_peaks(other, saved, saved_length, &message) == TRB_ERR_INPUT && !other->with_peaks);
  saved[0] = time;
  CHECK(trb_simulation_restore_peaks(other, saved, saved_length, &message) == TRB_OK);
  /* the same restart in the run that goes on */
  CHECK(trb_simulation_set_state(s, time, state, NULL) == TRB_OK && trb_simulation_restore_peaks(s, saved, saved_length, NULL) == TRB_OK);
  for (int i = 0; i < STEPS / 2; i++) CHECK(trb_simulation_step(s, NULL) == TRB_OK && trb_simulation_step(other, NULL) == TRB_OK);
  trb_peaks_save(other->parts[0].peaks, saved);
  trb_peaks_whole(s->parts[0].peaks, s->integrator.time, rows);
  trb_peaks_whole(other->parts[0].peaks, other->integrator.time, rows + length);
  CHECK(memcmp(rows, rows + length, (size_t)length * sizeof *rows) == 0);
  /* to ask changes nothing of what is kept, and the next record's row is as it would have been */
  trb_peaks_record(s->parts[0].peaks, s->integrator.time, rows);
  trb_peaks_restore(other->parts[0].peaks, saved);
  trb_peaks_record(other->parts[0].peaks, other->integrator.time, rows + length);
  CHECK(memcmp(rows, rows + length, (size_t)length * sizeof *rows) == 0);
  CHECK(trb_simulation_begin_peaks(s, s->previous - 1e-9, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "must lie in the last step");
  free(rows);
  free(saved);
  trb_simulation_free(s);
  trb_simulation_free(other);
}

int main(void)
{
  const trb_params p = rig_params();
  const double     speed = 100 * TRB_PI;
  built = rig_system(&p);
  m = built->model;
  motion = rig_motion(rig_state(built, 4930.0, speed, start), speed);
  test_track();
  test_against_records();
  test_restore();
  trb_motion_free(motion);
  rig_free(built);
  return check_report();
}
