/* The hub takes a second body: a weight on a damped spring, which is put into a system beside the cage and carries the land of the inner
 * ring. The weight has three coordinates and their velocities; its land is where the inner ring is. Nothing else of the core knows of it. */
#include <stdlib.h>

#include "body/cage.h"
#include "body/ring.h"
#include "check.h"
#include "contact/kernels.h"
#include "rig.h"
#include "stepping/jacobian.h"
#include "stepping/sundials_context.h"
#include "stepping/vectors.h"

enum { X, Y, Z, V_X, V_Y, V_Z, WEIGHT_SIZE };
enum { ROOM = 600, MOST = 12 * TRB_NR + TRB_CAGE_SIZE + WEIGHT_SIZE };

static const double mass = 0.7, stiffness = 7e5, damping = 40.0;

static void pose_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  (void)m;
  (void)body;
  (void)drive;
  memset(pose, 0, sizeof *pose);
  pose->x = trb_v(y[X], y[Y], y[Z]);
  pose->v = trb_v(y[V_X], y[V_Y], y[V_Z]);
}

static void rates_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                     const trb_wrench *load, double *rates)
{
  const trb_vec3 gravity = trb_gravity_in(drive, 1.0, 0.0), held = trb_scale(-stiffness, pose->x);
  const trb_vec3 force = trb_add(trb_axpy(held, -damping, pose->v), load->force);
  (void)m;
  (void)body;
  for (int i = 0; i < 3; i++) rates[i] = y[V_X + i];
  rates[V_X] = force.x / mass + gravity.x, rates[V_Y] = force.y / mass + gravity.y, rates[V_Z] = force.z / mass + gravity.z;
}

static trb_rigid motion_of(const trb_rigid_pose *pose, int coordinate)
{
  const double along[3] = {coordinate % 3 == 0, coordinate % 3 == 1, coordinate % 3 == 2};
  (void)pose;
  return (trb_rigid){trb_v(along[0], along[1], along[2]), trb_v(0, 0, 0)};
}

static double mass_of(const trb_model *m, const trb_body *body)
{
  (void)body;
  (void)m;
  return mass;
}

static double kinetic_of(const trb_model *m, const trb_body *body, const trb_rigid_pose *pose)
{
  (void)body;
  (void)m;
  return 0.5 * mass * trb_dot(pose->v, pose->v);
}

static const trb_coordinate coordinates[WEIGHT_SIZE] = {
    {"x", TRB_TOL_POSITION, "first place, m"},         {"y", TRB_TOL_POSITION, "second place, m"},
    {"z", TRB_TOL_POSITION, "third place, m"},         {"v_x", TRB_TOL_VELOCITY, "first velocity, m/s"},
    {"v_y", TRB_TOL_VELOCITY, "second velocity, m/s"}, {"v_z", TRB_TOL_VELOCITY, "third velocity, m/s"}};

/* Puts the weight in, or takes it out. */
static void set_present(trb_system *system, int present)
{
  static trb_body_kind weight;
  weight = (trb_body_kind){.name = "weight",
                           .place = trb_ring_prescribed.place,
                           .power = trb_ring_prescribed.power,
                           .size = WEIGHT_SIZE,
                           .coordinates = coordinates,
                           .skew = -1,
                           .pose = pose_of,
                           .rates = rates_of,
                           .motion = motion_of,
                           .mass = mass_of,
                           .kinetic = kinetic_of};
  system->bodies[TRB_N_BODIES] = (trb_body){.kind = &weight, .name = "weight"};
  system->n_bodies = TRB_N_BODIES + present;
  system->surfaces[system->pairs[TRB_PAIR_inner_land].surface[1]].body = present ? TRB_N_BODIES : TRB_BODY_INNER_RING;
  CHECK(trb_system_finish(system, NULL) == TRB_OK);
}

static const double       unit[TRB_N_TOLERANCES] = {1e-9, 1e-7, 1e-5, 1e-3, 1.0};
static unsigned long long seed = 5;
static double             dense[MOST][MOST], found[MOST][MOST];

