#include "rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/case.h"
#include "contact/kernels.h"
#include "motion/equilibrium.h"

static void need(trb_status status, const trb_message *message)
{
  if (status == TRB_OK) return;
  printf("%s\n", message->text);
  exit(1);
}

trb_params rig_params(void)
{
  trb_params p = {0};
  p.bearing.n_rollers = 12;
  p.bearing.cup_half_angle = (12.0 + 57.0 / 60.0 + 10.0 / 3600.0) * TRB_PI / 180.0;
  p.roller.diameter = 14.0e-3, p.roller.effective_length = 19.8e-3, p.roller.total_length = 20.8e-3, p.bearing.pitch_diameter = 82.389e-3;
  p.roller.density = 7810, p.bearing.youngs_modulus = p.roller.youngs_modulus = p.cage.youngs_modulus = 206e9;
  p.bearing.poisson_ratio = p.roller.poisson_ratio = p.cage.poisson_ratio = 0.3, p.roller.sphere_ratio = 0.9;
  p.rib.contact_height = 1.667e-3, p.rib.edge_low = 0.3e-3, p.rib.edge_high = 3.5e-3;
  p.rib.front_clearance = 0.2e-3, p.rib.front_low = 0.3e-3, p.rib.front_high = 2e-3, p.roller.end_stiffness = 1e10;
  p.roughness.raceway = 0.16e-6, p.roughness.rib = 0.24e-6, p.pocket.roughness = 1e-6;
  p.roller.profile = 2, p.roller.crown_radius = 100, p.roller.profile_k1 = 1.5, p.roller.profile_k2 = 0.4, p.roller.profile_zm = 10e-6,
  p.roller.profile_load = 1833;
  p.roller.profile_a = 3.5e-4, p.roller.profile_c = 19.8e-3, p.roller.profile_k = 2.0;
  p.effects.quadrature = 0, p.effects.n_slices = RIG_SLICES;
  p.cage.mass = 0.2, p.cage.inertia_axial = 3.9e-4, p.cage.inertia_transverse = 2.1e-4, p.cage.offset = 0, p.cage.rail_offset = 12e-3;
  p.oil.viscosity = 0.0346, p.oil.pressure_coefficient = 1.97e-8, p.oil.temperature_coefficient = 0.0392, p.oil.conductivity = 0.134,
  p.oil.temperature = 60;
  p.oil.viscosity_law = 0, p.oil.dicke_a = 327.79, p.oil.dicke_b = 2.9862, p.oil.dicke_c = 4.419e-3, p.oil.dicke_d = 3.0115e-4,
  p.oil.viscosity_exponent_cap = 25;
  p.oil.eyring_stress = 5e6, p.oil.shear_modulus_floor = 1e7, p.effects.starvation_factor = 1, p.effects.supply = 1;
  p.friction.lambda_boundary = 0.01, p.friction.lambda_full = 1.5, p.friction.boundary_limit = 0.1, p.friction.rib_boundary_limit = 0.1,
  p.friction.boundary_slope = 22.28, p.friction.boundary_decay = 181.46;
  p.friction.dry_friction = 0.1, p.friction.coulomb_speed = 0.01, p.friction.cage_entrainment_speed = 0.05, p.friction.speed_floor = 1e-3,
  p.friction.thermal_floor = 0.05;
  p.oil.density = 860.6, p.effects.drag_coefficient = 1;
  p.friction.asperity_factor = 2.32, p.friction.asperity_exponent = 0.97, p.friction.rib_asperity_factor = 1.90,
  p.friction.rib_asperity_exponent = 0.99;
  p.land.offset = 12e-3, p.land.inner_radius = 39.5e-3, p.land.outer_radius = 50.5e-3, p.land.width = 3e-3;
  p.land.clearance = 0.1e-3, p.land.contact_film = 1e-6, p.land.fill = 1;
  p.friction.rolling_blend = 0.1, p.effects.damping_race = 0.1, p.pocket.damping = 0.5, p.effects.film_damping = 1e-5,
  p.effects.film_damping_depth = 3e-7;
  p.effects.with_cage = 1, p.effects.lubrication = 2, p.effects.traction = 2, p.effects.thermal = 1, p.effects.rolling_resistance = 1,
  p.effects.back_rib = 1, p.effects.front_rib = 1;
  p.pocket.bars = 1, p.pocket.ends = 1, p.pocket.edges = 1;
  return p;
}

