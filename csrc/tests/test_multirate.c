/* Steps of their own for each body: the formula and its polynomials, what is refused, convergence, and that nothing touches in a step of its own. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "rig.h"
#include "stepping/multirate.h"
#include "motion/fast_pairs.h"

enum { ROOM = 512 };
static const double speed = 100.0 * TRB_PI;
static trb_message  message;

/* y' = -y and the integral of y, with steps that change: errors fall with the square of the step. */
static double decay(double step)
{
  trb_course c = {.n = 2, .main = 1, .wait = 0};
  double     y[2] = {1.0, 0.0}, rates[2] = {-1.0, 1.0}, at[2];
  trb_course_begin(&c, 0.0, 1e-6, y, rates);
  for (int i = 0; c.now.end < 1.0; i++) {
    double p[3][TRB_COURSE_ROOM], e[TRB_COURSE_ROOM];
    trb_course_rescale(&c, fmin(i < 40 ? 1e-6 * pow(1.6, i) : (i / 7 % 2 ? 1.0 : 0.7) * step, step));
    trb_course_predict(&c, p);
    const double gamma = c.now.scale / trb_course_l1;
    e[0] = (-gamma * p[0][0] - p[1][0] / trb_course_l1) / (1.0 + gamma);
    e[1] = gamma * (p[0][0] + e[0]) - p[1][1] / trb_course_l1;
    trb_course_accept(&c, c.now.end + c.now.scale, p, e, 1);
  }
  trb_course_at(&c, 1.0, 2, at);
  CHECK_NEAR(at[1], 1.0 - exp(-1.0), 10.0 * step * step);
  return fabs(at[0] - exp(-1.0));
}

static void test_formula(void)
{
  const double coarse = decay(0.02), fine = decay(0.005);
  CHECK(coarse < 1e-3 && coarse / fine > 12.0 && coarse / fine < 20.0);
}

/* Values at earlier times, and a body that goes back: all of the polynomials of the steps. */
static void test_course(void)
{
  trb_course         c = {.n = 3, .main = 3, .wait = 0};
  unsigned long long seed = 3;
  double             y[3] = {1.0, -2.0, 0.5}, rates[3] = {10.0, 3.0, -4.0}, times[TRB_COURSE_KEPT + 8], last[3];
  trb_course_begin(&c, 5.0, 0.1, y, rates);
  for (int i = 0; i < TRB_COURSE_KEPT + 8; i++) {
    double p[3][TRB_COURSE_ROOM], e[TRB_COURSE_ROOM];
    trb_course_predict(&c, p);
    for (int k = 0; k < 3; k++) e[k] = 0.1 * rig_random(&seed);
    trb_course_accept(&c, c.now.end + c.now.scale, p, e, 1);
    trb_course_rescale(&c, 0.1 * (1.5 + rig_random(&seed)));
    times[i] = c.now.end;
  }
  const double end = c.now.end;
  CHECK(trb_course_lead(&c, end) == 0 && trb_course_lead(&c, times[TRB_COURSE_KEPT + 4]) == 3);
  const double to = times[TRB_COURSE_KEPT] + 0.01, beside = to - 0.02;
  double       before[3], after[3];
  trb_course_at(&c, to, 3, before);
  trb_course_at(&c, beside, 3, last);
  trb_course_back(&c, to, 0.3);
  trb_course_at(&c, to, 3, after);
  CHECK(c.now.end == to && c.now.scale == 0.3 && memcmp(before, after, sizeof before) == 0);
  trb_course_at(&c, fmax(beside, c.now.begin), 3, after);
  for (int q = 0; q < 3 && beside >= c.now.begin; q++) CHECK_NEAR(after[q], last[q], 1e-12);
}

typedef struct bench {
  trb_system     *system;
  trb_motion     *motion;
  trb_simulation *sim;
  double          start[ROOM];
} bench;

static trb_status open_with(bench *b, const trb_settings *settings, const char *kind)
{
  return rig_create(b->system, b->motion, kind, "scalar", settings, 0.0, b->start, &b->sim, &message);
}

static void make(bench *b, const trb_params *params)
{
  memset(b, 0, sizeof *b);
  b->system = rig_system(params);
  b->motion = rig_motion(rig_state(b->system, 4930.0, speed, b->start), speed);
}

