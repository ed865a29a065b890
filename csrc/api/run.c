/* Runs of a case: its model, its system, the start in the equilibrium at speed, steps, and quantities by name. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/case.h"
#include "body/cage.h"
#include "motion/equilibrium.h"
#include "motion/record.h"
#include "stepping/simulation.h"
#include "system/tapered.h"

struct trb_run {
  trb_model      *model;
  trb_system     *system;
  trb_motion     *motion;
  trb_simulation *simulation;
  double         *row; /* of records, at `time` */
  double          time;
};

#ifndef TRB_VERSION_TEXT
#define TRB_VERSION_TEXT "unknown"
#endif

const char *trb_version(void) { return TRB_VERSION_TEXT; }

typedef struct trb_preset {
  const char *name;
  double      rtol, atol_position, atol_angle, atol_velocity, atol_spin, rings_share, impact_share;
} trb_preset;

/* The presets of trbdyn.run.options, which a test compares (tests/api/test_core_alone.py). */
static const trb_preset trb_presets[] = {
    {"fast", 3e-3, 3e-9, 3e-7, 1e-3, 0.1, 0.1, 0.1},
    {"standard", 1e-3, 9e-10, 9e-8, 3e-4, 3e-2, 0.1, 0.03},
    {"reference", 1e-4, 6e-11, 6e-9, 2e-5, 2e-3, 0.03, 0.01},
};

static trb_status settings_of(const char *accuracy, trb_settings *settings, trb_message *message)
{
  double *values = (double *)settings;
  for (int i = 0; i < TRB_N_SETTINGS; i++) values[i] = trb_setting_table[i].standard;
  for (size_t i = 0; i < sizeof trb_presets / sizeof *trb_presets; i++) {
    const trb_preset *p = &trb_presets[i];
    if (strcmp(p->name, accuracy) != 0) continue;
    settings->rtol = p->rtol, settings->atol_position = p->atol_position, settings->atol_angle = p->atol_angle;
    settings->atol_velocity = p->atol_velocity, settings->atol_spin = p->atol_spin;
    settings->rings_share = p->rings_share, settings->impact_share = p->impact_share;
    return TRB_OK;
  }
  return trb_fail(message, TRB_ERR_INPUT, "accuracy = %s: must be fast, standard or reference", accuracy);
}

/* The bearing of a case. */
static trb_status make_system(const trb_case *c, trb_run *run, trb_message *message)
{
  trb_face   faces[TRB_CASE_FACES];
  double     deviation[200] = {0}; /* as many rollers as a bearing may have */
  trb_status status = trb_case_faces(c, faces, message);
  if (status != TRB_OK) return status;
  status = trb_model_create(&c->params, deviation, (int)c->params.bearing.n_rollers, faces, TRB_CASE_FACES, &run->model, message);
  return status == TRB_OK ? trb_system_tapered(run->model, &run->system, message) : status;
}

/* Rollers and ring in equilibrium under the loads: the motion of the ring, which stays there, and the state of pure rolling
 * (docs/theory/motion.md#equilibrium-of-the-ring). */
