/* The inner ring as a body that moves: its tangents and its borders of the Jacobian against differences of the exact right-hand side, its
 * energy, its balance with all that acts on it, and its limits: a very heavy ring is a held one. */
#include "body/free_ring.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"
#include "stepping/jacobian.h"

enum { ROOM = 600, MOST = 12 * TRB_NR + TRB_CAGE_SIZE + TRB_FREE_RING_SIZE };

static const double axial_load = 4930.0, speed = 100.0 * TRB_PI;

static unsigned long long seed = 51;

static trb_params params_of(double free, double mass)
{
  trb_params p = rig_params();
  p.inner_ring.free = free;
  p.inner_ring.mass = mass;
  p.inner_ring.inertia_axial = 8e-4 * mass, p.inner_ring.inertia_transverse = 5e-4 * mass;
  p.inner_ring.offset = 4e-3;
  p.inner_ring.unbalance = 2e-5, p.inner_ring.unbalance_angle = 0.4;
  p.inner_ring.damping = 30.0, p.inner_ring.damping_turns = 0.02;
  p.inner_ring.support_radial = 3e7, p.inner_ring.support_axial = 2e7, p.inner_ring.support_tilt = 5e3,
  p.inner_ring.support_position = 0.03;
  p.effects.damping = 1.0;
  return p;
}

static int ring_at(const trb_system *system) { return system->bodies[TRB_BODY_INNER_RING].first; }

/* A constant load that balances the start, with a weight that is carried, and a radial one that moves the ring away. */
static trb_motion *motion_of(double displacement, double radial_load, double weight)
{
  double      row[TRB_MOTION_COLUMNS] = {0};
  trb_motion *motion;
  row[1 + 2 * TRB_CHANNEL_displacement_z] = displacement;
  row[1 + 2 * TRB_CHANNEL_shaft_speed] = speed;
  row[1 + 2 * TRB_CHANNEL_gravity_y] = -9.80665;
  row[1 + 2 * TRB_CHANNEL_force_z] = -axial_load;
  row[1 + 2 * TRB_CHANNEL_force_x] = radial_load;
  row[1 + 2 * TRB_CHANNEL_moment_y] = 0.02 * radial_load;
  row[1 + 2 * TRB_CHANNEL_force_y] = weight;
  row[1 + 2 * TRB_CHANNEL_torque] = 4.0;
  if (trb_motion_create(row, 1, &motion, NULL) == TRB_OK) return motion;
  exit(1);
}

static double start_of(const trb_system *system, double *y)
{
  const double displacement = rig_state(system, axial_load, speed, y);
  y[ring_at(system) + TRB_FREE_RING_z] = displacement;
  return displacement;
}

static void disturb_ring(const trb_system *system, double *y)
{
  static const double by[TRB_FREE_RING_SIZE] = {1e-6, 1e-6, 5e-7, 1e-5, 1e-5, 1e-3, 1e-2, 1e-2, 1e-2, 0.2, 0.2, 0.5};
  for (int i = 0; i < TRB_FREE_RING_SIZE; i++) y[ring_at(system) + i] += by[i] * rig_random(&seed);
}

/* Borders and blocks against differences of the exact right-hand side. */
static void test_jacobian(double free)
{
  const trb_params p = params_of(free, 0.7);
  trb_system      *system = rig_system(&p);
  double           y[ROOM] = {0};
  trb_motion      *motion = motion_of(start_of(system, y), 300.0, 0.0);
  CHECK(system->n_moving == 1 && system->layout.hub_width == TRB_CAGE_SIZE + TRB_FREE_RING_SIZE);
  rig_disturb(system, &seed, y);
  disturb_ring(system, y);
  CHECK(rig_jacobian_off(system, motion, 0.013, y) < 0.02);
  trb_motion_free(motion);
  rig_free(system);
}

