/* A kind of body whose size is known at run time: a cage in which n masses hang on damped springs along its axis. It has 2n coordinates more
 * than a rigid cage, stores and loses energy within itself, and books what it loses. Nothing of the core knows of it. */
#include <stdlib.h>

#include "body/cage.h"
#include "check.h"
#include "contact/kernels.h"
#include "rig.h"
#include "stepping/jacobian.h"

enum { MOST_MASSES = 3, ROOM = 600, MOST = 12 * TRB_NR + TRB_CAGE_SIZE + 2 * MOST_MASSES };

/* A body's own parameters. The coordinates are stretches of the springs, then inertial velocities of the masses. */
typedef struct springs {
  trb_cage_inputs cage; /* what the functions of a rigid cage read comes first */
  int             n;
  double          mass, stiffness[MOST_MASSES], damping;
} springs;

static double pull(const springs *s, const double *y, int k)
{
  const double *u = y + TRB_CAGE_SIZE, *v = u + s->n;
  return s->stiffness[k] * u[k] + s->damping * (v[k] - y[TRB_CAGE_v_z]);
}

static void pose_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  const springs *s = body->own;
  const double  *u = y + TRB_CAGE_SIZE, *v = u + s->n;
  trb_body_cage.pose(m, body, drive, y, pose);
  pose->moving = pose->stored = pose->lost = 0.0;
  for (int k = 0; k < s->n; k++) {
    const double rate = v[k] - y[TRB_CAGE_v_z];
    pose->moving += 0.5 * s->mass * v[k] * v[k];
    pose->stored += 0.5 * s->stiffness[k] * u[k] * u[k];
    pose->lost += s->damping * rate * rate;
  }
}

static void rates_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                     const trb_wrench *load, double *rates)
{
  const springs *s = body->own;
  double        *u = rates + TRB_CAGE_SIZE, *v = u + s->n;
  trb_body_cage.rates(m, body, drive, pose, y, load, rates);
  for (int k = 0; k < s->n; k++) {
    u[k] = y[TRB_CAGE_SIZE + s->n + k] - y[TRB_CAGE_v_z];
    v[k] = -pull(s, y, k) / s->mass;
    rates[TRB_CAGE_v_z] += pull(s, y, k) / m->params.cage.mass;
  }
}

/* A mass moves no face of the cage. */
static trb_rigid motion_of(const trb_rigid_pose *pose, int coordinate)
{
  if (coordinate < TRB_CAGE_SIZE) return trb_body_cage.motion(pose, coordinate);
  return (trb_rigid){{0, 0, 0}, {0, 0, 0}};
}

static trb_body_kind kind_of(void)
{
  trb_body_kind kind = trb_body_cage;
  kind.name = "cage with masses on springs";
  kind.size = 0;
  kind.coordinates = NULL;
  kind.loses = 1;
  kind.pose = pose_of;
  kind.rates = rates_of;
  kind.motion = motion_of;
  return kind;
}

static trb_body_kind  kind;
static trb_coordinate coordinates[TRB_CAGE_SIZE + 2 * MOST_MASSES];

/* Puts the masses into the cage of a system. */
static void put_masses(trb_system *system, const springs *s)
{
  static const char *const stretch[MOST_MASSES] = {"u0", "u1", "u2"}, *const velocity[MOST_MASSES] = {"v0", "v1", "v2"};
  kind = kind_of();
  memcpy(coordinates, trb_body_cage.coordinates, TRB_CAGE_SIZE * sizeof *coordinates);
  for (int k = 0; k < s->n; k++) {
    coordinates[TRB_CAGE_SIZE + k] = (trb_coordinate){stretch[k], TRB_TOL_POSITION, "stretch of a spring, m"};
    coordinates[TRB_CAGE_SIZE + s->n + k] = (trb_coordinate){velocity[k], TRB_TOL_VELOCITY, "velocity of a mass, m/s"};
  }
  system->bodies[TRB_BODY_CAGE] = (trb_body){.kind = &kind,
                                             .name = "cage",
                                             .own = s,
                                             .size = TRB_CAGE_SIZE + 2 * s->n,
                                             .coordinates = coordinates,
                                             .loss = TRB_BOOK(TRB_LOSS_damping)};
  CHECK(trb_system_finish(system, NULL) == TRB_OK);
}

static springs springs_of(int n)
{
  return (springs){.cage = rig_params().cage, .n = n, .mass = 0.02, .stiffness = {4e4, 9e4, 2.5e5}, .damping = 1.5};
}

static unsigned long long seed = 41;

