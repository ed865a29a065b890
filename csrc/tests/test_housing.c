/* The outer ring as a body that moves, beside an inner ring that is held or that moves as well: borders of the Jacobian, energy, momentum,
 * and its limit: a very heavy housing is an outer ring at rest. */
#include <stdlib.h>

#include "body/free_ring.h"
#include "check.h"
#include "rig.h"
#include "stepping/jacobian.h"

enum { ROOM = 700 };

static const double axial_load = 4930.0, speed = 100.0 * TRB_PI;

static unsigned long long seed = 91;

static trb_params params_of(double inner_free, double mass)
{
  trb_params p = rig_params();
  p.outer_ring.free = 1.0;
  p.outer_ring.mass = mass;
  p.outer_ring.inertia_axial = 2e-3 * mass, p.outer_ring.inertia_transverse = 1.5e-3 * mass;
  p.outer_ring.offset = 5e-3;
  p.outer_ring.damping = 40.0, p.outer_ring.damping_turns = 0.03;
  p.outer_ring.support_radial = 4e7, p.outer_ring.support_axial = 3e7, p.outer_ring.support_tilt = 8e3,
  p.outer_ring.support_position = -0.01;
  p.effects.damping = 1.0;
  p.inner_ring.free = inner_free;
  p.inner_ring.mass = 0.7, p.inner_ring.inertia_axial = 5e-4, p.inner_ring.inertia_transverse = 3e-4;
  return p;
}

static int at_ring(const trb_system *system, int body) { return system->bodies[body].first; }

static trb_motion *motion_of(double displacement, double load, double gravity)
{
  double      row[TRB_MOTION_COLUMNS] = {0};
  trb_motion *motion;
  row[1 + 2 * TRB_CHANNEL_displacement_z] = displacement;
  row[1 + 2 * TRB_CHANNEL_shaft_speed] = speed;
  row[1 + 2 * TRB_CHANNEL_gravity_y] = gravity;
  row[1 + 2 * TRB_CHANNEL_force_z] = load;
  row[1 + 2 * TRB_CHANNEL_housing_force_z] = -load;
  if (trb_motion_create(row, 1, &motion, NULL) == TRB_OK) return motion;
  exit(1);
}

static double start_of(const trb_system *system, double *y)
{
  const double displacement = rig_state(system, axial_load, speed, y);
  if (system->model->params.inner_ring.free > 0.0) y[at_ring(system, TRB_BODY_INNER_RING) + TRB_FREE_RING_z] = displacement;
  return displacement;
}

static void disturb(const trb_system *system, int body, double *y)
{
  static const double by[TRB_FREE_RING_SIZE] = {1e-6, 1e-6, 5e-7, 1e-5, 1e-5, 0.0, 1e-2, 1e-2, 1e-2, 0.2, 0.2, 0.0};
  for (int i = 0; i < TRB_FREE_RING_SIZE; i++) y[at_ring(system, body) + i] += by[i] * rig_random(&seed);
}

static void test_jacobian(double inner_free)
{
  const trb_params p = params_of(inner_free, 3.0);
  trb_system      *system = rig_system(&p);
  double           y[ROOM] = {0};
  trb_motion      *motion = motion_of(start_of(system, y), -axial_load, -9.80665);
  CHECK(system->n_moving == (inner_free > 0.0 ? 2 : 1));
  rig_disturb(system, &seed, y);
  disturb(system, TRB_BODY_OUTER_RING, y);
  if (inner_free > 0.0) disturb(system, TRB_BODY_INNER_RING, y);
  CHECK(rig_jacobian_off(system, motion, 0.013, y) < 0.02);
  trb_motion_free(motion);
  rig_free(system);
}

static void test_steps(double inner_free)
{
  static const char *const methods[] = {"bdf", "erk"};
  const trb_params         p = params_of(inner_free, 3.0);
  trb_settings             settings = rig_settings();
  trb_message              message = {TRB_OK, ""};
  trb_system              *system = rig_system(&p);
  double                   y[ROOM] = {0}, at_end[2][ROOM];
  settings.rtol = 1e-7, settings.atol_position = 1e-13, settings.atol_velocity = 1e-8, settings.atol_angle = 1e-11,
  settings.atol_spin = 1e-6;
  trb_motion *motion = motion_of(start_of(system, y), -axial_load, -9.80665);
  const int   outer = at_ring(system, TRB_BODY_OUTER_RING);
  y[outer + TRB_FREE_RING_x] = 2e-6, y[outer + TRB_FREE_RING_v_z] = 2e-3, y[outer + TRB_FREE_RING_omega_n] = 0.05;
  for (int k = 0; k < 2; k++) {
    trb_simulation *sim = rig_simulation(system, motion, methods[k], &settings, y);
    const double    before = rig_balance(system, motion, 0.0, sim->integrator.y);
    rig_run(sim, 3e-4);
    CHECK(trb_simulation_state_at(sim, 3e-4, at_end[k], &message) == TRB_OK);
    const double *q = sim->integrator.y + trb_state_quadrature(system);
    const double  turned_over = fabs(q[TRB_Q_work_ring]) + 0.5 * 4e7 * 4e-12;
    CHECK(q[TRB_Q_loss_support] > 1e-8);
    CHECK_NEAR(rig_balance(system, motion, sim->integrator.time, sim->integrator.y), before, (k == 0 ? 3e-3 : 3e-4) * turned_over);
    trb_simulation_free(sim);
  }
  CHECK(fabs(at_end[0][outer + TRB_FREE_RING_x] - y[outer + TRB_FREE_RING_x]) > 1e-7);
  for (int i = 0; i < 5; i++) CHECK_NEAR(at_end[0][outer + i], at_end[1][outer + i], i < 3 ? 3e-10 : 3e-9);
  trb_motion_free(motion);
  rig_free(system);
}