trb_params rig_cylinder(void)
{
  trb_params p = rig_params();
  p.bearing.cup_half_angle = 0.0, p.roller.end_radius = 0.7, p.rib.clearance = 20e-6, p.rib.outer = p.rib.outer_front = 1;
  return p;
}

void rig_faces(const trb_params *p, trb_face faces[RIG_FACES])
{
  const trb_case c = {.params = *p,
                      .own = {[TRB_CASE_play_radial] = 0.25e-3, [TRB_CASE_play_circumferential] = 0.12e-3, [TRB_CASE_play_axial] = 0.4e-3}};
  trb_message    message;
  need(trb_case_faces(&c, faces, &message), &message);
}

trb_model *rig_model(const trb_params *params)
{
  trb_face    faces[RIG_FACES];
  double      deviation[200] = {0};
  trb_model  *model;
  trb_message message = {TRB_OK, ""};
  rig_faces(params, faces);
  need(trb_model_create(params, deviation, (int)params->bearing.n_rollers, faces, RIG_FACES, &model, &message), &message);
  return model;
}

double *rig_modes(const trb_model *m, int *columns)
{
  const int          n = (int)m->params.cage.n_modes;
  unsigned long long seed = 5;
  const int          shapes_end = TRB_MODE_shapes + TRB_SHAPE * m->n_rollers * m->n_slots;
  *columns = shapes_end + n;
  double *rows = calloc((size_t)(n * *columns) + 1, sizeof *rows);
  if (rows == NULL) exit(1);
  for (int i = 0; i < n; i++) {
    double      *row = rows + i * *columns, *shape = row + TRB_MODE_shapes;
    const double waves = 2.0 + floor(0.5 * i);
    row[TRB_MODE_frequency] = 2.0 * TRB_PI * 1200.0 * (1.0 + 0.5 * i), row[TRB_MODE_damping] = 0.02, row[TRB_MODE_mass] = 0.1;
    for (int j = 0; j < m->n_rollers; j++)
      for (int slot = 0; slot < m->n_slots; slot++, shape += TRB_SHAPE) {
        const double phase = waves * 2.0 * TRB_PI * j / m->n_rollers - 0.5 * TRB_PI * (i % 2);
        shape[0] = cos(phase), shape[1] = -sin(phase) / waves, shape[2] = 0.3 * cos(phase);
        for (int k = 0; k < TRB_SHAPE; k++) shape[k] += (k < 3 ? 0.2 : 30.0) * rig_random(&seed);
      }
    for (int k = 0; k < i; k++) {
      row[shapes_end + k] = 0.1 * rig_random(&seed);
      rows[k * *columns + shapes_end + i] = -row[shapes_end + k];
    }
  }
  return rows;
}

trb_system *rig_system(const trb_params *params)
{
  trb_model  *model = rig_model(params);
  trb_system *system;
  trb_message message = {TRB_OK, ""};
  int         columns;
  double     *rows = rig_modes(model, &columns);
  need(trb_model_set_modes(model, rows, (int)params->cage.n_modes, columns, &message), &message);
  free(rows);
  need(trb_system_tapered(model, &system, &message), &message);
  return system;
}

void rig_free(trb_system *system)
{
  trb_model *model = (trb_model *)system->model; /* made by rig_system */
  trb_system_free(system);
  trb_model_free(model);
}

int rig_cage(const trb_system *system) { return system->bodies[TRB_BODY_CAGE].first; }