static void drop(bench *b)
{
  trb_simulation_free(b->sim);
  trb_motion_free(b->motion);
  rig_free(b->system);
}

static void refused(const trb_params *params, const trb_settings *settings, const char *says)
{
  bench b;
  make(&b, params);
  message.text[0] = '\0';
  CHECK(open_with(&b, settings, "multirate") == TRB_ERR_INPUT && b.sim == NULL);
  CHECK_SAYS(message.text, says);
  CHECK_SAYS(message.text, "choose integrator = 'bdf'");
  drop(&b);
}

static void test_refused(void)
{
  trb_settings settings = rig_settings();
  trb_params   p = rig_params();
  settings.max_order = 5.0;
  refused(&p, &settings, "max_order is not 2");
  settings = rig_settings();
  p.cage.n_modes = 2.0;
  refused(&p, &settings, "the cage deforms");
  p = rig_params(), p.inner_ring.free = p.inner_ring.mass = p.inner_ring.inertia_axial = p.inner_ring.inertia_transverse = 1.0;
  refused(&p, &settings, "a ring moves freely");
}

/* A cage that is thrown against its rollers. */
static void throw(bench *b, double by)
{
  const int cage = rig_cage(b->system);
  b->start[cage + TRB_CAGE_v_x] += 0.7 * by;
  b->start[cage + TRB_CAGE_v_y] -= by;
  b->start[cage + TRB_CAGE_v_z] += 0.2 * by;
  b->start[cage + TRB_CAGE_omega_a] += 4.0 * by;
}

/* Largest difference of coordinates after a time from those of the explicit method, in standard tolerances. */
static double off_after(double time, double share, const double *exact, double *found)
{
  bench              b;
  trb_settings       settings = rig_settings();
  const trb_settings usual = rig_settings();
  const trb_params   p = rig_params();
  double             largest = 0.0;
  int                rows;
  long               steps;
  make(&b, &p);
  throw(&b, 0.02);
  settings.rtol *= share, settings.atol_position *= share, settings.atol_angle *= share, settings.atol_velocity *= share;
  settings.atol_spin *= share;
  if (!CHECK(open_with(&b, &settings, exact == NULL ? "erk" : "multirate") == TRB_OK)) return NAN;
  double *record = calloc((size_t)trb_simulation_row(b.sim), sizeof *record);
  CHECK(trb_simulation_run(b.sim, &time, 1, INFINITY, record, 10000000, 0, &rows, &steps, &message) == TRB_OK && rows == 1);
  CHECK(trb_simulation_state_at(b.sim, time, found, &message) == TRB_OK);
  for (int i = 0; exact != NULL && i < b.sim->integrator.n_main; i++) {
    static const double unit[TRB_N_TOLERANCES] = {1.0, 1.0, 1.0, 1.0, 1.0};
    const double        scale[TRB_N_TOLERANCES] = {usual.atol_position, usual.atol_angle, usual.atol_velocity, usual.atol_spin, unit[4]};
    largest = fmax(largest, fabs(found[i] - exact[i]) / scale[trb_state_tolerance(b.system, i)]);
  }
  free(record);
  drop(&b);
  return largest;
}

static void test_convergence(void)
{
  double       exact[ROOM], found[ROOM], off[3];
  const double time = 4e-4;
  (void)off_after(time, 1e-4, NULL, exact);
  for (int i = 0; i < 3; i++) off[i] = off_after(time, pow(10.0, -i), exact, found);
  printf("off the explicit method, in standard tolerances: %.3g %.3g %.3g\n", off[0], off[1], off[2]);
  CHECK(off[0] < 30.0 && off[1] < 0.6 * off[0] && off[2] < 0.6 * off[1]);
}

/* Least gap of a roller in its pocket at a state. */
static double gap_at(trb_dynamics *d, int j, const double *y)
{
  double least = INFINITY;
  for (int f = 0; f < d->n_fast; f++) {
    trb_load load;
    if (d->fast[f].surfaces[j] == 0) continue;
    const trb_gaps gaps = trb_fast_touch(d, f, j, y, &load, NULL, NULL);
    least = fmin(least, fmin(gaps.of[TRB_GAP_FLANK], gaps.of[TRB_GAP_ENDS]));
  }
  return least;
}

