/* libFuzzer target: whatever numbers come in the parameter block, the faces, the motion, the settings and the state, the core either
 * refuses them with a message or works with them: no crash, no undefined behaviour, no endless loop. Built by `make fuzz`.
 *
 * The input is a list of changes to the 30310 rig, so that most of what is tried is nearly a bearing: two bytes for the place, one for
 * the kind of change, eight for a number. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "motion/equilibrium.h"
#include "motion/record.h"
#include "rig.h"

enum { CHANGE = 11, MOST_ROLLERS = 200, STEPS = 4 };

typedef struct trial {
  trb_params   params;
  trb_face     faces[RIG_FACES];
  double       deviation[MOST_ROLLERS];
  double       motion[2 * TRB_MOTION_COLUMNS];
  trb_settings settings;
  double       load[TRB_RING_FREEDOMS], fixed[TRB_RING_FREEDOMS], guess[TRB_RING_FREEDOMS], shaft_speed, explicit_method, settled,
      state_scale[64];
} trial;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static double changed(double was, int kind, double number)
{
  static const double special[] = {0.0, -0.0, 1.0,  -1.0,  1e-300, 1e300, INFINITY,     -INFINITY,
                                   NAN, 3.0,  12.0, 200.0, 201.0,  1e-9,  2147483648.0, 0.5};
  switch (kind % 6) {
  case 0: return number;
  case 1: return was * (1.0 + remainder(number, 1.0));
  case 2: return special[(unsigned)kind / 6 % 16];
  case 3: return was * exp(remainder(number, 5.0));
  case 4: return -was;
  default: return floor(fabs(remainder(number, 500.0)));
  }
}

static void set_up(trial *t, const uint8_t *data, size_t size)
{
  memset(t, 0, sizeof *t);
  t->params = size / 4 % 3 == 2 ? rig_cylinder() : rig_params(); /* one input in three has cylinders */
  t->params.bearing.n_rollers = 4;
  t->params.effects.n_slices = 3;
  rig_faces(&t->params, t->faces);
  t->settings = rig_settings();
  t->load[2] = -4930.0;
  t->fixed[3] = t->fixed[4] = 1.0;
  t->shaft_speed = 314.0;
  /* one input in four settles, one in four steps by the explicit method */
  t->settled = size % 4 == 1;
  t->explicit_method = size % 4 == 2;
  for (int i = 0; i < 2; i++) {
    double *row = t->motion + i * TRB_MOTION_COLUMNS;
    row[0] = i;
    row[1 + 2 * TRB_CHANNEL_displacement_z] = -40e-6;
    row[1 + 2 * TRB_CHANNEL_shaft_speed] = t->shaft_speed;
    row[1 + 2 * TRB_CHANNEL_gravity_y] = -9.8;
  }
  double *const all = (double *)t;
  for (; size >= CHANGE; data += CHANGE, size -= CHANGE) {
    const size_t place = ((size_t)data[0] << 8 | data[1]) % (sizeof *t / sizeof(double));
    double       number;
    memcpy(&number, data + 3, sizeof number);
    all[place] = changed(all[place], data[2], number);
  }
}

/* A few steps, a record, a look at the counters. */
static void step_on(const trb_system *system, const trial *t, const trb_motion *motion, const double *state)
{
  trb_message     message = {TRB_OK, ""};
  trb_simulation *s = NULL;
  trb_settings    settings = t->settings;
  if (rig_create(system, motion, t->explicit_method > 0.0 ? "erk" : "bdf", "", &settings, 0.0, state, &s, &message) != TRB_OK) return;
  double *record = malloc((size_t)trb_record_offset(system, TRB_N_FIELDS) * sizeof *record);
  if (record != NULL) {
    const double time = 1e-3;
    int          rows;
    long         steps;
    (void)trb_simulation_run(s, &time, 1, INFINITY, record, STEPS, t->explicit_method > 0.5, &rows, &steps, &message);
    free(record);
  }
  trb_simulation_free(s);
}

/* The equilibrium under any load and any guess. */
static void settle(const trb_system *system, const trial *t)
{
  const trb_model *m = system->model;
  const size_t     n = (size_t)m->n_rollers;
  trb_message      message = {TRB_OK, ""};
  trb_equilibrium  e = {.shaft_speed = t->shaft_speed};
  e.angles = calloc(n, sizeof *e.angles), e.rollers = calloc(TRB_ROLLER_FREEDOMS * n, sizeof *e.rollers);
  e.loads = calloc(TRB_EQUILIBRIUM_LOADS * n, sizeof *e.loads);
  for (int i = 0; i < TRB_RING_FREEDOMS; i++) {
    e.load[i] = t->load[i];
    e.fixed[i] = t->fixed[i] > 0.0;
    e.displacement[i] = t->guess[i];
  }
  if (e.angles != NULL && e.rollers != NULL && e.loads != NULL) {
    for (size_t j = 0; j < n; j++) e.angles[j] = 2.0 * TRB_PI * (double)j / (double)n;
    if (trb_equilibrium_solve(system, &e, &message) != TRB_OK && message.text[0] == '\0') __builtin_trap(); /* refused without a reason */
  }
  free(e.angles);
  free(e.rollers);
  free(e.loads);
}

static void try(const trb_system *system, const trial *t)
{
  const trb_model *m = system->model;
  const int        n = m->n_rollers;
  trb_message      message = {TRB_OK, ""};
  trb_motion      *motion = NULL;
  if (t->settled > 0.0) {
    settle(system, t);
    return;
  }
  double *state = calloc((size_t)trb_state_size(system), sizeof *state);
  if (state != NULL && trb_motion_create(t->motion, 2, &motion, &message) == TRB_OK) {
    for (int j = 0; j < n; j++) state[trb_state_roller(system, j) + TRB_ROLLER_v_t] = 130.0 * m->geometry.roller_centre_radius;
    for (int i = 0; i < 64; i++)
      if (t->state_scale[i] != 0.0) state[i * 7 % trb_state_size(system)] += t->state_scale[i];
    step_on(system, t, motion, state);
  }
  trb_motion_free(motion);
  free(state);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static trial t;
  trb_message  message = {TRB_OK, ""};
  trb_model   *m = NULL;
  trb_system  *system;
  set_up(&t, data, size);
  const int n =
      t.params.bearing.n_rollers >= 0.0 && t.params.bearing.n_rollers <= MOST_ROLLERS ? (int)t.params.bearing.n_rollers : MOST_ROLLERS;
  if (trb_model_create(&t.params, t.deviation, n, t.faces, RIG_FACES, &m, &message) != TRB_OK) {
    if (message.text[0] == '\0') __builtin_trap(); /* refused without a reason */
    return 0;
  }
  /* what takes long and shows nothing more */
  if (m->n_rollers <= 24 && m->n_nodes <= 24) {
    if (trb_system_tapered(m, &system, &message) == TRB_OK) {
      try(system, &t);
      trb_system_free(system);
    } else if (message.text[0] == '\0') {
      __builtin_trap(); /* as modes of a cage that are not given */
    }
  }
  trb_model_free(m);
  return 0;
}