/* Half the distance of rollers and ring from the origin, and half the turn of the frame, a quarter of the error of every rate. */
static void test_order(void)
{
  static const double tolerance[TRB_N_TOLERANCES] = {3e-10, 3e-8, 1e-4, 1e-2, 1e30};
  const trb_params    p = params_of(2.0, 0.7);
  trb_system         *system = rig_system(&p);
  double              y[ROOM] = {0}, moved[ROOM], relative[ROOM] = {0}, scale[ROOM], rates[ROOM], exact[ROOM], off[2] = {0, 0}, all = 0.0;
  trb_tangents       *tangents;
  trb_arrow_factors  *factors;
  trb_motion         *motion = motion_of(start_of(system, y), 300.0, 0.0);
  const int           n = system->model->n_rollers, main_size = trb_state_main_size(system);
  disturb_ring(system, y);
  trb_dynamics *d = rig_dynamics(system, motion);
  if (!CHECK(trb_tangents_create(system, &tangents, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(n, system->layout.hub_width, d->work->variant, &factors, NULL) == TRB_OK)) return;
  trb_arrow *arrow = rig_arrow(system);
  arrow->gamma = 1e-5;
  CHECK(trb_arrow_factor(arrow, arrow->gamma, NULL, arrow->n, factors));
  trb_arrow_free(arrow);
  for (int i = 0; i < trb_state_size(system); i++) scale[i] = tolerance[trb_state_tolerance(system, i)];
  const trb_tangent_measure measure = {relative, scale, factors->kernels, factors->gamma, 1.0, 1e9, 1e9};
  for (int k = 0; k < 2; k++) {
    unsigned long long here = 17;
    const double       far = k == 0 ? 40.0 : 20.0, later = far * 2e-7;
    double             to[ROOM];
    memcpy(moved, y, sizeof moved);
    trb_dynamics_pose(d, 0.0, y);
    trb_tangents_differentiate(tangents, d, d->everyone, d->model->n_rollers, y, moved);
    for (int j = 0; j < n; j++) tangents->rollers[j].mean_uses = 1e9;
    trb_tangents_derivative(tangents, d, &measure, 0.0, y, rates);
    trb_rhs(d, NULL, 0.0, y, exact);
    for (int i = 0; i < main_size; i++) CHECK_NEAR(rates[i], exact[i], 1e-12 * fabs(exact[i]) + 1e-9);
    for (int j = 0; j < n; j++) tangents->rollers[j].mean_uses = 1e9, tangents->rollers[j].reach = 1e6;
    memcpy(to, y, sizeof to);
    for (int i = 0; i < main_size; i++)
      if (i < rig_cage(system) || i >= ring_at(system)) to[i] += far * scale[i] * rig_random(&here);
    const long long before = d->work->counters.tangent_rollers;
    trb_tangents_derivative(tangents, d, &measure, later, to, rates);
    CHECK(d->work->counters.tangent_rollers == before + n);
    trb_rhs(d, NULL, later, to, exact);
    for (int i = ring_at(system); i < ring_at(system) + TRB_FREE_RING_SIZE; i++)
      off[k] = fmax(off[k], fabs(rates[i] - exact[i]) * 1e-5 / scale[i]), all = fmax(all, fabs(exact[i]) * 1e-5 / scale[i]);
  }
  CHECK(off[0] > 0.0 && off[0] < 0.2 * all);
  CHECK(off[0] / off[1] > 3.0 && off[0] / off[1] < 5.0);
  trb_arrow_factors_free(factors);
  trb_tangents_free(tangents);
  trb_dynamics_free(d);
  trb_motion_free(motion);
  rig_free(system);
}

/* Both methods close the audit, under a load that moves the ring away, with unbalance, dampers and a torque; and they agree. */
static void test_steps(double free, double *ends)
{
  static const char *const methods[] = {"bdf", "erk"};
  const trb_params         p = params_of(free, 0.7);
  trb_settings             settings = rig_settings();
  trb_message              message = {TRB_OK, ""};
  trb_system              *system = rig_system(&p);
  double                   y[ROOM] = {0}, at_end[2][ROOM];
  settings.rtol = 1e-7, settings.atol_position = 1e-13, settings.atol_velocity = 1e-8, settings.atol_angle = 1e-11,
  settings.atol_spin = 1e-6;
  trb_motion *motion = motion_of(start_of(system, y), 400.0, 0.0);
  for (int k = 0; k < 2; k++) {
    trb_simulation *sim = rig_simulation(system, motion, methods[k], &settings, y);
    const double    before = rig_balance(system, motion, 0.0, sim->integrator.y);
    rig_run(sim, 1e-3);
    CHECK(trb_simulation_state_at(sim, 1e-3, at_end[k], &message) == TRB_OK);
    const double *q = sim->integrator.y + trb_state_quadrature(system), lost = q[TRB_Q_loss_support];
    const double  turned_over = fabs(q[TRB_Q_work_ring]);
    CHECK(lost > 1e-8 && turned_over > 1e-4);
    CHECK_NEAR(rig_balance(system, motion, sim->integrator.time, sim->integrator.y), before, 1e-4 * turned_over);
    trb_simulation_free(sim);
  }
  for (int i = 0; i < 5; i++) {
    const int at = ring_at(system) + i;
    CHECK_NEAR(at_end[0][at], at_end[1][at], i < 3 ? 3e-10 : 3e-9);
  }
  memcpy(ends, at_end[0] + ring_at(system), TRB_FREE_RING_SIZE * sizeof *ends);
  trb_motion_free(motion);
  rig_free(system);
}

/* A ring of ten thousand tonnes stands still, and its rollers move as in a bearing whose ring is held. */
static void test_heavy(void)
{
  trb_params   p[2] = {params_of(1.0, 1e5), params_of(0.0, 1e5)};
  trb_settings settings = rig_settings();
  trb_message  message = {TRB_OK, ""};
  double       y[2][ROOM] = {{0}}, end[2][ROOM];
  /* finer than usual, as the cage's hits enlarge what the two integrations leave */
  settings.rtol *= 0.2, settings.atol_position *= 0.2, settings.atol_velocity *= 0.2, settings.atol_angle *= 0.2, settings.atol_spin *= 0.2;
  for (int k = 0; k < 2; k++) {
    p[k].inner_ring.unbalance = p[k].inner_ring.offset = 0.0;
    trb_system  *system = rig_system(&p[k]);
    const double displacement = k == 0 ? start_of(system, y[k]) : rig_state(system, axial_load, speed, y[k]);
    trb_motion  *motion = motion_of(displacement, 0.0, k == 0 ? 9.80665 * p[k].inner_ring.mass : 0.0);
    y[k][rig_cage(system) + TRB_CAGE_v_x] = 0.1;
    trb_simulation *sim = rig_simulation(system, motion, "bdf", &settings, y[k]);
    rig_run(sim, 4e-3);
    CHECK(trb_simulation_state_at(sim, 4e-3, end[k], &message) == TRB_OK);
    trb_simulation_free(sim);
    trb_motion_free(motion);
    rig_free(system);
  }
  trb_system *system = rig_system(&p[0]);
  for (int i = 0; i < trb_state_main_size(system) - TRB_FREE_RING_SIZE; i++) {
    static const double tolerance[TRB_N_TOLERANCES] = {5e-9, 5e-6, 2e-4, 2e-2, 1.0};
    /* the cage hits its rollers on the way, which enlarges differences */
    const double more = i < trb_state_hub(system) ? 1.0 : 100.0;
    CHECK_NEAR(end[0][i], end[1][i], more * tolerance[trb_state_tolerance(system, i)]);
  }
  rig_free(system);
}

static void test_refused(void)
{
  double      deviation[12] = {0};
  trb_message message = {TRB_OK, ""};
  trb_model  *model;
  trb_face    faces[RIG_FACES];
  trb_params  p = params_of(1.0, 0.0);
  rig_faces(&p, faces);
  CHECK(trb_model_create(&p, deviation, (int)p.bearing.n_rollers, faces, RIG_FACES, &model, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "ring_mass = 0: must be above 0 for a free ring");
}

int main(void)
{
  double kept[TRB_FREE_RING_SIZE], turned[TRB_FREE_RING_SIZE];
  test_jacobian(1.0);
  test_jacobian(2.0);
  test_order();
  test_steps(1.0, kept);
  test_steps(2.0, turned);
  /* a torque turns the ring, a drive keeps it */
  CHECK(kept[TRB_FREE_RING_psi] == 0.0 && kept[TRB_FREE_RING_omega_a] == 0.0 && fabs(turned[TRB_FREE_RING_omega_a]) > 0.1);
  test_heavy();
  test_refused();
  return check_report();
}
