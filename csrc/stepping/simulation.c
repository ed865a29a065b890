#include "stepping/simulation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stepping/constants.h"
#include "stepping/vectors.h"
#include "motion/fast_pairs.h"
#include "motion/spacer.h"

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
static void describe(const trb_assembly *assembly, int index, trb_message *out)
{
  const trb_system *system = trb_assembly_owner(assembly, index);
  char              of[32] = "";
  if (assembly->n > 1 && system != NULL) (void)snprintf(of, sizeof of, "bearing %d, ", (int)(system - assembly->members) + 1);
  if (index < 0) (void)trb_fail(out, TRB_OK, "no single quantity");
  else if (system == NULL) (void)trb_fail(out, TRB_OK, "spin angle or quadrature %d", index - trb_state_main_size(&assembly->members[0]));
  else if (index < trb_state_hub(system)) {
    const int             own = index - trb_state_roller(system, 0);
    const trb_coordinate *is = &trb_roller_coordinates[own % TRB_ROLLER_SIZE];
    (void)trb_fail(out, TRB_OK, "%sroller %d, %s (%s)", of, own / TRB_ROLLER_SIZE, is->name, is->text);
  } else {
    int                   coordinate;
    const trb_body       *body = trb_state_body(system, index, &coordinate);
    const trb_coordinate *is = &body->coordinates[coordinate];
    (void)trb_fail(out, TRB_OK, "%s%s, %s (%s)", of, body->name, is->name, is->text);
  }
}

static trb_status check_bearing(const trb_system *system, const double *state, trb_message *message)
{
  const trb_model *m = system->model;
  for (int j = 0; j < m->n_rollers; j++) {
    const double *y = state + trb_state_roller(system, j);
    if (!(m->geometry.roller_centre_radius + y[TRB_ROLLER_r] > 0.0) || fabs(y[TRB_ROLLER_skew]) > trb_most_skew)
      return trb_fail(message, TRB_ERR_STATE, "roller %d: r = %g m, skew = %g rad: beyond what the coordinates hold", j, y[TRB_ROLLER_r],
                      y[TRB_ROLLER_skew]);
  }
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_body *body = &system->bodies[b];
    if (body->size == 0 || body->kind->skew < 0) continue;
    const double skew = state[body->first + body->kind->skew];
    if (fabs(skew) > trb_most_skew)
      return trb_fail(message, TRB_ERR_STATE, "%s: skew = %g rad: beyond what the coordinates hold", body->name, skew);
  }
  return TRB_OK;
}

static trb_status check_state(const trb_assembly *assembly, double time, const double *state, trb_message *message)
{
  trb_message what;
  trb_status  status = TRB_OK;
  if (!isfinite(time)) return trb_fail(message, TRB_ERR_STATE, "time = %g: must be finite", time);
  for (int i = 0; i < trb_state_size(&assembly->members[0]); i++)
    if (!isfinite(state[i])) {
      describe(assembly, i, &what);
      return trb_fail(message, TRB_ERR_STATE, "state[%d] = %g, %.200s: must be finite", i, state[i], what.text);
    }
  for (int k = 0; k < assembly->n && status == TRB_OK; k++) status = check_bearing(&assembly->members[k], state, message);
  return status;
}

static const trb_integrator_kind *find_kind(const char *name)
{
  for (int i = 0; i < trb_n_integrator_kinds; i++)
    if (strcmp(trb_integrator_kinds[i]->name, name) == 0) return trb_integrator_kinds[i];
  return NULL;
}

/* What a bearing of the assembly is integrated and recorded with. */
static trb_status open_member(trb_simulation *s, int k, const trb_motion *motion, const char *variant, trb_message *message)
{
  const trb_system *system = &s->assembly.members[k];
  trb_member       *member = &s->integrator.members[k];
  trb_record_parts *parts = &s->parts[k];
  trb_status        status = trb_dynamics_create(system, motion, variant, &member->dynamics, message);
  member->motion = motion;
  parts->stepping = member->dynamics;
  if (status == TRB_OK) status = trb_dynamics_create(system, motion, variant, &parts->onlooker, message);
  if (status == TRB_OK) status = trb_detail_create(system->model, system->pairs, system->n_pairs, &parts->detail, message);
  if (status == TRB_OK) status = trb_impacts_create(system->model, &member->impacts, message);
  s->apart[k] = trb_memory_zeros(&s->memory, (size_t)system->model->n_rollers, sizeof *s->apart[k]);
  if (status == TRB_OK && s->memory.lacks) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for a simulation");
  return status;
}