/* The state grows by what the body says; the rest of the state has the bits that it has beside a rigid cage. */
static void test_size(int n)
{
  const trb_params p = rig_params();
  const springs    s = springs_of(n);
  trb_system      *rigid = rig_system(&p), *soft = rig_system(&p);
  double           y[ROOM] = {0}, with[ROOM] = {0}, rates[2][ROOM];
  trb_dynamics    *d[2];
  trb_motion      *motion = rig_motion(rig_state(rigid, 4930.0, 100 * TRB_PI, y), 100 * TRB_PI);
  rig_disturb(rigid, &seed, y);
  put_masses(soft, &s);
  const int at = trb_state_main_size(rigid);
  CHECK(soft->layout.hub_width == TRB_CAGE_SIZE + 2 * n && trb_state_size(soft) == trb_state_size(rigid) + 2 * n);
  memcpy(with, y, (size_t)at * sizeof *y);
  for (int k = 0; k < n; k++) with[at + k] = 1e-5 * (k + 1), with[at + n + k] = y[rig_cage(rigid) + TRB_CAGE_v_z] + 0.1;
  if (!CHECK(trb_dynamics_create(rigid, motion, "scalar", &d[0], NULL) == TRB_OK)) return;
  if (!CHECK(trb_dynamics_create(soft, motion, "scalar", &d[1], NULL) == TRB_OK)) return;
  trb_rhs(d[0], NULL, 0.01, y, rates[0]);
  trb_rhs(d[1], NULL, 0.01, with, rates[1]);
  const int quadratures[2] = {trb_state_quadrature(rigid), trb_state_quadrature(soft)};
  double    force = 0.0;
  for (int k = 0; k < n; k++) force += s.stiffness[k] * 1e-5 * (k + 1) + s.damping * 0.1;
  for (int i = 0; i < at; i++)
    if (i != rig_cage(rigid) + TRB_CAGE_v_z) CHECK(rates[1][i] == rates[0][i]);
  const int axial = rig_cage(rigid) + TRB_CAGE_v_z;
  CHECK_NEAR(rates[1][axial] - rates[0][axial], force / p.cage.mass, 1e-9 * fabs(rates[0][axial]) + 1e-9);
  for (int k = 0; k < trb_n_quadratures(rigid); k++) {
    const double more = rates[1][quadratures[1] + k] - rates[0][quadratures[0] + k];
    if (k == TRB_Q_loss_damping) CHECK_NEAR(more, n * s.damping * 0.01, 1e-12);
    else CHECK(more == 0.0);
  }
  for (int i = 0; i < 2; i++) trb_dynamics_free(d[i]);
  trb_motion_free(motion);
  rig_free(rigid);
  rig_free(soft);
}

/* The Jacobian against differences of the right-hand side, in units of the tolerances. */
static void test_jacobian(int n)
{
  const trb_params p = rig_params();
  const springs    s = springs_of(n);
  trb_system      *system = rig_system(&p);
  double           y[ROOM] = {0};
  trb_motion      *motion = rig_motion(rig_state(system, 4930.0, 100 * TRB_PI, y), 100 * TRB_PI);
  rig_disturb(system, &seed, y);
  put_masses(system, &s);
  for (int i = trb_state_main_size(system) - 2 * n; i < ROOM; i++) y[i] = 0.0;
  CHECK(rig_jacobian_off(system, motion, 0.01, y) < 0.1);
  trb_motion_free(motion);
  rig_free(system);
}

/* Both methods integrate it, and its energies and loss close the audit; without the loss it would not close. */
static void test_steps(const char *method, int n)
{
  const trb_params p = rig_params();
  const springs    s = springs_of(n);
  trb_settings     settings = rig_settings();
  trb_message      message = {TRB_OK, ""};
  trb_system      *system = rig_system(&p);
  double           y[ROOM] = {0};
  settings.rtol = 1e-7, settings.atol_position = 1e-13, settings.atol_velocity = 1e-8, settings.atol_angle = 1e-11,
  settings.atol_spin = 1e-6;
  trb_motion *motion = rig_motion(rig_state(system, 4930.0, 100 * TRB_PI, y), 100 * TRB_PI);
  put_masses(system, &s);
  const int at = rig_cage(system) + TRB_CAGE_SIZE;
  for (int k = 0; k < n; k++) y[at + k] = 1e-4;
  trb_simulation *sim = rig_simulation(system, motion, method, &settings, y);
  const double    before = rig_balance(system, motion, 0.0, sim->integrator.y);
  rig_run(sim, 2e-3);
  const double *end = sim->integrator.y, lost = end[trb_state_quadrature(system) + TRB_Q_loss_damping];
  CHECK(lost > 1e-6);
  CHECK_NEAR(rig_balance(system, motion, sim->integrator.time, end), before, 2e-3 * lost);
  CHECK(fabs(end[at]) < 1.2e-4 && end[at] != y[at]);
  trb_simulation_free(sim);
  y[at + 2 * n - 1] = NAN;
  CHECK(rig_create(system, motion, method, "", &settings, 0.0, y, &sim, &message) != TRB_OK);
  CHECK_SAYS(message.text, "cage, v");
  trb_motion_free(motion);
  rig_free(system);
}

/* What a body loses must be booked, and a body must not be moved by a pair whose load on it would be dropped. */
static void test_refused(void)
{
  const trb_params p = rig_params();
  const springs    s = springs_of(2);
  trb_message      message = {TRB_OK, ""};
  trb_system      *system = rig_system(&p);
  put_masses(system, &s);
  system->bodies[TRB_BODY_CAGE].loss = 0;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "body cage loses energy, which is booked nowhere");
  system->bodies[TRB_BODY_CAGE].loss = TRB_BOOK(TRB_LOSS_damping);
  system->bodies[TRB_BODY_OIL].loss = TRB_BOOK(TRB_LOSS_drag);
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "body oil books a loss, and loses nothing");
  system->bodies[TRB_BODY_OIL].loss = 0;
  system->surfaces[system->pairs[TRB_PAIR_outer].surface[1]].body = TRB_BODY_CAGE;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pair outer: its load would be lost on cage");
  rig_free(system);
}

int main(void)
{
  for (int n = 1; n <= MOST_MASSES; n++) test_size(n);
  test_jacobian(2);
  test_steps("bdf", 2);
  test_steps("erk", 2);
  test_refused();
  return check_report();
}