/* A bearing whose cage is guided by the inner ring's land, with the weight and without it, at the same state; tail and hub moved up. */
typedef struct scene {
  trb_system      *system;
  const trb_model *model;
  trb_motion      *motion;
  double           y[ROOM];
} scene;

static scene open_scene(void)
{
  trb_params p = rig_params();
  scene      s = {0};
  p.effects.guidance = TRB_GUIDANCE_INNER_LAND, p.effects.damping = 1;
  s.system = rig_system(&p);
  s.model = s.system->model;
  s.motion = rig_motion(rig_state(s.system, 4930.0, 100 * TRB_PI, s.y), 100 * TRB_PI);
  return s;
}

static void close_scene(scene *s)
{
  trb_motion_free(s->motion);
  rig_free(s->system);
}

static int weight_at(const trb_system *system) { return rig_cage(system) + TRB_CAGE_SIZE; }

static void test_layout(void)
{
  scene s = open_scene();
  set_present(s.system, 0);
  const int without = trb_state_size(s.system);
  CHECK(s.system->layout.hub_width == TRB_CAGE_SIZE);
  set_present(s.system, 1);
  CHECK(s.system->layout.hub_width == TRB_CAGE_SIZE + WEIGHT_SIZE);
  CHECK(trb_state_size(s.system) == without + WEIGHT_SIZE);
  CHECK(trb_state_spin(s.system) == weight_at(s.system) + WEIGHT_SIZE);
  for (int i = 0; i < WEIGHT_SIZE; i++)
    CHECK(trb_state_tolerance(s.system, weight_at(s.system) + i) == (i < V_X ? TRB_TOL_POSITION : TRB_TOL_VELOCITY));
  CHECK(trb_state_tolerance(s.system, trb_state_spin(s.system)) == TRB_TOL_QUADRATURE);
  close_scene(&s);
}

/* Rates of a disturbed state with the weight in it, and of the same state without the weight. */
static void test_rates(void)
{
  scene     s = open_scene();
  double    with[ROOM] = {0}, rates[ROOM], alone[ROOM], energy[2];
  const int at = weight_at(s.system);
  set_present(s.system, 0);
  const int size = trb_state_size(s.system);
  rig_disturb(s.system, &seed, s.y);
  trb_dynamics *d = rig_dynamics(s.system, s.motion);
  trb_rhs(d, NULL, 0.01, s.y, alone);
  energy[0] = trb_audit_kinetic(d);
  const trb_vec3 on_ring = d->hub.on[TRB_BODY_INNER_RING].force;
  trb_dynamics_free(d);
  set_present(s.system, 1);
  memcpy(with, s.y, (size_t)at * sizeof *with);
  memcpy(with + at + WEIGHT_SIZE, s.y + at, (size_t)(size - at) * sizeof *with);
  for (int i = 0; i < WEIGHT_SIZE; i++) with[at + i] = i < V_X ? 1e-5 * (i + 1) : 0.1 * i;
  d = rig_dynamics(s.system, s.motion);
  trb_rhs(d, NULL, 0.01, with, rates);
  energy[1] = trb_audit_kinetic(d);
  const trb_vec3 gravity = trb_gravity_in(&d->drive, 1.0, 0.0), v = trb_v(with[at + V_X], with[at + V_Y], with[at + V_Z]);
  trb_dynamics_free(d);
  /* rollers, cage, spin angles and losses have the same bits */
  for (int i = 0; i < at; i++) CHECK(rates[i] == alone[i]);
  for (int i = at; i < size; i++)
    if (i != trb_state_quadrature(s.system) - WEIGHT_SIZE + TRB_Q_work_gravity) CHECK(rates[i + WEIGHT_SIZE] == alone[i]);
  /* the weight moves as its row says, under the land's force on the ring and under gravity, which does work on it */
  CHECK(trb_norm(on_ring) > 1.0);
  for (int i = 0; i < V_X; i++) CHECK(rates[at + i] == with[at + V_X + i]);
  CHECK_NEAR(rates[at + V_X], (on_ring.x - stiffness * with[at + X] - damping * v.x) / mass + gravity.x, 1e-9 * fabs(rates[at + V_X]));
  CHECK_NEAR(rates[at + V_Y], (on_ring.y - stiffness * with[at + Y] - damping * v.y) / mass + gravity.y, 1e-9 * fabs(rates[at + V_Y]));
  const int    work = trb_state_quadrature(s.system) + TRB_Q_work_gravity;
  const double more = mass * trb_dot(gravity, v), before = alone[work - WEIGHT_SIZE];
  CHECK_NEAR(rates[work] - before, more, 1e-9 * fabs(more) + 1e-12 * fabs(before));
  CHECK_NEAR(energy[1] - energy[0], 0.5 * mass * trb_dot(v, v), 1e-9 * energy[1]);
  close_scene(&s);
}