/* Sum over all bodies, in inertial coordinates. */
static trb_vec3 momentum_of(trb_dynamics *d, double time, const double *y)
{
  trb_dynamics_pose(d, time, y);
  trb_vec3 sum = trb_v(0, 0, 0);
  for (int j = 0; j < d->model->n_rollers; j++) {
    const trb_vec3 own = trb_turn_z(d->rollers[j].v, d->rollers[j].cosine, d->rollers[j].sine);
    sum = trb_axpy(sum, d->model->geometry.roller_mass, trb_turn_z(own, d->drive.cosine, d->drive.sine));
  }
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    if (body->size == 0) continue;
    sum = trb_axpy(sum, body->kind->mass(d->model, body), trb_turn_z(d->bodies[b].pose.v, d->drive.cosine, d->drive.sine));
  }
  return sum;
}

/* Two free rings that nothing holds, let go under their load: what one gains the others lose. Rolling resistance has its force on both
 * surfaces here; without it, as in the paper, forces of rolling do not add up to zero (docs/theory/lubrication.md). */
static void test_momentum(void)
{
  trb_params   p = params_of(1.0, 3.0);
  trb_settings settings = rig_settings();
  double       y[ROOM] = {0};
  p.effects.rolling_pressure_force = 1.0;
  p.outer_ring.damping = p.outer_ring.damping_turns = p.outer_ring.support_radial = p.outer_ring.support_axial = p.outer_ring.support_tilt =
      0.0;
  settings.rtol = 1e-7, settings.atol_position = 1e-13, settings.atol_velocity = 1e-8, settings.atol_angle = 1e-11,
  settings.atol_spin = 1e-6;
  trb_system *system = rig_system(&p);
  trb_motion *motion = motion_of(start_of(system, y), 0.0, 0.0);
  y[at_ring(system, TRB_BODY_OUTER_RING) + TRB_FREE_RING_x] = 3e-6;
  trb_dynamics   *d = rig_dynamics(system, motion);
  trb_simulation *sim = rig_simulation(system, motion, "erk", &settings, y);
  const trb_vec3  before = momentum_of(d, 0.0, sim->integrator.y);
  rig_run(sim, 2e-4);
  const trb_vec3 after = momentum_of(d, sim->integrator.time, sim->integrator.y);
  const double   ring = 3.0 * fabs(sim->integrator.y[at_ring(system, TRB_BODY_OUTER_RING) + TRB_FREE_RING_v_z]);
  CHECK(ring > 0.05);
  CHECK_NEAR(after.x, before.x, 1e-5 * ring);
  CHECK_NEAR(after.y, before.y, 1e-5 * ring);
  CHECK_NEAR(after.z, before.z, 1e-5 * ring);
  trb_simulation_free(sim);
  trb_dynamics_free(d);
  trb_motion_free(motion);
  rig_free(system);
}

/* A housing of ten thousand tonnes stands still, and rollers and cage move as beside an outer ring at rest. */
static void test_heavy(void)
{
  trb_params   p[2] = {params_of(0.0, 1e5), params_of(0.0, 1e5)};
  trb_settings settings = rig_settings();
  trb_message  message = {TRB_OK, ""};
  double       y[2][ROOM] = {{0}}, end[2][ROOM];
  p[1].outer_ring.free = 0.0;
  for (int k = 0; k < 2; k++) {
    trb_system *system = rig_system(&p[k]);
    trb_motion *motion = motion_of(start_of(system, y[k]), -axial_load, 0.0);
    y[k][rig_cage(system) + TRB_CAGE_v_x] = 0.1;
    trb_simulation *sim = rig_simulation(system, motion, "bdf", &settings, y[k]);
    rig_run(sim, 4e-3);
    CHECK(trb_simulation_state_at(sim, 4e-3, end[k], &message) == TRB_OK);
    trb_simulation_free(sim);
    trb_motion_free(motion);
    if (k == 0) {
      rig_free(system);
      continue;
    }
    const int           cage = rig_cage(system), rollers = system->model->n_rollers * TRB_ROLLER_SIZE;
    static const double tolerance[TRB_N_TOLERANCES] = {5e-9, 5e-6, 2e-4, 2e-2, 1.0};
    for (int i = 0; i < rollers; i++) CHECK_NEAR(end[0][i], end[1][i], tolerance[trb_state_tolerance(system, i)]);
    trb_system *other = rig_system(&p[0]);
    const int   own = rig_cage(other);
    for (int i = 0; i < TRB_CAGE_SIZE; i++)
      CHECK_NEAR(end[0][own + i], end[1][cage + i], 100.0 * tolerance[trb_state_tolerance(system, cage + i)]);
    rig_free(other);
    rig_free(system);
  }
}

static void test_refused(void)
{
  double      deviation[12] = {0};
  trb_message message = {TRB_OK, ""};
  trb_model  *model;
  trb_face    faces[RIG_FACES];
  trb_params  p = params_of(0.0, 0.0);
  rig_faces(&p, faces);
  CHECK(trb_model_create(&p, deviation, (int)p.bearing.n_rollers, faces, RIG_FACES, &model, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "outer_mass = 0: must be above 0 for a free ring");
}

int main(void)
{
  test_jacobian(0.0);
  test_jacobian(1.0);
  test_steps(0.0);
  test_steps(1.0);
  test_momentum();
  test_heavy();
  test_refused();
  return check_report();
}