static trb_status open_parts(trb_simulation *s, const trb_motion *const *motions, const char *variant, trb_message *message)
{
  trb_integrator   *it = &s->integrator;
  const trb_system *first = &s->assembly.members[0];
  it->assembly = &s->assembly;
  it->variant = variant;
  it->n = trb_state_size(first);
  it->n_main = trb_state_main_size(first);
  it->y = trb_memory_zeros(&s->memory, (size_t)it->n + TRB_VECTOR_ROOM, sizeof(double));
  it->scale = trb_memory_zeros(&s->memory, (size_t)it->n, sizeof(double));
  it->relative = trb_memory_zeros(&s->memory, (size_t)it->n, sizeof(double));
  s->between = trb_memory_zeros(&s->memory, (size_t)it->n, sizeof(double));
  if (s->memory.lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a simulation");
  trb_status status = TRB_OK;
  for (int k = 0; k < s->assembly.n && status == TRB_OK; k++) status = open_member(s, k, motions[k], variant, message);
  return status;
}

/* Rollers of all bearings where spacers hold them. */
static void hold(const trb_simulation *s, double time, double *y)
{
  for (int k = 0; k < s->assembly.n; k++) {
    const trb_system *system = &s->assembly.members[k];
    trb_drive         drive;
    if (system->spacer < 0) continue;
    trb_motion_at(s->integrator.members[k].motion, system->model, time, &drive);
    trb_spacer_hold(system, &drive, y);
  }
}

static trb_status interpolate(trb_simulation *s, double time, double *y, trb_message *message)
{
  const trb_status status = s->integrator.kind->interpolate(&s->integrator, time, y, message);
  if (status == TRB_OK) hold(s, time, y);
  return status;
}

static trb_status open_all(trb_simulation *s, const trb_system *const *systems, const trb_motion *const *motions, int n,
                           const char *variant, double time, const double *state, int n_state, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  trb_status      status = trb_assembly_make(systems, n, &s->assembly, message);
  if (status == TRB_OK && n_state != trb_state_size(&s->assembly.members[0]))
    status = trb_fail(message, TRB_ERR_INPUT, "state: %d values needed, %d given", trb_state_size(&s->assembly.members[0]), n_state);
  if (status == TRB_OK) status = check_state(&s->assembly, time, state, message);
  if (status == TRB_OK) status = open_parts(s, motions, variant, message);
  if (status != TRB_OK) return status;
  memcpy(it->y, state, (size_t)it->n * sizeof *state);
  hold(s, time, it->y);
  trb_integrator_set_tolerances(it);
  if (it->kind == NULL) trb_integrator_choose(it);
  return it->kind->create(it, message);
}

trb_status trb_simulation_create(const trb_system *const *systems, const trb_motion *const *motions, int n, const char *kind,
                                 const char *variant, const trb_settings *settings, double time, const double *state, int n_state,
                                 trb_simulation **simulation, trb_message *message)
{
  *simulation = NULL;
  const trb_status status = check_settings(settings, message);
  if (status != TRB_OK) return status;
  const trb_integrator_kind *found = find_kind(kind);
  if (found == NULL && strcmp(kind, "auto") != 0)
    return trb_fail(message, TRB_ERR_INPUT, "integrator = '%s': must be 'auto', 'multirate', 'bdf' or 'erk'", kind);
  trb_simulation *s = calloc(1, sizeof *s);
  if (s == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a simulation");
  s->previous = time;
  s->integrator.settings = *settings;
  s->integrator.time = time;
  s->integrator.kind = found;
  const trb_status opened = open_all(s, systems, motions, n, variant, time, state, n_state, message);
  if (opened != TRB_OK) {
    trb_simulation_free(s);
    return opened;
  }
  *simulation = s;
  return TRB_OK;
}

void trb_simulation_free(trb_simulation *s)
{
  if (s == NULL) return;
  trb_integrator *it = &s->integrator;
  trb_simulation_end_peaks(s);
  if (it->kind != NULL) it->kind->free(it);
  for (int k = 0; k < TRB_MOST_MEMBERS; k++) {
    trb_memory_free(&it->members[k].impacts.memory);
    trb_dynamics_free(it->members[k].dynamics);
    trb_dynamics_free(s->parts[k].onlooker);
    trb_detail_free(s->parts[k].detail);
  }
  trb_memory_free(&s->memory);
  free(s);
}

static void begin_peaks(trb_simulation *s, double time, const double *y)
{
  for (int k = 0; k < s->assembly.n; k++) trb_peaks_begin(s->parts[k].peaks, time, y, s->integrator.time, s->integrator.y);
}

trb_status trb_simulation_set_state(trb_simulation *s, double time, const double *state, trb_message *message)
{
  trb_integrator  *it = &s->integrator;
  const trb_status status = check_state(&s->assembly, time, state, message);
  if (status != TRB_OK) return status;
  memmove(it->y, state, (size_t)it->n * sizeof *state);
  hold(s, time, it->y);
  it->time = s->previous = time;
  trb_integrator_set_tolerances(it);
  for (int k = 0; k < s->assembly.n; k++) {
    trb_impacts_forget(s->assembly.members[k].model, &it->members[k].impacts);
    trb_fast_forget(it->members[k].dynamics);
  }
  if (s->with_peaks) begin_peaks(s, time, it->y);
  return it->kind->restart(it, message);
}

/* Whether the speed of rolling, and tolerances with it, change in the course of time. */
static int changes_speed(const trb_simulation *s)
{
  int changes = trb_integrator_is_driven(&s->integrator);
  for (int k = 0; k < s->assembly.n; k++) {
    const trb_body *driven = &s->assembly.members[k].bodies[s->assembly.members[k].driven];
    changes |= driven->size > 0 && driven->own != NULL && !((const trb_ring_body *)driven->own)->keeps_speed;
  }
  return changes;
}

trb_status trb_simulation_step(trb_simulation *s, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  const double    from = it->time;
  memcpy(s->between, it->y, (size_t)it->n * sizeof(double));
  if (changes_speed(s)) trb_integrator_set_tolerances(it);
  const trb_status status = it->kind->step(it, message);
  if (status == TRB_OK) {
    s->previous = from;
    hold(s, it->time, it->y);
    if (!s->with_peaks) return TRB_OK;
    if (s->recorder != NULL) trb_recorder_put(s->recorder, it->time, it->y, NULL);
    for (int k = 0; k < s->assembly.n && s->recorder == NULL; k++) trb_peaks_step(s->parts[k].peaks, it->time, it->y);
    return TRB_OK;
  }
  trb_message what, cause = *message;
  describe(&s->assembly, it->kind->worst(it), &what);
  memcpy(it->y, s->between, (size_t)it->n * sizeof(double));
  it->time = from;
  return trb_fail(message, status, "at t = %.9g s: %.200s; largest error: %.200s", from, cause.text, what.text);
}

trb_status trb_simulation_state_at(trb_simulation *s, double time, double *y, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  if (!(time >= s->previous && time <= it->time))
    return trb_fail(message, TRB_ERR_INPUT, "time = %.9g s: must lie in the last step, from %.9g to %.9g s", time, s->previous, it->time);
  if (time < it->time) return interpolate(s, time, y, message);
  memcpy(y, it->y, (size_t)it->n * sizeof *y);
  return TRB_OK;
}

trb_status trb_simulation_begin_peaks(trb_simulation *s, double time, trb_message *message)
{
  trb_status status = trb_simulation_state_at(s, time, s->between, message);
  for (int k = 0; k < s->assembly.n && status == TRB_OK; k++)
    if (s->parts[k].peaks == NULL)
      status =
          trb_peaks_create(&s->assembly.members[k], s->integrator.members[k].motion, s->integrator.variant, &s->parts[k].peaks, message);
  if (status != TRB_OK) return status;
  s->with_peaks = 1;
  begin_peaks(s, time, s->between);
  return TRB_OK;
}

void trb_simulation_end_peaks(trb_simulation *s)
{
  for (int k = 0; k < TRB_MOST_MEMBERS; k++) {
    trb_peaks_free(s->parts[k].peaks);
    s->parts[k].peaks = NULL;
  }
  s->with_peaks = 0;
}

int trb_simulation_peaks_length(const trb_simulation *s)
{
  int length = 0;
  for (int k = 0; k < s->assembly.n && s->with_peaks; k++) length += trb_peaks_length(s->parts[k].peaks);
  return length;
}

void trb_simulation_save_peaks(const trb_simulation *s, double *to)
{
  for (int k = 0; k < s->assembly.n && s->with_peaks; k++) {
    trb_peaks_save(s->parts[k].peaks, to);
    to += trb_peaks_length(s->parts[k].peaks);
  }
}

trb_status trb_simulation_restore_peaks(trb_simulation *s, const double *saved, int length, trb_message *message)
{
  trb_status status = trb_simulation_begin_peaks(s, s->integrator.time, message);
  if (status == TRB_OK && length != trb_simulation_peaks_length(s))
    status = trb_fail(message, TRB_ERR_INPUT, "peaks: %d values needed, %d given", trb_simulation_peaks_length(s), length);
  if (status == TRB_OK && saved[0] != s->integrator.time)
    status = trb_fail(message, TRB_ERR_INPUT, "peaks: of t = %.9g s, not of %.9g s", saved[0], s->integrator.time);
  for (int k = 0; k < s->assembly.n && status == TRB_OK; k++) {
    trb_peaks_restore(s->parts[k].peaks, saved);
    saved += trb_peaks_length(s->parts[k].peaks);
  }
  if (status != TRB_OK) trb_simulation_end_peaks(s);
  return status;
}

int trb_simulation_whole_length(const trb_simulation *s)
{
  int length = 0;
  for (int k = 0; k < s->assembly.n && s->with_peaks; k++) length += trb_peak_offset(&s->assembly.members[k], TRB_N_PEAK_FIELDS);
  return length;
}

void trb_simulation_whole_peaks(const trb_simulation *s, double time, double *to)
{
  for (int k = 0; k < s->assembly.n && s->with_peaks; k++) {
    trb_peaks_whole(s->parts[k].peaks, time, to);
    to += trb_peak_offset(&s->assembly.members[k], TRB_N_PEAK_FIELDS);
  }
}

int trb_simulation_row(const trb_simulation *s)
{
  int length = 0;
  for (int k = 0; k < s->assembly.n; k++) length += trb_record_parts_length(&s->parts[k]);
  return length;
}

static trb_status output(trb_simulation *s, double time, double *record, trb_message *message)
{
  trb_integrator *it = &s->integrator;
  const double   *y = it->y;
  if (time != it->time) {
    const trb_status status = interpolate(s, time, s->between, message);
    if (status != TRB_OK) return status;
    y = s->between;
  }
  if (s->recorder != NULL) {
    trb_recorder_put(s->recorder, time, y, record);
    return TRB_OK;
  }
  for (int k = 0; k < s->assembly.n; k++) {
    trb_fast_apart(it->members[k].dynamics, y, s->apart[k]);
    trb_record_parts_fill(&s->parts[k], s->apart[k], time, y, record);
    record += trb_record_parts_length(&s->parts[k]);
  }
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
  *rows = 0;
  *steps = 0;
  if (beside) s->recorder = trb_recorder_open(s->parts, s->assembly.n, s->integrator.n);
  const trb_status status = run(s, times, n, stop_after, records, max_steps, rows, steps, message);
  trb_recorder_close(s->recorder);
  s->recorder = NULL;
  return status;
}