/* The Jacobian against differences of the right-hand side, in units of the tolerances. */
static void test_jacobian(void)
{
  scene  s = open_scene();
  double low[ROOM], high[ROOM], coupled = 0.0;
  set_present(s.system, 1);
  const int n = trb_state_main_size(s.system), hub = trb_state_hub(s.system), at = weight_at(s.system);
  rig_disturb(s.system, &seed, s.y);
  trb_dynamics *d = rig_dynamics(s.system, s.motion);
  trb_jacobian *jac = rig_jacobian(s.system, s.motion);
  trb_arrow    *a = rig_arrow(s.system);
  trb_jacobian_fill(jac, 0.01, s.y, 1, a);
  rig_expand(a, MOST, &found[0][0]);
  for (int c = 0; c < n; c++) {
    const double of = unit[trb_state_tolerance(s.system, c)], was = s.y[c];
    s.y[c] = was + 0.05 * of;
    trb_rhs(d, NULL, 0.01, s.y, high);
    s.y[c] = was - 0.05 * of;
    trb_rhs(d, NULL, 0.01, s.y, low);
    s.y[c] = was;
    for (int i = 0; i < n; i++) {
      const double per = unit[trb_state_tolerance(s.system, i)];
      dense[i][c] = (high[i] - low[i]) / 0.1 / per;
      found[i][c] *= of / per;
    }
  }
  for (int i = 0; i < n; i++) {
    double largest = 0.0, off = 0.0;
    for (int c = 0; c < n; c++) largest = fmax(largest, fabs(dense[i][c])), off = fmax(off, fabs(found[i][c] - dense[i][c]));
    CHECK_NEAR(off, 0.0, 0.1 * largest + 1e-9);
    for (int c = hub; c < at && i >= at + V_X; c++) coupled = fmax(coupled, fabs(found[i][c]) / largest);
  }
  /* the land couples the weight to the cage */
  CHECK(coupled > 1e-3);
  trb_arrow_free(a);
  trb_jacobian_free(jac);
  trb_dynamics_free(d);
  close_scene(&s);
}

/* Integrated by both methods, the weight vibrates as a damped spring does: the land is far from it. */
static void test_steps(const char *kind)
{
  trb_params   p = rig_params();
  trb_settings settings = rig_settings();
  trb_message  message = {TRB_OK, ""};
  double       y[ROOM] = {0};
  settings.rtol = 1e-6, settings.atol_position = 1e-12, settings.atol_velocity = 1e-7, settings.atol_angle = 1e-10,
  settings.atol_spin = 1e-5;
  trb_system *system = rig_system(&p);
  set_present(system, 1);
  trb_motion *motion = rig_motion(rig_state(system, 4930.0, 100 * TRB_PI, y), 100 * TRB_PI);
  const int   at = weight_at(system);
  y[at + Z] = 1e-4;
  trb_simulation *sim = rig_simulation(system, motion, kind, &settings, y);
  rig_run(sim, 5e-3);
  const double t = sim->integrator.time, decay = 0.5 * damping / mass, omega = sqrt(stiffness / mass - decay * decay);
  const double exact = 1e-4 * exp(-decay * t) * (cos(omega * t) + decay / omega * sin(omega * t));
  CHECK_NEAR(sim->integrator.y[at + Z], exact, 1e-7);
  CHECK(sim->integrator.n_main == at + WEIGHT_SIZE);
  trb_simulation_free(sim);
  /* what is wrong is said in the weight's name */
  y[at + V_Y] = NAN;
  CHECK(rig_create(system, motion, kind, "", &settings, 0.0, y, &sim, &message) != TRB_OK);
  CHECK_SAYS(message.text, "weight, v_y (second velocity, m/s)");
  trb_motion_free(motion);
  rig_free(system);
}

