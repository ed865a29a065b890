/* Every allocation of the core fails once: creation ends with a clean error and leaks nothing. The core that is linked here calls these
 * allocators in place of the system's; the solver library keeps the latter. */
#include <stdlib.h>

#include "check.h"
#include "motion/equilibrium.h"
#include "rig.h"

void *trb_test_malloc(size_t size);
void *trb_test_calloc(size_t n, size_t size);
void *trb_test_aligned_alloc(size_t alignment, size_t size);
void  trb_test_free(void *block);

static long live;      /* blocks that the core holds */
static long countdown; /* allocations until one fails; negative: none does */

static int fails(void) { return countdown >= 0 && countdown-- == 0; }

static void *kept(void *block)
{
  live += block != NULL;
  return block;
}

void *trb_test_malloc(size_t size) { return fails() ? NULL : kept(malloc(size)); }
void *trb_test_calloc(size_t n, size_t size) { return fails() ? NULL : kept(calloc(n, size)); }
void *trb_test_aligned_alloc(size_t alignment, size_t size) { return fails() ? NULL : kept(aligned_alloc(alignment, size)); }

void trb_test_free(void *block)
{
  live -= block != NULL;
  free(block);
}

static trb_params  params;
static trb_system *built;
static trb_face    faces[RIG_FACES];
static double     *modes;
static int         mode_columns;
static double      state[512];
static double      table[TRB_MOTION_COLUMNS];

/* Creates, frees what came of it, and gives the status. */
typedef trb_status attempt(trb_message *message);