trb_motion *rig_motion(double displacement_z, double shaft_speed)
{
  double      row[TRB_MOTION_COLUMNS] = {0};
  trb_motion *motion;
  row[1 + 2 * TRB_CHANNEL_displacement_z] = displacement_z;
  row[1 + 2 * TRB_CHANNEL_shaft_speed] = shaft_speed;
  row[1 + 2 * TRB_CHANNEL_gravity_y] = -9.80665;
  if (trb_motion_create(row, 1, &motion, NULL) == TRB_OK) return motion;
  exit(1);
}

trb_settings rig_settings(void)
{
  trb_settings settings;
  double      *values = (double *)&settings;
  for (int i = 0; i < TRB_N_SETTINGS; i++) values[i] = trb_setting_table[i].standard;
  return settings;
}

double rig_state(const trb_system *system, double axial_load, double shaft_speed, double *state)
{
  const trb_model *m = system->model;
  double           angles[200], rollers[200 * TRB_ROLLER_FREEDOMS] = {0}, loads[200 * TRB_EQUILIBRIUM_LOADS];
  trb_message      message = {TRB_OK, ""};
  trb_equilibrium  e = {.load = {0, 0, -axial_load, 0, 0},
                        .fixed = {0, 0, 0, 1, 1},
                        .shaft_speed = shaft_speed,
                        .angles = angles,
                        .rollers = rollers,
                        .loads = loads};
  for (int j = 0; j < m->n_rollers; j++) angles[j] = trb_nominal_angle(m, j);
  need(trb_equilibrium_solve(system, &e, &message), &message);
  for (int i = 0; i < trb_state_size(system); i++) state[i] = 0.0;
  const double orbit = m->geometry.cage_speed_ratio * shaft_speed, angle = m->geometry.roller_axis_angle;
  for (int j = 0; j < m->n_rollers; j++) {
    double       *y = state + trb_state_roller(system, j);
    const double *at = rollers + (size_t)TRB_ROLLER_FREEDOMS * (size_t)j, tilt = at[2];
    y[TRB_ROLLER_r] = at[0], y[TRB_ROLLER_z] = at[1], y[TRB_ROLLER_tilt] = tilt;
    y[TRB_ROLLER_v_t] = orbit * at[0];
    y[TRB_ROLLER_omega_n] = -orbit * (sin(angle + tilt) - sin(angle)), y[TRB_ROLLER_omega_a] = orbit * (cos(angle + tilt) - cos(angle));
  }
  return e.displacement[2];
}

void rig_disturb(const trb_system *system, unsigned long long *seed, double *state)
{
  const trb_model    *m = system->model;
  static const double roller[TRB_ROLLER_SIZE] = {5e-7, 2e-4, 1e-6, 2e-4, 2e-5, 1e-3, 2e-2, 1e-3, 2.0, 2.0, 8.0};
  static const double cage[TRB_CAGE_SIZE] = {2e-5, 2e-5, 2e-5, 3e-4, 3e-4, 3e-4, 1e-2, 1e-2, 1e-2, 1.0, 1.0, 1.0};
  for (int j = 0; j < m->n_rollers; j++)
    for (int i = 0; i < TRB_ROLLER_SIZE; i++) state[trb_state_roller(system, j) + i] += roller[i] * rig_random(seed);
  for (int i = 0; i < TRB_CAGE_SIZE; i++) state[rig_cage(system) + i] += cage[i] * rig_random(seed);
  /* beyond what rollers at their places allow: 0.108 mm */
  state[rig_cage(system) + TRB_CAGE_x] += 1.2e-4;
}

trb_dynamics *rig_dynamics(const trb_system *system, const trb_motion *motion)
{
  trb_message   message;
  trb_dynamics *d;
  need(trb_dynamics_create(system, motion, "scalar", &d, &message), &message);
  return d;
}

trb_jacobian *rig_jacobian(const trb_system *system, const trb_motion *motion)
{
  trb_message   message;
  trb_jacobian *jacobian;
  need(trb_jacobian_create(system, motion, "scalar", &jacobian, &message), &message);
  return jacobian;
}

