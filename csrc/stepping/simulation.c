#include "stepping/simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stepping/vectors.h"

static trb_status check_settings(const trb_settings *settings, trb_message *message)
{
  const double *values = (const double *)settings;
  for (int i = 0; i < TRB_N_SETTINGS; i++) {
    const trb_setting_info *info = &trb_setting_table[i];
    if (!(values[i] >= info->lower && values[i] <= info->upper))
      return trb_fail(message, TRB_ERR_INPUT, "%s = %g: must be from %g to %g", info->name, values[i], info->lower, info->upper);
  }
  return TRB_OK;
}

/* Name of a state entry, for a person, as the text of a message. */
static void describe(const trb_system *system, int index, trb_message *out)
{
#define TRB_STATE_NAME(name, kind, what) #name " (" what ")",
  static const char *const roller[TRB_ROLLER_SIZE] = {TRB_ROLLER_STATE(TRB_STATE_NAME)};
#undef TRB_STATE_NAME
  if (index < 0) (void)trb_fail(out, TRB_OK, "no single quantity");
  else if (index < trb_state_hub(system))
    (void)trb_fail(out, TRB_OK, "roller %d, %s", index / TRB_ROLLER_SIZE, roller[index % TRB_ROLLER_SIZE]);
  else if (index < trb_state_main_size(system)) {
    int                   coordinate;
    const trb_body       *body = trb_state_body(system, index, &coordinate);
    const trb_coordinate *is = &body->coordinates[coordinate];
    (void)trb_fail(out, TRB_OK, "%s, %s (%s)", body->name, is->name, is->text);
  } else (void)trb_fail(out, TRB_OK, "spin angle or quadrature %d", index - trb_state_main_size(system));
}

static trb_status check_state(const trb_system *system, double time, const double *state, trb_message *message)
{
  const trb_model *m = system->model;
  trb_message      what;
  if (!isfinite(time)) return trb_fail(message, TRB_ERR_STATE, "time = %g: must be finite", time);
  for (int i = 0; i < trb_state_size(system); i++)
    if (!isfinite(state[i])) {
      describe(system, i, &what);
      return trb_fail(message, TRB_ERR_STATE, "state[%d] = %g, %.200s: must be finite", i, state[i], what.text);
    }
  for (int j = 0; j < m->n_rollers; j++) {
    const double *y = state + trb_state_roller(j);
    if (!(m->geometry.roller_centre_radius + y[TRB_ROLLER_r] > 0.0) || fabs(y[TRB_ROLLER_skew]) > 1.5)
      return trb_fail(message, TRB_ERR_STATE, "roller %d: r = %g m, skew = %g rad: beyond what the coordinates hold", j, y[TRB_ROLLER_r],
                      y[TRB_ROLLER_skew]);
  }
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_body *body = &system->bodies[b];
    if (body->size == 0 || body->kind->skew < 0) continue;
    const double skew = state[body->first + body->kind->skew];
    if (fabs(skew) > 1.5) return trb_fail(message, TRB_ERR_STATE, "%s: skew = %g rad: beyond what the coordinates hold", body->name, skew);
  }
  return TRB_OK;
}

static const trb_integrator_kind *find_kind(const char *name)
{
  for (int i = 0; i < trb_n_integrator_kinds; i++)
    if (strcmp(trb_integrator_kinds[i]->name, name) == 0) return trb_integrator_kinds[i];
  return NULL;
}

static trb_status open_parts(trb_simulation *s, const char *variant, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  trb_status      status;
  it->n = trb_state_size(s->system);
  it->n_main = trb_state_main_size(s->system);
  it->y = trb_zeros((size_t)it->n + TRB_VECTOR_ROOM, sizeof(double));
  it->scale = trb_zeros((size_t)it->n, sizeof(double));
  it->relative = trb_zeros((size_t)it->n, sizeof(double));
  s->between = trb_zeros((size_t)it->n, sizeof(double));
  s->apart = calloc((size_t)s->model->n_rollers, sizeof *s->apart);
  if (!it->y || !it->scale || !it->relative || !s->between || !s->apart)
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a simulation");
  if ((status = trb_dynamics_create(s->system, s->motion, variant, &s->dynamics, message)) != TRB_OK) return status;
  if ((status = trb_dynamics_create(s->system, s->motion, variant, &s->onlooker, message)) != TRB_OK) return status;
  if ((status = trb_detail_create(s->model, s->system->pairs, s->system->n_pairs, &s->detail, message)) != TRB_OK) return status;
  it->dynamics = s->dynamics;
  it->motion = s->motion;
  it->variant = variant;
  trb_integrator_set_tolerances(it);
  return trb_impacts_create(s->model, &it->impacts, message);
}