static trb_status make_model(trb_message *message)
{
  const double deviation[12] = {0};
  trb_model   *made = NULL;
  trb_status   status = trb_model_create(&params, deviation, 12, faces, RIG_FACES, &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  if (status == TRB_OK) status = trb_model_set_modes(made, modes, (int)params.cage.n_modes, mode_columns, message);
  trb_model_free(made);
  return status;
}

static trb_status make_motion(trb_message *message)
{
  trb_motion      *made = NULL;
  const trb_status status = trb_motion_create(table, 1, &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  trb_motion_free(made);
  return status;
}

static trb_status make_system(trb_message *message)
{
  trb_system      *made = NULL;
  const trb_status status = trb_system_tapered(built->model, &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  trb_system_free(made);
  return status;
}

static trb_status make_dynamics(trb_message *message)
{
  trb_dynamics    *made = NULL;
  const trb_status status = trb_dynamics_create(built, NULL, "", &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  trb_dynamics_free(made);
  return status;
}

static trb_status make_detail(trb_message *message)
{
  trb_detail      *made = NULL;
  const trb_status status = trb_detail_create(built->model, built->pairs, built->n_pairs, &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  trb_detail_free(made);
  return status;
}

static trb_status make_peaks(trb_message *message)
{
  trb_motion *motion = NULL;
  trb_peaks  *made = NULL;
  trb_status  status = trb_motion_create(table, 1, &motion, message);
  if (status != TRB_OK) return status;
  status = trb_peaks_create(built, motion, "", &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  trb_peaks_free(made);
  trb_motion_free(motion);
  return status;
}

static trb_status solve_equilibrium(trb_message *message)
{
  double          angles[12], rollers[12 * TRB_ROLLER_FREEDOMS] = {0}, loads[12 * TRB_EQUILIBRIUM_LOADS];
  trb_equilibrium e = {.load = {0, 0, -4930, 0, 0}, .fixed = {0, 0, 0, 1, 1}, .angles = angles, .rollers = rollers, .loads = loads};
  for (int j = 0; j < 12; j++) angles[j] = trb_nominal_angle(built->model, j);
  return trb_equilibrium_solve(built, &e, message);
}

static trb_status make_simulation(const char *kind, trb_message *message)
{
  const trb_settings settings = rig_settings();
  trb_motion        *motion = NULL;
  trb_simulation    *made = NULL;
  trb_status         status = trb_motion_create(table, 1, &motion, message);
  if (status != TRB_OK) return status;
  status = rig_create(built, motion, kind, "", &settings, 0.0, state, &made, message);
  CHECK((made == NULL) == (status != TRB_OK));
  trb_simulation_free(made);
  trb_motion_free(motion);
  return status;
}

static trb_status make_bdf(trb_message *message) { return make_simulation("bdf", message); }
static trb_status make_erk(trb_message *message) { return make_simulation("erk", message); }
static trb_status make_multirate(trb_message *message) { return make_simulation("multirate", message); }

static void fail_each(const char *name, attempt *make)
{
  for (long n = 0; n < 2000; n++) {
    trb_message message = {TRB_OK, ""};
    const long  before = live;
    countdown = n;
    const trb_status status = make(&message);
    const int        hit = countdown < 0;
    countdown = -1;
    if (!CHECK(live == before)) printf("  %s: allocation %ld leaks %ld blocks\n", name, n, live - before);
    if (!hit) {
      CHECK(status == TRB_OK && n > 0);
      printf("%-12s %ld allocations\n", name, n);
      return;
    }
    if (!CHECK(status == TRB_ERR_MEMORY && message.status == status))
      printf("  %s: allocation %ld fails, status %d\n", name, n, (int)status);
    CHECK_SAYS(message.text, "out of memory");
  }
  CHECK(0 && "more allocations than expected");
}

/* While stepping: a step goes on or fails cleanly, and nothing leaks; afterwards the simulation still steps. The first step is left
 * out: there SUNDIALS clones the matrix, and writes into what it got without a look (SUNMatClone). */
static void fail_in_steps(void)
{
  const trb_settings settings = rig_settings();
  trb_motion        *motion = NULL;
  int                hit = 1;
  if (!CHECK(trb_motion_create(table, 1, &motion, NULL) == TRB_OK)) return;
  for (long n = 0; hit && n < 50; n++) {
    trb_message     message = {TRB_OK, ""};
    trb_simulation *s = NULL;
    if (!CHECK(rig_create(built, motion, "bdf", "", &settings, 0.0, state, &s, NULL) == TRB_OK)) return;
    CHECK(trb_simulation_step(s, &message) == TRB_OK && trb_simulation_set_state(s, 0.0, state, &message) == TRB_OK);
    const long before = live;
    countdown = n;
    for (int i = 0; i < 20; i++) {
      const double     time = s->integrator.time;
      const trb_status status = trb_simulation_step(s, &message);
      CHECK(status == TRB_OK ? s->integrator.time > time : s->integrator.time == time && message.text[0] != '\0');
    }
    hit = countdown < 0;
    countdown = -1;
    CHECK(live == before);
    CHECK(trb_simulation_set_state(s, 0.0, state, &message) == TRB_OK && trb_simulation_step(s, &message) == TRB_OK);
    trb_simulation_free(s);
  }
  CHECK(!hit);
  trb_motion_free(motion);
}

int main(void)
{
  countdown = -1;
  params = rig_params();
  params.cage.n_modes = 2;
  rig_faces(&params, faces);
  built = rig_system(&params);
  modes = rig_modes(built->model, &mode_columns);
  table[1 + 2 * TRB_CHANNEL_displacement_z] = rig_state(built, 4930.0, 314.0, state);
  table[1 + 2 * TRB_CHANNEL_shaft_speed] = 314.0;
  fail_each("model", make_model);
  fail_each("system", make_system);
  fail_each("motion", make_motion);
  fail_each("dynamics", make_dynamics);
  fail_each("detail", make_detail);
  fail_each("peaks", make_peaks);
  fail_each("equilibrium", solve_equilibrium);
  fail_each("bdf", make_bdf);
  fail_each("erk", make_erk);
  fail_in_steps();
  free(modes);
  rig_free(built);
  params.cage.n_modes = 0;
  built = rig_system(&params);
  (void)rig_state(built, 4930.0, 314.0, state);
  fail_each("multirate", make_multirate);
  rig_free(built);
  return check_report();
}