trb_arrow *rig_arrow(const trb_system *system)
{
  trb_message message;
  trb_arrow  *arrow;
  need(trb_arrow_create(system->layout.n_rollers, system->layout.hub_width, &arrow, &message), &message);
  return arrow;
}

trb_detail *rig_detail(const trb_system *system)
{
  trb_message message;
  trb_detail *detail;
  need(trb_detail_create(system->model, system->pairs, system->n_pairs, &detail, &message), &message);
  return detail;
}

trb_status rig_create(const trb_system *system, const trb_motion *motion, const char *kind, const char *variant,
                      const trb_settings *settings, double time, const double *state, trb_simulation **simulation, trb_message *message)
{
  const trb_system *const systems[TRB_MOST_MEMBERS] = {system};
  const trb_motion *const motions[TRB_MOST_MEMBERS] = {motion};
  return trb_simulation_create(systems, motions, 1, kind, variant, settings, time, state, trb_state_size(system), simulation, message);
}

trb_simulation *rig_simulation(const trb_system *system, const trb_motion *motion, const char *kind, const trb_settings *settings,
                               const double *y)
{
  trb_message     message;
  trb_simulation *simulation;
  need(rig_create(system, motion, kind, "", settings, 0.0, y, &simulation, &message), &message);
  return simulation;
}

void rig_run(trb_simulation *simulation, double until)
{
  trb_message message;
  while (simulation->integrator.time < until) need(trb_simulation_step(simulation, &message), &message);
}

rig_bench rig_open(const trb_params *params, double load)
{
  rig_bench b = {.system = rig_system(params)};
  if (trb_state_size(b.system) > RIG_ROOM) exit(1);
  b.motion = rig_motion(rig_state(b.system, load, 100 * TRB_PI, b.start), 100 * TRB_PI);
  b.d = rig_dynamics(b.system, b.motion);
  return b;
}

void rig_close(rig_bench *bench)
{
  trb_dynamics_free(bench->d);
  trb_motion_free(bench->motion);
  rig_free(bench->system);
}

double rig_balance(const trb_system *system, const trb_motion *motion, double time, const double *y)
{
  const double *q = y + trb_state_quadrature(system);
  trb_dynamics *d = rig_dynamics(system, motion);
  trb_dynamics_pose(d, time, y);
  trb_dynamics_loads(d, NULL, NULL);
  double sum = trb_audit_kinetic(d) + trb_audit_elastic(d) - q[TRB_Q_work_shaft] - q[TRB_Q_work_ring] - q[TRB_Q_work_gravity];
  for (int k = 0; k < system->model->n_losses; k++) sum += q[TRB_Q_losses + k];
  trb_dynamics_free(d);
  return sum;
}

double rig_jacobian_off(const trb_system *system, const trb_motion *motion, double time, double *y)
{
  trb_dynamics *d = rig_dynamics(system, motion);
  trb_jacobian *jacobian = rig_jacobian(system, motion);
  trb_arrow    *arrow = rig_arrow(system);
  trb_jacobian_fill(jacobian, time, y, 1, arrow);
  const double error = rig_jacobian_error(&d, 1, arrow, time, y);
  trb_arrow_free(arrow);
  trb_jacobian_free(jacobian);
  trb_dynamics_free(d);
  return error;
}

/* Largest force of a roller on the cage at a state. */
static double largest_push(trb_dynamics *d, const double *y)
{
  double largest = 0.0;
  trb_dynamics_pose(d, 0.01, y);
  trb_dynamics_loads(d, NULL, NULL);
  for (int j = 0; j < d->model->n_rollers; j++) largest = fmax(largest, trb_norm(d->loads[j].on[TRB_BODY_CAGE].force));
  return largest;
}

void rig_draw_back(trb_dynamics *d, double most, const double *to, double *y)
{
  const int n = trb_state_main_size(d->system);
  for (int step = 0; step < 4000 && largest_push(d, y) > most; step++)
    for (int i = 0; i < n; i++) y[i] += 1e-3 * (to[i] - y[i]);
}

