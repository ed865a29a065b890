/* A simulation: what it refuses, that output times change nothing, that a failed step leaves the last good state. */
#include "stepping/simulation.h"

#include <stdlib.h>

#include "check.h"
#include "motion/fast_pairs.h"
#include "rig.h"

static trb_system      *built;
static const trb_model *m;
static trb_motion      *motion;
static double           start[512];
static trb_message      message;

static trb_status create(const char *kind, const char *variant, const trb_settings *settings, double time, const double *state,
                         trb_simulation **s)
{
  message = (trb_message){TRB_OK, ""};
  const trb_status status = rig_create(built, motion, kind, variant, settings, time, state, s, &message);
  CHECK((status == TRB_OK) == (*s != NULL));
  return status;
}

static void refused(const char *kind, const char *variant, const trb_settings *settings, double time, const double *state,
                    trb_status expected, const char *says)
{
  trb_simulation *s;
  CHECK(create(kind, variant, settings, time, state, &s) == expected);
  CHECK_SAYS(message.text, says);
}

static void test_bad_input(void)
{
  trb_settings settings = rig_settings();
  double       state[512];
  for (int i = 0; i < TRB_N_SETTINGS; i++) {
    const trb_setting_info *info = &trb_setting_table[i];
    const double            wrong[] = {NAN, info->lower - 1e-20 - fabs(info->lower), 1.01 * info->upper + 1.0};
    CHECK(info->standard >= info->lower && info->standard <= info->upper);
    for (int k = 0; k < 3; k++) {
      settings = rig_settings();
      ((double *)&settings)[i] = wrong[k];
      refused("bdf", "", &settings, 0.0, start, TRB_ERR_INPUT, info->name);
    }
  }
  settings = rig_settings();
  refused("euler", "", &settings, 0.0, start, TRB_ERR_INPUT, "integrator = 'euler': must be 'auto', 'multirate', 'bdf' or 'erk'");
  refused("bdf", "sse", &settings, 0.0, start, TRB_ERR_INPUT, "instruction_set = 'sse'");
  refused("bdf", "", &settings, NAN, start, TRB_ERR_STATE, "time");
  for (int i = 0; i < trb_state_size(built); i += 13) {
    memcpy(state, start, sizeof state);
    state[i] = NAN;
    refused("bdf", "", &settings, 0.0, state, TRB_ERR_STATE, "must be finite");
  }
  memcpy(state, start, sizeof state);
  state[trb_state_roller(built, 4) + TRB_ROLLER_v_t] = INFINITY;
  refused("bdf", "", &settings, 0.0, state, TRB_ERR_STATE, "roller 4, v_t (tangential velocity");
  memcpy(state, start, sizeof state);
  state[rig_cage(built) + TRB_CAGE_z] = NAN;
  refused("bdf", "", &settings, 0.0, state, TRB_ERR_STATE, "cage, z (axial position");
  memcpy(state, start, sizeof state);
  state[trb_state_roller(built, 2) + TRB_ROLLER_r] = -1.0;
  refused("bdf", "", &settings, 0.0, state, TRB_ERR_STATE, "roller 2: r = -1 m");
  memcpy(state, start, sizeof state);
  state[rig_cage(built) + TRB_CAGE_skew] = 1.6;
  refused("bdf", "", &settings, 0.0, state, TRB_ERR_STATE, "cage: skew = 1.6 rad");
}