trb_status trb_simulation_create(const trb_system *system, const trb_motion *motion, const char *kind, const char *variant,
                                 const trb_settings *settings, double time, const double *state, trb_simulation **simulation,
                                 trb_message *message)
{
  *simulation = NULL;
  trb_status status = check_settings(settings, message);
  if (status != TRB_OK) return status;
  if ((status = check_state(system, time, state, message)) != TRB_OK) return status;
  trb_simulation *s = calloc(1, sizeof *s);
  if (s == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a simulation");
  s->system = system;
  s->model = system->model;
  s->motion = motion;
  s->previous = time;
  s->integrator.settings = *settings;
  s->integrator.time = time;
  s->integrator.kind = find_kind(kind);
  if (s->integrator.kind == NULL) status = trb_fail(message, TRB_ERR_INPUT, "integrator = '%s': must be 'bdf' or 'erk'", kind);
  if (status == TRB_OK) status = open_parts(s, variant, message);
  if (status == TRB_OK) {
    memcpy(s->integrator.y, state, (size_t)s->integrator.n * sizeof *state);
    status = s->integrator.kind->create(&s->integrator, message);
  }
  if (status != TRB_OK) {
    trb_simulation_free(s);
    return status;
  }
  *simulation = s;
  return TRB_OK;
}

void trb_simulation_free(trb_simulation *s)
{
  if (s == NULL) return;
  if (s->integrator.kind != NULL) s->integrator.kind->free(&s->integrator);
  free(s->integrator.y);
  trb_impacts_free(&s->integrator.impacts);
  free(s->integrator.scale);
  free(s->integrator.relative);
  free(s->between);
  free(s->apart);
  trb_detail_free(s->detail);
  trb_dynamics_free(s->dynamics);
  trb_dynamics_free(s->onlooker);
  trb_peaks_free(s->peaks);
  free(s);
}

trb_status trb_simulation_set_state(trb_simulation *s, double time, const double *state, trb_message *message)
{
  const trb_status status = check_state(s->system, time, state, message);
  if (status != TRB_OK) return status;
  memmove(s->integrator.y, state, (size_t)s->integrator.n * sizeof *state);
  s->integrator.time = s->previous = time;
  trb_integrator_set_tolerances(&s->integrator);
  trb_impacts_forget(s->model, &s->integrator.impacts);
  trb_dynamics_forget(s->dynamics);
  if (s->peaks != NULL) trb_peaks_begin(s->peaks, time, s->integrator.y, time, s->integrator.y);
  return s->integrator.kind->restart(&s->integrator, message);
}

trb_status trb_simulation_step(trb_simulation *s, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  const double    from = it->time;
  memcpy(s->between, it->y, (size_t)it->n * sizeof(double));
  if (s->motion->n > 1 || s->model->params.ring_free > 1.0) trb_integrator_set_tolerances(it);
  const trb_status status = it->kind->step(it, message);
  if (status == TRB_OK) {
    s->previous = from;
    if (s->recorder != NULL && s->peaks != NULL) trb_recorder_step(s->recorder, it->time, it->y);
    else if (s->peaks != NULL) trb_peaks_step(s->peaks, it->time, it->y);
    return TRB_OK;
  }
  trb_message what, cause = *message;
  describe(s->system, it->kind->worst(it), &what);
  memcpy(it->y, s->between, (size_t)it->n * sizeof(double));
  it->time = from;
  return trb_fail(message, status, "at t = %.9g s: %.200s; largest error: %.200s", from, cause.text, what.text);
}

trb_status trb_simulation_state_at(trb_simulation *s, double time, double *y, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  if (!(time >= s->previous && time <= it->time))
    return trb_fail(message, TRB_ERR_INPUT, "time = %.9g s: must lie in the last step, from %.9g to %.9g s", time, s->previous, it->time);
  if (time < it->time) return it->kind->interpolate(it, time, y, message);
  memcpy(y, it->y, (size_t)it->n * sizeof *y);
  return TRB_OK;
}

trb_status trb_simulation_begin_peaks(trb_simulation *s, double time, trb_message *message)
{
  trb_status status = trb_simulation_state_at(s, time, s->between, message);
  if (status == TRB_OK && s->peaks == NULL) status = trb_peaks_create(s->system, s->motion, s->integrator.variant, &s->peaks, message);
  if (status == TRB_OK) trb_peaks_begin(s->peaks, time, s->between, s->integrator.time, s->integrator.y);
  return status;
}

void trb_simulation_end_peaks(trb_simulation *s)
{
  trb_peaks_free(s->peaks);
  s->peaks = NULL;
}

trb_status trb_simulation_restore_peaks(trb_simulation *s, const double *saved, int length, trb_message *message)
{
  trb_status status = trb_simulation_begin_peaks(s, s->integrator.time, message);
  if (status == TRB_OK && length != trb_peaks_length(s->peaks))
    status = trb_fail(message, TRB_ERR_INPUT, "peaks: %d values needed, %d given", trb_peaks_length(s->peaks), length);
  if (status == TRB_OK && saved[0] != s->integrator.time)
    status = trb_fail(message, TRB_ERR_INPUT, "peaks: of t = %.9g s, not of %.9g s", saved[0], s->integrator.time);
  if (status == TRB_OK) trb_peaks_restore(s->peaks, saved);
  else trb_simulation_end_peaks(s);
  return status;
}

int trb_simulation_row(const trb_simulation *s)
{
  return trb_record_offset(s->model, TRB_N_FIELDS) + (s->peaks != NULL ? trb_peak_offset(s->model, TRB_N_PEAK_FIELDS) : 0);
}

static trb_status output(trb_simulation *s, double time, double *record, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  const double   *y = it->y;
  if (time != it->time) {
    const trb_status status = it->kind->interpolate(it, time, s->between, message);
    if (status != TRB_OK) return status;
    y = s->between;
  }
  if (s->recorder != NULL) {
    trb_recorder_record(s->recorder, s->dynamics, time, y, record);
    return TRB_OK;
  }
  trb_dynamics_apart(s->dynamics, y, s->apart);
  trb_record_fill(s->onlooker, s->apart, time, y, s->detail, record);
  if (s->peaks != NULL) trb_peaks_record(s->peaks, time, record + trb_record_offset(s->model, TRB_N_FIELDS));
  return TRB_OK;
}

static trb_status run(trb_simulation *s, const double *times, int n, double stop_after, double *records, long max_steps, int *rows,
                      long *steps, trb_message *message)
{
  const size_t length = (size_t)trb_simulation_row(s);
  while (*rows < n) {
    const double time = times[*rows];
    if (time < s->previous)
      return trb_fail(message, TRB_ERR_INPUT, "output time %g s lies before the last step, at %g s", time, s->previous);
    if (time <= s->integrator.time) {
      const trb_status status = output(s, time, records + (size_t)*rows * length, message);
      if (status != TRB_OK) return status;
      ++*rows;
      continue;
    }
    if (*steps >= max_steps || s->integrator.time >= stop_after) return TRB_OK;
    const trb_status status = trb_simulation_step(s, message);
    if (status != TRB_OK) return status;
    ++*steps;
  }
  return TRB_OK;
}

trb_status trb_simulation_run(trb_simulation *s, const double *times, int n, double stop_after, double *records, long max_steps, int beside,
                              int *rows, long *steps, trb_message *message)
{
  const trb_recorder_parts parts = {.model = s->model, .onlooker = s->onlooker, .detail = s->detail, .peaks = s->peaks};
  *rows = 0;
  *steps = 0;
  if (beside) s->recorder = trb_recorder_open(&parts, s->integrator.n);
  const trb_status status = run(s, times, n, stop_after, records, max_steps, rows, steps, message);
  trb_recorder_close(s->recorder);
  s->recorder = NULL;
  return status;
}