/* With tolerances so wide that steps are long beside impacts: no roller that steps by itself touches anything at the end of a step, and none is ahead
 * of the cage by more steps than are kept. Rollers join and leave. */
static void test_touch(void)
{
  enum { STEPS = 1500 };
  bench            b;
  trb_settings     settings = rig_settings();
  const trb_params p = rig_params();
  double           y[ROOM], least = INFINITY;
  long             alone = 0, joined = 0;
  make(&b, &p);
  throw(&b, 0.3);
  settings.rtol = 0.1, settings.atol_position = 1e-6, settings.atol_angle = 1e-4, settings.atol_velocity = 0.1, settings.atol_spin = 10.0;
  settings.impact_least = 1.0, settings.impact_share = 1e3;
  if (!CHECK(open_with(&b, &settings, "multirate") == TRB_OK)) return;
  trb_dynamics        *d = rig_dynamics(b.system, b.motion);
  const trb_multirate *s = b.sim->integrator.self;
  for (int i = 0; i < STEPS; i++) {
    int was[64];
    if (!CHECK(trb_simulation_step(b.sim, &message) == TRB_OK)) break;
    const double to = b.sim->integrator.time;
    /* those of the team left or joined after this step */
    for (int j = 0; j < s->n_rollers; j++) {
      was[j] = s->movers[j].course.now.end == to && s->movers[j].course.n_past == 0;
      joined += was[j];
      CHECK(trb_course_lead(&s->movers[j].course, to) <= TRB_COURSE_LEAD + 1);
      CHECK(s->movers[j].course.now.end >= to);
    }
    CHECK(trb_simulation_state_at(b.sim, to, y, NULL) == TRB_OK);
    trb_dynamics_pose(d, to, y);
    for (int j = 0; j < s->n_rollers; j++) {
      if (was[j]) continue;
      least = fmin(least, gap_at(d, j, y));
      alone++;
    }
  }
  printf("%ld looks at rollers by themselves, least gap %.3g um; %ld steps of rollers with the cage\n", alone, 1e6 * least, joined);
  CHECK(least > 0.0 && alone > 1500 && joined > 500);
  trb_dynamics_free(d);
  drop(&b);
}

/* Rollers that vibrate while the cage flies: they need far more steps than it, and none is ahead by more than is kept, so that the state at the begin of
 * the last step can still be had. */
static void test_lead(void)
{
  bench              b;
  const trb_settings settings = rig_settings();
  const trb_params   p = rig_params();
  double             before[ROOM], y[ROOM];
  int                most = 0;
  make(&b, &p);
  for (int j = 0; j < p.bearing.n_rollers; j += 2) b.start[trb_state_roller(b.system, j) + TRB_ROLLER_v_r] += 0.02;
  if (!CHECK(open_with(&b, &settings, "multirate") == TRB_OK)) return;
  const trb_multirate *s = b.sim->integrator.self;
  for (int i = 0; i < 400; i++) {
    const double from = b.sim->integrator.time;
    memcpy(before, b.sim->integrator.y, (size_t)b.sim->integrator.n * sizeof *before);
    if (!CHECK(trb_simulation_step(b.sim, &message) == TRB_OK)) break;
    CHECK(trb_simulation_state_at(b.sim, from, y, &message) == TRB_OK);
    for (int k = 0; k < b.sim->integrator.n_main; k++) CHECK_NEAR(y[k], before[k], 1e-12 + 1e-9 * fabs(before[k]));
    for (int j = 0; j < s->n_rollers; j++) {
      const int ahead = trb_course_lead(&s->movers[j].course, from);
      most = ahead > most ? ahead : most;
    }
  }
  printf("rollers took up to %d steps in one of the cage\n", most);
  CHECK(most >= TRB_COURSE_LEAD && most <= 2 * TRB_COURSE_LEAD);
  drop(&b);
}