/* A linear congruential sequence, its bits mixed. */
double rig_random(unsigned long long *seed)
{
  unsigned long long x = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
  *seed = x;
  x ^= x >> 33;
  x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33;
  return (double)(x >> 11) / 4503599627370496.0 - 1.0;
}

void rig_expand(const trb_arrow *a, int stride, double *whole)
{
  const int hub = a->n * TRB_NR;
  for (int i = 0; i < hub + a->width; i++) memset(whole + (size_t)i * (size_t)stride, 0, (size_t)(hub + a->width) * sizeof *whole);
  for (int j = 0; j < a->n; j++)
    for (int i = 0; i < TRB_NR; i++) {
      double *row = whole + (size_t)(j * TRB_NR + i) * (size_t)stride;
      for (int c = 0; c < TRB_NR; c++) row[j * TRB_NR + c] = a->rollers[j].own[c][i];
      for (int c = 0; c < a->width; c++) {
        if (!(a->borders[j].parts >> c / TRB_NP & 1U)) continue;
        row[hub + c] = a->borders[j].to_hub[c * TRB_NR + i];
        whole[(size_t)(hub + c) * (size_t)stride + (size_t)(j * TRB_NR + i)] = a->borders[j].from[i * a->room + c];
      }
    }
  for (int c = 0; c < a->width; c++)
    for (int i = 0; i < a->width; i++) whole[(size_t)(hub + i) * (size_t)stride + (size_t)(hub + c)] = a->hub[c * a->room + i];
}

/* Kind of an entry that one of the systems has. */
static trb_tolerance kind_of(trb_dynamics *const *d, int n, int entry)
{
  for (int k = 0; k < n; k++) {
    const trb_tolerance kind = trb_state_tolerance(d[k]->system, entry);
    if (kind != TRB_TOL_QUADRATURE) return kind;
  }
  return TRB_TOL_QUADRATURE;
}

static void rates_of(trb_dynamics *const *d, int n, double time, const double *y, double *rates)
{
  for (int k = 0; k < n; k++) trb_rhs(d[k], NULL, time, y, rates);
}

double rig_jacobian_error(trb_dynamics *const *d, int n, const trb_arrow *a, double time, double *y)
{
  static const double unit[TRB_N_TOLERANCES] = {1e-9, 1e-7, 1e-5, 1e-3, 1.0};
  enum { MOST = 320 };
  static double found[MOST][MOST], dense[MOST][MOST];
  double        low[2 * MOST], high[2 * MOST], worst = 0.0;
  const int     all = trb_state_main_size(d[0]->system);
  if (all > MOST || trb_state_size(d[0]->system) > 2 * MOST) return INFINITY;
  rig_expand(a, MOST, &found[0][0]);
  for (int c = 0; c < all; c++) {
    const double of = unit[kind_of(d, n, c)], was = y[c];
    y[c] = was + 0.05 * of;
    rates_of(d, n, time, y, high);
    y[c] = was - 0.05 * of;
    rates_of(d, n, time, y, low);
    y[c] = was;
    for (int i = 0; i < all; i++) {
      const double per = unit[kind_of(d, n, i)];
      dense[i][c] = (high[i] - low[i]) / 0.1 / per;
      found[i][c] *= of / per;
    }
  }
  for (int i = 0; i < all; i++) {
    double largest = 0.0, off = 0.0;
    for (int c = 0; c < all; c++) largest = fmax(largest, fabs(dense[i][c])), off = fmax(off, fabs(found[i][c] - dense[i][c]));
    /* rows of rates that nothing changes have rounding alone */
    worst = fmax(worst, off / (largest + 1e-9));
  }
  return worst;
}

void rig_note(rig_tried *tried, double change, double bound)
{
  if (!(bound > 0.0)) return;
  tried->tightest = fmax(tried->tightest, change / bound);
  tried->mean += change / bound;
  tried->n++;
}