/* The same steps whether a record is wanted at every microsecond or at the end alone; two integrators agree. */
static void test_outputs(const char *kind, double *end)
{
  const trb_settings settings = rig_settings();
  const int          length = trb_record_offset(built, TRB_N_FIELDS), n = trb_state_size(built);
  enum { TIMES = 101 };
  double          times[TIMES], last = 1e-4;
  trb_simulation *often, *once;
  int             rows;
  long            steps, steps_once;
  if (!CHECK(create(kind, "scalar", &settings, 0.0, start, &often) == TRB_OK &&
             create(kind, "scalar", &settings, 0.0, start, &once) == TRB_OK))
    return;
  double *records = calloc((size_t)length * TIMES, sizeof *records);
  for (int i = 0; i < TIMES; i++) times[i] = 1e-6 * i;
  times[TIMES - 1] = last;
  CHECK(trb_simulation_run(often, times, TIMES, INFINITY, records, 1000000, 0, &rows, &steps, &message) == TRB_OK && rows == TIMES);
  for (int i = 0; i < TIMES; i++)
    CHECK(records[(size_t)i * (size_t)length + (size_t)trb_record_offset(built, TRB_FIELD_AT_time)] == times[i]);
  CHECK(trb_simulation_run(once, &last, 1, INFINITY, records, 1000000, 0, &rows, &steps_once, &message) == TRB_OK && rows == 1);
  CHECK(steps == steps_once && often->integrator.time == once->integrator.time);
  CHECK(memcmp(often->integrator.y, once->integrator.y, (size_t)n * sizeof(double)) == 0);
  CHECK(trb_simulation_run(once, times, 1, INFINITY, records, 10, 0, &rows, &steps, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "lies before the last step");
  CHECK(trb_simulation_run(once, (double[]){1.0}, 1, INFINITY, records, 3, 0, &rows, &steps, &message) == TRB_OK && rows == 0 &&
        steps == 3);
  memcpy(end, often->integrator.y, (size_t)n * sizeof(double));
  trb_simulation_free(often);
  trb_simulation_free(once);
  free(records);
}

/* Rows of records and peaks, filled by the thread that steps or beside it, in calls of a few steps each. */
static double *rows_of(int beside, int with_peaks, const double *times, int n, long at_once, double *end)
{
  const trb_settings settings = rig_settings();
  trb_simulation    *s;
  if (!CHECK(create("bdf", "scalar", &settings, 0.0, start, &s) == TRB_OK)) return NULL;
  if (with_peaks) CHECK(trb_simulation_begin_peaks(s, 0.0, &message) == TRB_OK);
  const size_t length = (size_t)trb_simulation_row(s);
  double      *records = calloc(length * (size_t)n, sizeof *records);
  int          done = 0, rows;
  long         steps;
  while (records != NULL && done < n) {
    if (!CHECK(trb_simulation_run(s, times + done, n - done, INFINITY, records + (size_t)done * length, at_once, beside, &rows, &steps,
                                  &message) == TRB_OK))
      break;
    done += rows;
  }
  CHECK(s->recorder == NULL);
  memcpy(end, s->integrator.y, (size_t)trb_state_size(built) * sizeof *end);
  trb_simulation_free(s);
  return records;
}

/* A second thread changes no bit, neither of records and peaks nor of the steps; nor does what is proven not to touch. */
static void test_beside(void)
{
  enum { TIMES = 300 };
  double times[TIMES], ends[2][512];
  for (int i = 0; i < TIMES; i++) times[i] = 3e-6 * (i + 1);
  for (int with_peaks = 0; with_peaks < 2; with_peaks++) {
    const size_t length =
        (size_t)trb_record_offset(built, TRB_N_FIELDS) + (with_peaks ? (size_t)trb_peak_offset(built, TRB_N_PEAK_FIELDS) : 0);
    double *here = rows_of(0, with_peaks, times, TIMES, 7, ends[0]), *there = rows_of(1, with_peaks, times, TIMES, 1000, ends[1]);
    if (here != NULL && there != NULL) {
      CHECK(memcmp(here, there, length * TIMES * sizeof *here) == 0);
      CHECK(memcmp(ends[0], ends[1], (size_t)trb_state_size(built) * sizeof(double)) == 0);
    }
    free(here);
    free(there);
  }
}

/* Iterations of Newton's method for one step of the same length. */
static double iterations_of(double newton_share)
{
  trb_settings    settings = rig_settings();
  trb_statistics  found = {0};
  trb_simulation *s;
  settings.newton_share = newton_share;
  if (!CHECK(create("bdf", "scalar", &settings, 0.0, start, &s) == TRB_OK)) return 0.0;
  for (int i = 0; i < 200; i++) CHECK(trb_simulation_step(s, &message) == TRB_OK);
  s->integrator.kind->statistics(&s->integrator, &found);
  trb_simulation_free(s);
  return found.nonlinear_iterations / found.steps;
}

/* The equations of a step hold to the share that is asked for: a smaller one takes more iterations. */
static void test_newton_share(void)
{
  const double usual = iterations_of(0.1), finer = iterations_of(1e-4);
  CHECK(usual >= 1.0 && finer > 1.2 * usual);
}

/* A smallest step that cannot be kept: an error that names time and body, and the state before. */
static void test_failed_step(void)
{
  trb_settings    settings = rig_settings();
  trb_simulation *s;
  double          state[512], before[512];
  memcpy(state, start, sizeof state);
  settings.smallest_step = 1e-6, settings.max_step = 1e-3, settings.rtol = 1e-12, settings.atol_velocity = 1e-14,
  settings.atol_spin = 1e-12;
  settings.atol_position = 1e-16, settings.atol_angle = 1e-14;
  state[trb_state_roller(built, 3) + TRB_ROLLER_v_r] = 5.0;
  if (!CHECK(create("bdf", "", &settings, 0.25, state, &s) == TRB_OK)) return;
  memcpy(before, s->integrator.y, sizeof(double) * (size_t)trb_state_size(built));
  CHECK(trb_simulation_step(s, &message) == TRB_ERR_STEP);
  CHECK_SAYS(message.text, "at t = 0.25 s");
  CHECK_SAYS(message.text, "largest error:");
  CHECK(s->integrator.time == 0.25);
  CHECK(memcmp(before, s->integrator.y, sizeof(double) * (size_t)trb_state_size(built)) == 0);
  /* a state that is refused changes nothing either */
  state[5] = NAN;
  CHECK(trb_simulation_set_state(s, 0.5, state, &message) == TRB_ERR_STATE);
  CHECK(s->integrator.time == 0.25 && memcmp(before, s->integrator.y, sizeof(double) * (size_t)trb_state_size(built)) == 0);
  CHECK(trb_simulation_set_state(s, 0.5, start, &message) == TRB_OK && s->integrator.time == 0.5);
  trb_simulation_free(s);
  trb_simulation_free(NULL);
}

/* A simulation that is set to a state goes on as a new one that begins there: nothing of the states before is left. share: of the
 * disturbance of the start; whatever impacts, tangents or Jacobians might remember shows with one of them. */
static void test_set_state(const char *kind, double share)
{
  enum { STEPS = 1000 };
  trb_settings       settings = rig_settings();
  const int          n = trb_state_size(built);
  const size_t       length = sizeof(double) * (size_t)n;
  trb_simulation    *s, *begun;
  double             state[512];
  unsigned long long seed = 7;
  settings.first_step = 1e-5;
  memcpy(state, start, length);
  rig_disturb(built, &seed, state);
  for (int i = 0; i < n; i++) state[i] = start[i] + share * (state[i] - start[i]);
  if (!CHECK(create(kind, "", &settings, 1.0, state, &s) == TRB_OK)) return;
  for (int i = 0; i < STEPS; i++) CHECK(trb_simulation_step(s, NULL) == TRB_OK);
  const double time = s->integrator.time;
  memcpy(state, s->integrator.y, length);
  CHECK(trb_simulation_set_state(s, time, state, NULL) == TRB_OK);
  if (!CHECK(create(kind, "", &settings, time, state, &begun) == TRB_OK)) return;
  int same = 1;
  for (int i = 0; i < STEPS && same; i++) {
    CHECK(trb_simulation_step(s, NULL) == TRB_OK && trb_simulation_step(begun, NULL) == TRB_OK);
    same = memcmp(s->integrator.y, begun->integrator.y, length) == 0 && s->integrator.time == begun->integrator.time;
  }
  CHECK(same);
  trb_simulation_free(begun);
  trb_simulation_free(s);
}

/* A factor makes the tolerances of one body smaller, those of a roller or those of the cage, and of no other entry. */
static void test_weights(void)
{
  const trb_settings settings = rig_settings();
  trb_simulation    *s;
  double             usual[512], now[512];
  const int          rollers = m->n_rollers;
  if (!CHECK(create("bdf", "scalar", &settings, 0.0, start, &s) == TRB_OK)) return;
  trb_integrator *it = &s->integrator;
  for (int i = 0; i < rollers + TRB_MOST_BODIES; i++) it->members[0].impacts.factor[i] = 1.0;
  trb_integrator_weights(it, start, usual);
  for (int body = 0; body <= rollers; body++) {
    const int     from = trb_state_roller(built, body), to = body < rollers ? trb_state_roller(built, body + 1) : it->n_main;
    double *const factor = &it->members[0].impacts.factor[body < rollers ? body : rollers + TRB_BODY_CAGE];
    *factor = 0.25;
    trb_integrator_weights(it, start, now);
    for (int i = 0; i < it->n; i++) CHECK(now[i] == (i >= from && i < to ? 4.0 : 1.0) * usual[i]);
    *factor = 1.0;
  }
  trb_simulation_free(s);
}

/* Interference that an impact of a roller makes, over its speed: that of both masses on one spring, whatever the spring is. */
static double rise_with(double cage_mass)
{
  const trb_impact_measure measure = {.share = 1.0, .least = 0.0, .velocity = 1e-30, .position = 1.0};
  trb_params               p = rig_params();
  trb_message              unused;
  double                   y[512], speed, factor;
  p.cage.mass = cage_mass;
  trb_system   *system = rig_system(&p);
  trb_motion   *turning = rig_motion(rig_state(system, 4930.0, 100.0, y), 100.0);
  trb_dynamics *d;
  trb_impacts   impacts;
  y[rig_cage(system) + TRB_CAGE_v_x] += 0.3;
  if (!CHECK(trb_dynamics_create(system, turning, "scalar", &d, &unused) == TRB_OK)) return NAN;
  trb_dynamics_pose(d, 0.0, y);
  CHECK(trb_impacts_create(system->model, &impacts, &unused) == TRB_OK);
  trb_impacts_look(&impacts, d, turning, 0.0, y, 1.0, &measure, d->everyone, system->model->n_rollers);
  speed = impacts.speed[0], factor = impacts.factor[0];
  CHECK(speed > 0.1 && factor > 0.0 && factor < 1.0);
  trb_memory_free(&impacts.memory);
  trb_dynamics_free(d);
  trb_motion_free(turning);
  rig_free(system);
  return factor / speed;
}

static void test_impacts(void)
{
  const double roller = m->geometry.roller_mass, heavy = rise_with(10.0);
  const double masses[] = {1e-3, 0.03, 0.2, 2.0};
  for (int i = 0; i < 4; i++) {
    const double reduced = roller * masses[i] / (roller + masses[i]), of_heavy = roller * 10.0 / (roller + 10.0);
    CHECK_NEAR(rise_with(masses[i]) / heavy, sqrt(reduced / of_heavy), 1e-9);
  }
  CHECK(heavy > 1e-6 && heavy < 1e-3); /* some 10 us to the largest interference */
}

/* Speed of a roller's centre against the point of the cage that is there, from their poses in R. */
static double closing_at(const trb_dynamics *d, int j)
{
  const trb_roller_pose *r = &d->rollers[j];
  const trb_rigid_pose  *cage = &d->bodies[TRB_BODY_CAGE].pose;
  const trb_vec3         arm = trb_sub(trb_turn_z(r->x, r->cosine, r->sine), cage->x);
  return trb_norm(trb_sub(trb_turn_z(r->v, r->cosine, r->sine), trb_add(cage->v, trb_cross(cage->omega, arm))));
}

/* A roller counts as far from its pocket where the gap lasts for three steps at its true speed, not at a bound of it. */
static void test_far(void)
{
  const trb_impact_measure measure = {.share = 1e-9, .least = 1e-6, .velocity = 1.0, .position = 1.0};
  const trb_params         p = rig_params();
  unsigned long long       seed = 11;
  int                      seen = 0;
  for (int i = 0; i < 20; i++) {
    double        y[512], rates[512];
    trb_impacts   impacts;
    trb_dynamics *d;
    trb_message   unused;
    trb_system   *system = rig_system(&p);
    trb_motion   *turning = rig_motion(rig_state(system, 4930.0, 100.0, y), 100.0);
    rig_disturb(system, &seed, y);
    for (int k = 0; k < 3; k++) y[rig_cage(system) + TRB_CAGE_v_x + k] += 0.2 * rig_random(&seed);
    if (!CHECK(trb_dynamics_create(system, turning, "scalar", &d, &unused) == TRB_OK)) return;
    CHECK(trb_impacts_create(system->model, &impacts, &unused) == TRB_OK);
    trb_rhs(d, NULL, 0.0, y, rates);
    trb_dynamics_pose(d, 0.0, y);
    for (int j = 0; j < system->model->n_rollers; j++) {
      const double left = trb_fast_gap_left(d, 0, j, y), closing = closing_at(d, j), until = left / (3.0 * closing);
      if (!(left > 0.0)) continue;
      trb_impacts_look(&impacts, d, turning, 0.0, y, until * 0.999999, &measure, d->everyone, system->model->n_rollers);
      CHECK(impacts.factor[j] == 1.0 && impacts.speed[j] == (double)INFINITY);
      trb_impacts_look(&impacts, d, turning, 0.0, y, until * 1.000001, &measure, d->everyone, system->model->n_rollers);
      CHECK(impacts.factor[j] < 1.0);
      CHECK_NEAR(impacts.speed[j], closing, 1e-9 * closing);
      seen++;
    }
    trb_memory_free(&impacts.memory);
    trb_dynamics_free(d);
    trb_motion_free(turning);
    rig_free(system);
  }
  CHECK(seen > 50);
}

int main(void)
{
  const trb_params p = rig_params();
  const double     speed = 100 * TRB_PI;
  double           bdf[512], erk[512], multirate[512];
  built = rig_system(&p);
  m = built->model;
  motion = rig_motion(rig_state(built, 4930.0, speed, start), speed);
  test_bad_input();
  test_outputs("bdf", bdf);
  test_outputs("erk", erk);
  test_outputs("multirate", multirate);
  test_newton_share();
  test_weights();
  test_impacts();
  test_far();
  test_beside();
  test_failed_step();
  for (int i = 0; i < 6; i++) test_set_state("bdf", pow(10.0, -i));
  test_set_state("erk", 1.0);
  for (int i = 0; i < 3; i++) test_set_state("multirate", pow(10.0, -i));
  trb_motion_free(motion);
  rig_free(built);
  return check_report();
}