/* A history whose speed has a kink: the steps of every body end there. */
static void test_stops(void)
{
  enum { KNOTS = 3 };
  static const double kink = 3.1e-4, end = 7e-4;
  double              table[KNOTS * TRB_MOTION_COLUMNS] = {0};
  bench               b;
  const trb_params    p = rig_params();
  trb_settings        settings = rig_settings();
  int                 met = 0, bodies = 0;
  make(&b, &p);
  const double place = rig_state(b.system, 4930.0, speed, b.start);
  for (int k = 0; k < KNOTS; k++) {
    double *row = table + k * TRB_MOTION_COLUMNS;
    row[0] = k == 0 ? 0.0 : k == 1 ? kink : end;
    row[1 + 2 * TRB_CHANNEL_displacement_z] = place;
    row[1 + 2 * TRB_CHANNEL_shaft_speed] = speed * (k == 2 ? 1.02 : 1.0);
  }
  trb_motion_free(b.motion);
  if (!CHECK(trb_motion_create(table, KNOTS, &b.motion, &message) == TRB_OK)) return;
  if (!CHECK(open_with(&b, &settings, "multirate") == TRB_OK)) return;
  const trb_multirate *s = b.sim->integrator.self;
  double               seen[64] = {0};
  while (b.sim->integrator.time < end) {
    if (!CHECK(trb_simulation_step(b.sim, &message) == TRB_OK)) break;
    for (int j = 0; j <= s->n_rollers; j++) {
      const trb_course *c = &s->movers[j].course;
      for (int back = 0; back <= (c->n_past < TRB_COURSE_KEPT ? c->n_past : TRB_COURSE_KEPT); back++) {
        const trb_course_step *step = back == 0 ? &c->now : &c->past[(c->n_past - back) % TRB_COURSE_KEPT];
        CHECK(!(step->begin < kink && step->end > kink));
        seen[j] = seen[j] != 0.0 || step->end == kink;
      }
    }
    met |= b.sim->integrator.time == kink;
  }
  for (int j = 0; j <= s->n_rollers; j++) bodies += seen[j] != 0.0;
  CHECK(met && bodies == s->n_rollers + 1);
  drop(&b);
}

/* A step that cannot be had is an error that says whose it is, after a number of tries that is bounded; the state is that before. */
static void test_failed(void)
{
  bench            b;
  trb_settings     settings = rig_settings();
  const trb_params p = rig_params();
  for (int of_cage = 0; of_cage < 2; of_cage++) {
    make(&b, &p);
    settings.first_step = 1e-4, settings.smallest_step = 1e-6;
    settings.rtol = 1e-12, settings.atol_velocity = 1e-14, settings.atol_spin = 1e-12, settings.atol_position = 1e-16,
    settings.atol_angle = 1e-14;
    b.start[(of_cage ? rig_cage(b.system) + TRB_CAGE_v_x : trb_state_roller(b.system, 3) + TRB_ROLLER_v_r)] += 1.0;
    if (!CHECK(open_with(&b, &settings, "multirate") == TRB_OK)) return;
    CHECK(trb_simulation_step(b.sim, &message) == TRB_ERR_STEP);
    CHECK_SAYS(message.text, "fell to");
    CHECK_SAYS(message.text, "largest error:");
    CHECK(b.sim->integrator.time == 0.0 && memcmp(b.sim->integrator.y, b.start, (size_t)b.sim->integrator.n * sizeof(double)) == 0);
    trb_statistics found;
    b.sim->integrator.kind->statistics(&b.sim->integrator, &found);
    CHECK(found.rhs_evaluations < 20000.0);
    drop(&b);
  }
}

/* In smooth rolling bodies take fewer steps than if all took those of the cage. */
static void test_effort(void)
{
  bench            b;
  trb_statistics   found;
  trb_settings     settings = rig_settings();
  const trb_params p = rig_params();
  make(&b, &p);
  throw(&b, 0.05);
  if (!CHECK(open_with(&b, &settings, "multirate") == TRB_OK)) return;
  for (int i = 0; i < 1500; i++) CHECK(trb_simulation_step(b.sim, &message) == TRB_OK);
  b.sim->integrator.kind->statistics(&b.sim->integrator, &found);
  printf("%g steps, %g of bodies\n", found.steps, found.body_steps);
  CHECK(found.steps == 1500.0 && found.body_steps < 0.7 * found.steps * (p.bearing.n_rollers + 1));
  CHECK(found.last_order == 2.0 && found.smallest_step > 0.0);
  drop(&b);
}

int main(void)
{
  test_formula();
  test_course();
  test_refused();
  test_convergence();
  test_touch();
  test_lead();
  test_stops();
  test_failed();
  test_effort();
  return check_report();
}