static trb_status start(const trb_case *c, trb_run *run, double *state, trb_message *message)
{
  const trb_model *m = run->model;
  const double     speed = c->own[TRB_CASE_speed_rpm] * TRB_PI / 30.0, orbit = m->geometry.cage_speed_ratio * speed;
  const double     axis = m->geometry.roller_axis_angle;
  double          *angles = calloc((size_t)m->n_rollers * (1 + TRB_ROLLER_FREEDOMS), sizeof *angles);
  if (angles == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory");
  trb_equilibrium e = {.load = {c->own[TRB_CASE_radial_load_x], c->own[TRB_CASE_radial_load_y], -c->own[TRB_CASE_axial_load], 0, 0},
                       .fixed = {0, 0, 0, 1, 1},
                       .shaft_speed = speed,
                       .angles = angles,
                       .rollers = angles + m->n_rollers};
  for (int j = 0; j < m->n_rollers; j++) angles[j] = trb_nominal_angle(m, j);
  trb_status status = trb_equilibrium_solve(run->system, &e, message);
  for (int j = 0; status == TRB_OK && j < m->n_rollers; j++) {
    double       *y = state + trb_state_roller(run->system, j);
    const double *at = e.rollers + (size_t)TRB_ROLLER_FREEDOMS * (size_t)j, tilt = at[2], skew = at[3];
    y[TRB_ROLLER_r] = at[0], y[TRB_ROLLER_z] = at[1], y[TRB_ROLLER_tilt] = tilt, y[TRB_ROLLER_skew] = skew;
    y[TRB_ROLLER_v_t] = orbit * at[0];
    y[TRB_ROLLER_omega_n] = -orbit * (sin(axis + tilt) - sin(axis));
    y[TRB_ROLLER_omega_t] = -orbit * sin(skew) * cos(axis + tilt);
    y[TRB_ROLLER_omega_a] = orbit * (cos(axis + tilt) * cos(skew) - cos(axis));
  }
  if (status == TRB_OK && trb_has_cage(m)) {
    double *cage = state + run->system->bodies[TRB_BODY_CAGE].first;
    cage[TRB_CAGE_x] = c->own[TRB_CASE_cage_x], cage[TRB_CAGE_y] = c->own[TRB_CASE_cage_y];
    /* away from the large ends by a tenth of the play, so that no end is pressed into its wall */
    cage[TRB_CAGE_z] = 0.1 * c->own[TRB_CASE_play_axial];
  }
  double row[TRB_MOTION_COLUMNS] = {0};
  row[1 + 2 * TRB_CHANNEL_displacement_x] = e.displacement[0];
  row[1 + 2 * TRB_CHANNEL_displacement_y] = e.displacement[1];
  row[1 + 2 * TRB_CHANNEL_displacement_z] = e.displacement[2];
  row[1 + 2 * TRB_CHANNEL_shaft_speed] = speed;
  row[1 + 2 * TRB_CHANNEL_gravity_y] = -c->own[TRB_CASE_gravity];
  free(angles);
  return status == TRB_OK ? trb_motion_create(row, 1, &run->motion, message) : status;
}

static trb_status open_run(const trb_case *c, const char *accuracy, trb_run *run, trb_message *message)
{
  trb_settings settings;
  trb_status   status = settings_of(accuracy, &settings, message);
  if (status == TRB_OK) status = make_system(c, run, message);
  if (status != TRB_OK) return status;
  const int n = trb_state_size(run->system);
  double   *state = calloc((size_t)n, sizeof *state);
  if (state == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory");
  status = start(c, run, state, message);
  const trb_system *const systems[TRB_MOST_MEMBERS] = {run->system};
  const trb_motion *const motions[TRB_MOST_MEMBERS] = {run->motion};
  if (status == TRB_OK) status = trb_simulation_create(systems, motions, 1, "bdf", "", &settings, 0.0, state, n, &run->simulation, message);
  free(state);
  if (status != TRB_OK) return status;
  run->row = calloc((size_t)trb_simulation_row(run->simulation), sizeof *run->row);
  return run->row == NULL ? trb_fail(message, TRB_ERR_MEMORY, "out of memory") : TRB_OK;
}

/* Steps until a time is passed, and records there. */
static trb_status record_at(trb_run *run, double time, trb_message *message)
{
  int              rows;
  long             steps;
  const trb_status status = trb_simulation_run(run->simulation, &time, 1, INFINITY, run->row, LONG_MAX, 0, &rows, &steps, message);
  if (status == TRB_OK) run->time = time;
  return status;
}

trb_run *trb_run_new(const trb_case *c, const char *accuracy, char *error)
{
  trb_message message = {TRB_OK, ""};
  trb_run    *run = calloc(1, sizeof *run);
  trb_status  status = run == NULL ? trb_fail(&message, TRB_ERR_MEMORY, "out of memory") : open_run(c, accuracy, run, &message);
  if (status == TRB_OK) status = record_at(run, 0.0, &message);
  if (status == TRB_OK) return run;
  trb_say(status, &message, error);
  trb_run_free(run);
  return NULL;
}

void trb_run_free(trb_run *run)
{
  if (run == NULL) return;
  free(run->row);
  if (run->simulation != NULL) trb_simulation_free(run->simulation);
  if (run->motion != NULL) trb_motion_free(run->motion);
  if (run->system != NULL) trb_system_free(run->system);
  if (run->model != NULL) trb_model_free(run->model);
  free(run);
}

int trb_run_step(trb_run *run, char *error)
{
  trb_message message = {TRB_OK, ""};
  trb_status  status = trb_simulation_step(run->simulation, &message);
  if (status == TRB_OK) status = record_at(run, run->simulation->integrator.time, &message);
  return trb_say(status, &message, error);
}

int trb_run_to(trb_run *run, double time, char *error)
{
  trb_message message = {TRB_OK, ""};
  trb_status  status;
  if (time >= run->time && isfinite(time)) status = record_at(run, time, &message);
  else status = trb_fail(&message, TRB_ERR_INPUT, "time = %.9g s: must be %.9g s or later", time, run->time);
  return trb_say(status, &message, error);
}

double trb_run_time(const trb_run *run) { return run->time; }

double trb_run_steps(const trb_run *run)
{
  trb_statistics statistics;
  run->simulation->integrator.kind->statistics(&run->simulation->integrator, &statistics);
  return statistics.steps;
}

int trb_run_describe(const trb_run *run, int i, trb_described *described)
{
  (void)run;
  if (i < 0 || i >= TRB_N_FIELDS) return 0;
  *described = (trb_described){trb_field_table[i].name, trb_field_table[i].unit, trb_field_table[i].text, 0.0, 0.0};
  return 1;
}

/* Number of a quantity; -1: there is none of this name. */
static int field_of(const char *name)
{
  for (int i = 0; i < TRB_N_FIELDS; i++)
    if (strcmp(trb_field_table[i].name, name) == 0) return i;
  return -1;
}

int trb_run_size(const trb_run *run, const char *name)
{
  const int field = field_of(name);
  return field < 0 ? 0 : trb_field_size(run->system, field);
}

int trb_run_read(trb_run *run, const char *name, double *values, int size, char *error)
{
  trb_message message = {TRB_OK, ""};
  const int   n = trb_run_size(run, name);
  if (n == 0) return trb_say(trb_fail(&message, TRB_ERR_INPUT, "%s: this bearing has no quantity of this name", name), &message, error);
  if (n > size) return trb_say(trb_fail(&message, TRB_ERR_INPUT, "%s has %d values, there is room for %d", name, n, size), &message, error);
  memcpy(values, run->row + trb_record_offset(run->system, field_of(name)), (size_t)n * sizeof *values);
  return TRB_OK;
}
