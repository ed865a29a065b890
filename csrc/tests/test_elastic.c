/* The elastic cage: contacts, energies, bounds of gaps and the Jacobian know how it is deformed. */
#include <stdlib.h>
#include <string.h>

#include "body/elastic_cage.h"
#include "check.h"
#include "contact/kernels.h"
#include "motion/fast_pairs.h"
#include "rig.h"
#include "stepping/jacobian.h"

enum { ROOM = RIG_ROOM };

static unsigned long long seed = 77;

static trb_params params_of(int n)
{
  trb_params p = rig_params();
  p.cage.n_modes = n;
  return p;
}

static int mode_at(const trb_system *system, int mode) { return rig_cage(system) + TRB_CAGE_SIZE + 2 * mode; }

/* Amplitudes of micrometres and their rates, on top of a disturbed state in which pockets touch. */
static void disturb(const trb_system *system, double amplitude, double *y)
{
  rig_disturb(system, &seed, y);
  for (int i = 0; i < system->model->modes.n; i++) {
    y[mode_at(system, i)] += 1e4 * amplitude * rig_random(&seed);
    y[mode_at(system, i) + 1] += 1e4 * amplitude * rig_random(&seed);
  }
}

static void test_refused(void)
{
  trb_params  p = params_of(2);
  trb_model  *m = rig_model(&p);
  trb_system *system;
  trb_message message = {TRB_OK, ""};
  trb_face    faces[RIG_FACES];
  double      deviation[12] = {0};
  int         columns;
  double     *rows = rig_modes(m, &columns);
  CHECK(trb_system_tapered(m, &system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "cage_modes = 2: 0 modes are given");
  CHECK(trb_model_set_modes(m, rows, 1, columns, &message) == TRB_ERR_INPUT);
  CHECK(trb_model_set_modes(m, rows, 2, columns - 1, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "columns needed");
  for (int at = 0; at <= TRB_MODE_shapes; at++) {
    const double was = rows[columns + at];
    rows[columns + at] = at < TRB_MODE_shapes ? -1.0 : (double)NAN;
    CHECK(trb_model_set_modes(m, rows, 2, columns, &message) == TRB_ERR_INPUT);
    CHECK_SAYS(message.text, "mode 1 of the cage");
    rows[columns + at] = was;
  }
  rows[columns - 1] = 0.1; /* a force of a mode on itself */
  CHECK(trb_model_set_modes(m, rows, 2, columns, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "must be opposite");
  rows[2 * columns - 1] = rows[columns - 1] = 0.0;
  rows[columns - 1] = -rows[2 * columns - 2];
  CHECK(trb_model_set_modes(m, rows, 2, columns, &message) == TRB_OK);
  free(rows);
  trb_model_free(m);
  rig_faces(&p, faces);
  p.effects.planar = 1;
  CHECK(trb_model_create(&p, deviation, 12, faces, RIG_FACES, &m, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "planar");
}

/* Where the amplitudes are zero and at rest, rollers and the rigid motion have the rates that they have beside a rigid cage. */
static void test_undeformed(void)
{
  trb_params p = params_of(0);
  rig_bench  rigid = rig_open(&p, 4930.0);
  p.cage.n_modes = 3;
  rig_bench soft = rig_open(&p, 4930.0);
  double    y[ROOM] = {0}, rates[2][ROOM];
  int       pushed = 0;
  memcpy(y, rigid.start, sizeof y);
  rig_disturb(rigid.system, &seed, y);
  trb_rhs(rigid.d, NULL, 0.01, y, rates[0]);
  const int n = trb_state_main_size(rigid.system);
  memset(y + n, 0, (ROOM - (size_t)n) * sizeof *y);
  trb_rhs(soft.d, NULL, 0.01, y, rates[1]);
  for (int i = 0; i < n; i++) CHECK_NEAR(rates[1][i], rates[0][i], 1e-12 * fabs(rates[0][i]) + 1e-9);
  for (int i = 0; i < 3; i++) pushed += fabs(rates[1][mode_at(soft.system, i) + 1]) > 1.0;
  CHECK(pushed == 3);
  rig_close(&rigid);
  rig_close(&soft);
}

static double energy_at(trb_dynamics *d, const double *y)
{
  trb_dynamics_pose(d, 0.01, y);
  trb_dynamics_loads(d, NULL, NULL);
  return trb_audit_kinetic(d) + trb_audit_elastic(d);
}

/* What forces on rollers, on the rigid cage and on its modes do is what energies and losses say, at any state: action is reaction. */
static void test_power(int n, double amplitude, double lubrication, double damping)
{
  trb_params p = params_of(n);
  p.effects.lubrication = lubrication, p.effects.damping = damping;
  rig_bench b = rig_open(&p, 4930.0);
  for (int trial = 0; trial < 20; trial++) {
    double       y[ROOM] = {0}, rates[ROOM], near[2][ROOM] = {{0}}, power = 0.0, size = 1.0;
    const double h = 1e-9;
    memcpy(y, b.start, sizeof y);
    disturb(b.system, amplitude, y);
    trb_rhs(b.d, NULL, 0.01, y, rates);
    for (int side = 0; side < 2; side++)
      for (int i = 0; i < trb_state_main_size(b.system); i++) near[side][i] = y[i] + (side == 0 ? -h : h) * rates[i];
    const double change = (energy_at(b.d, near[1]) - energy_at(b.d, near[0])) / (2.0 * h), *q = rates + trb_state_quadrature(b.system);
    power = q[TRB_Q_work_shaft] + q[TRB_Q_work_ring] + q[TRB_Q_work_gravity];
    for (int k = 0; k < b.system->model->n_losses; k++) power -= q[TRB_Q_losses + k], size += fabs(q[TRB_Q_losses + k]);
    CHECK(q[TRB_Q_loss_vibration] > 0.0);
    /* what acts on the modes is of the size of what it does to the bodies */
    for (int i = 0; i < n; i++) {
      const int    at = mode_at(b.system, i) + 1;
      const double share = b.system->model->modes.share[i];
      size += fabs(b.system->model->modes.mass[i] * share * share * rates[at] * y[at]);
    }
    CHECK_NEAR(change, power, 1e-6 * size);
  }
  rig_close(&b);
}

static void test_jacobian(int n, double amplitude, double most, double tolerance)
{
  const trb_params p = params_of(n);
  rig_bench        b = rig_open(&p, 4930.0);
  for (int trial = 0; trial < 5; trial++) {
    double y[ROOM] = {0};
    memcpy(y, b.start, sizeof y);
    disturb(b.system, amplitude, y);
    rig_draw_back(b.d, most, b.start, y);
    CHECK_NEAR(rig_jacobian_off(b.system, b.motion, 0.01, y), 0.0, tolerance);
  }
  rig_close(&b);
}

/* A proof that a roller touches nothing holds wherever the modes move the faces. */
static void test_gaps_left(void)
{
  const trb_params p = params_of(4);
  rig_bench        b = rig_open(&p, 4930.0);
  const trb_model *m = b.system->model;
  int              held = 0, touched = 0, free_of = 0;
  for (int trial = 0; trial < 40; trial++) {
    double y[ROOM], direction[4], first[ROOM];
    memcpy(first, b.start, sizeof first);
    first[rig_cage(b.system) + TRB_CAGE_z] = 2e-4; /* between the ends of the rollers */
    for (int i = 0; i < 4; i++) {
      direction[i] = rig_random(&seed);
      first[mode_at(b.system, i)] = 0.2 * rig_random(&seed);
    }
    trb_fast_forget(b.d);
    for (int j = 0; j < m->n_rollers; j++) {
      trb_load load = {0};
      trb_dynamics_pose(b.d, 0.0, first);
      const trb_gaps gaps = trb_fast_touch(b.d, 0, j, first, &load, NULL, NULL);
      free_of += trb_gaps_clear(&gaps);
      memcpy(y, first, sizeof y);
      for (int step = 0; step < 200; step++) {
        trb_counters counters = {0};
        for (int i = 0; i < 4; i++) y[mode_at(b.system, i)] = first[mode_at(b.system, i)] + 0.02 * step * direction[i];
        const int clear = trb_fast_near(b.d, j, y) == 0;
        trb_dynamics_pose(b.d, 0.0, y);
        const trb_instant at = trb_dynamics_instant(b.d, NULL, 0);
        trb_load          now = {0};
        const trb_gaps    left = trb_contact_pocket_of(m, &b.system->pairs[TRB_PAIR_pocket], &at, j, &counters, &now, NULL, NULL);
        const int         touches = counters.pocket_nodes > 0;
        held += clear;
        CHECK(!clear || fmin(left.of[TRB_GAP_FLANK], left.of[TRB_GAP_ENDS]) >= trb_fast_gap_left(b.d, 0, j, y));
        touched += touches;
        CHECK(!(clear && touches));
        CHECK(clear == (trb_fast_gap_left(b.d, 0, j, y) > 0.0));
      }
    }
  }
  CHECK(free_of > 100 && held > 1000 && touched > 100);
  rig_close(&b);
}

/* No vertex of a face moves by more, for a unit of a mode's amplitude, than the bound of its kind of gap says. */
static void test_ways(void)
{
  const trb_params p = params_of(4);
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  const trb_modes *modes = &m->modes;
  double           ways[4 * TRB_N_GAPS];
  for (int j = 0; j < m->n_rollers; j++) {
    trb_pair_pocket.ways(m, &system->pairs[TRB_PAIR_pocket], modes, j, ways);
    for (int f = m->pockets.first_face[j]; f < m->pockets.first_face[j + 1]; f++) {
      const trb_polygon *face = &m->pockets.faces[f].surface;
      const int          gap = m->pockets.faces[f].part == TRB_PART_FLANK ? TRB_GAP_FLANK : TRB_GAP_ENDS;
      const double      *shape = trb_shapes_of(modes, f);
      for (int i = 0; i < modes->n; i++, shape += TRB_SHAPE_ROOM)
        for (int k = 0; k < face->n; k++) {
          const trb_vec3 from = trb_sub(trb_polygon_vertex(face, k), modes->middle[f]);
          const trb_vec3 turned = trb_cross(trb_v(shape[3], shape[4], shape[5]), from);
          CHECK(ways[i * TRB_N_GAPS + gap] >= trb_norm(trb_add(trb_v(shape[0], shape[1], shape[2]), turned)));
        }
    }
  }
  /* bars that do not move have no way, and walls have theirs as before */
  for (int f = m->pockets.first_face[0]; f < m->pockets.first_face[1]; f++)
    for (int i = 0; i < modes->n * TRB_SHAPE_ROOM && m->pockets.faces[f].part == TRB_PART_FLANK; i++)
      ((double *)trb_shapes_of(modes, f))[i] = 0.0;
  trb_pair_pocket.ways(m, &system->pairs[TRB_PAIR_pocket], modes, 0, ways);
  for (int i = 0; i < modes->n; i++) CHECK(ways[i * TRB_N_GAPS + TRB_GAP_FLANK] == 0.0 && ways[i * TRB_N_GAPS + TRB_GAP_ENDS] > 0.0);
  rig_free(system);
}

/* A cage that rings and knocks against its rollers: the audit closes. */
static void test_steps(const char *method)
{
  trb_params p = params_of(4);
  p.effects.damping = 1;
  rig_bench    b = rig_open(&p, 4930.0);
  trb_settings settings = rig_settings();
  settings.rtol = 1e-7, settings.atol_position = 1e-13, settings.atol_velocity = 1e-8, settings.atol_angle = 1e-11,
  settings.atol_spin = 1e-6;
  for (int i = 0; i < 4; i++) b.start[mode_at(b.system, i)] = 0.8;
  trb_simulation *sim = rig_simulation(b.system, b.motion, method, &settings, b.start);
  const double    before = rig_balance(b.system, b.motion, 0.0, sim->integrator.y);
  rig_run(sim, 1e-3);
  const double *end = sim->integrator.y, lost = end[trb_state_quadrature(b.system) + TRB_Q_loss_vibration];
  CHECK(lost > 0.02);
  CHECK(end[trb_state_quadrature(b.system) + TRB_Q_loss_pocket] > 0.0);
  CHECK_NEAR(rig_balance(b.system, b.motion, sim->integrator.time, end), before, 1e-3 * lost);
  trb_simulation_free(sim);
  rig_close(&b);
}

/* Sums over modes, of every instruction set, entry by entry. */
static void test_sums(int n)
{
  double shapes[9 * TRB_SHAPE_ROOM] = {0}, amplitude[9], load[TRB_SHAPE_ROOM] = {0}, to[TRB_SHAPE_ROOM], force[9], pushed[9];
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < TRB_SHAPE; k++) shapes[i * TRB_SHAPE_ROOM + k] = rig_random(&seed);
    amplitude[i] = rig_random(&seed), force[i] = rig_random(&seed);
  }
  for (int k = 0; k < TRB_SHAPE; k++) load[k] = rig_random(&seed);
  for (int v = 0; v < trb_n_kernel_variants; v++) {
    if (!trb_kernel_runs(v)) continue;
    trb_kernel_variants[v].modal->sum(shapes, n, amplitude, to);
    memcpy(pushed, force, sizeof pushed);
    trb_kernel_variants[v].modal->push(shapes, n, load, pushed);
    for (int k = 0; k < TRB_SHAPE; k++) {
      double sum = 0.0;
      for (int i = 0; i < n; i++) sum += amplitude[i] * shapes[i * TRB_SHAPE_ROOM + k];
      CHECK_NEAR(to[k], sum, 1e-14);
    }
    for (int i = 0; i < n; i++) {
      double sum = force[i];
      for (int k = 0; k < TRB_SHAPE; k++) sum += load[k] * shapes[i * TRB_SHAPE_ROOM + k];
      CHECK_NEAR(pushed[i], sum, 1e-14);
    }
  }
}

int main(void)
{
  for (int n = 1; n <= 9; n++) test_sums(n);
  test_refused();
  test_undeformed();
  test_power(4, 2e-5, 2, 1);
  test_power(4, 2e-5, 0, 0);
  test_power(2, 1e-4, 2, 0);
  test_jacobian(1, 1e-5, 20.0, 0.02);
  test_jacobian(4, 1e-5, 20.0, 0.05);
  test_jacobian(4, 1e-5, INFINITY, 0.1);
  test_gaps_left();
  test_ways();
  test_steps("bdf");
  test_steps("erk");
  return check_report();
}