/* The norm of a vector is that of the body whose mean is largest, each body of the hub for itself; and not a number if an entry is not. */
static void test_norm(void)
{
  double       values[ROOM] = {0}, weights[ROOM];
  scene        s = open_scene();
  trb_sundials sundials = {0};
  set_present(s.system, 1);
  const int         n = trb_state_size(s.system), at = weight_at(s.system);
  const trb_system *alone = s.system;
  trb_assembly      assembly;
  if (!CHECK(trb_assembly_make(&alone, 1, &assembly, NULL) == TRB_OK)) return;
  trb_body_entries entries = trb_body_entries_of(&assembly);
  double           swings[ROOM];
  if (!CHECK(trb_sundials_open(&sundials, NULL) == TRB_OK)) return;
  for (int variant = 0; variant < trb_n_kernel_variants; variant++) {
    if (!trb_kernel_runs(variant)) continue;
    for (int i = 0; i < n; i++) values[i] = 0.0, weights[i] = 2.0;
    entries.swings = NULL;
    N_Vector v = trb_vector_over(values, n, &entries, variant, sundials.context);
    N_Vector w = trb_vector_over(weights, n, &entries, variant, sundials.context), clone = N_VClone(v);
    values[at + Z] = 3.0, values[at + V_Z] = 4.0;
    N_VScale(1.0, v, clone);
    CHECK_NEAR(N_VWrmsNorm(clone, w), sqrt(100.0 / WEIGHT_SIZE), 1e-14);
    values[at - 1] = 60.0;
    CHECK_NEAR(N_VWrmsNorm(v, w), 120.0 / sqrt(TRB_CAGE_SIZE), 1e-12);
    values[5] = 600.0;
    CHECK_NEAR(N_VWrmsNorm(v, w), 1200.0 / sqrt(TRB_NR), 1e-11);
    values[n - 1] = 1e9; /* of the tail */
    CHECK_NEAR(N_VWrmsNorm(v, w), 1200.0 / sqrt(TRB_NR), 1e-11);
    const int places[] = {0, at - 1, at + 2};
    for (int i = 0; i < 3; i++) {
      const double was = values[places[i]];
      values[places[i]] = NAN;
      CHECK(isnan(N_VWrmsNorm(v, w)));
      values[places[i]] = was;
    }
    N_VDestroy(clone);
    N_VDestroy(v);
    N_VDestroy(w);
    /* skew and tilt of rollers that swing count by a share, with their spins, and nothing else does */
    for (int i = 0; i < n; i++) values[i] = 0.0;
    for (int j = 0; j < alone->model->n_rollers; j++) swings[j] = j == 1 ? 0.25 : 1.0;
    entries.swings = swings;
    v = trb_vector_over(values, n, &entries, variant, sundials.context);
    w = trb_vector_over(weights, n, &entries, variant, sundials.context);
    for (int i = 0; i < 2 * TRB_NR; i++) {
      const int c = i % TRB_NR, swing = c == TRB_ROLLER_skew || c == TRB_ROLLER_tilt || c == TRB_ROLLER_omega_n || c == TRB_ROLLER_omega_t;
      values[i] = 8.0;
      CHECK_NEAR(N_VWrmsNorm(v, w), (swing && i >= TRB_NR ? 4.0 : 16.0) / sqrt(TRB_NR), 1e-13);
      values[i] = 0.0;
    }
    N_VDestroy(v);
    N_VDestroy(w);
  }
  trb_sundials_close(&sundials);
  close_scene(&s);
}

int main(void)
{
  test_layout();
  test_rates();
  test_jacobian();
  test_steps("bdf");
  test_steps("erk");
  test_norm();
  return check_report();
}
