/* Vectorised kernels against the scalar one: the same wrenches, energies and losses, for every set of effects.
 *
 * They differ by rounding alone. Interference d is a difference of lengths of L = 0.25 m, so that its relative error is eps L/d, and
 * that of the load 10/9 of it; functions of the vector libraries (up to 4 ulp) and products that are fused or summed in another order
 * add some eps, friction some more where slip is a small difference of surface speeds. The bound is ROUNDINGS eps L/d of the load. */
#include "contact/kernels.h"

#include <float.h>
#include <stdlib.h>

#include "check.h"
#include "rig.h"

#define ROUNDINGS 1.0
#define LENGTH 0.25

static unsigned long long seed = 17;
static double             worst;

static void near(const char *what, const char *variant, double value, double expected, double scale, double bound)
{
  const double off = fabs(value - expected) / scale;
  worst = fmax(worst, off / bound);
  if (!CHECK_NEAR(off, 0.0, bound)) printf("  %s of %s: %.17g, scalar %.17g\n", what, variant, value, expected);
}

static void near_vector(const char *what, const char *variant, trb_vec3 value, trb_vec3 expected, double scale, double bound)
{
  near(what, variant, value.x, expected.x, scale, bound);
  near(what, variant, value.y, expected.y, scale, bound);
  near(what, variant, value.z, expected.z, scale, bound);
}

static void compare(const trb_system *system, const char *variant, const trb_dynamics *exact, const trb_dynamics *other,
                    const trb_detail *detail)
{
  const trb_model   *m = system->model;
  const trb_contact *ribs = trb_pair_contacts(m, &system->pairs[TRB_PAIR_rib], detail);
  for (int j = 0; j < m->n_rollers; j++) {
    const trb_loads *a = &exact->loads[j], *b = &other->loads[j];
    double           load = 1.0, deepest = 0.0, speed = 1e-3;
    for (int race = 0; race < TRB_N_RACES; race++) {
      const double *q = trb_detail_lane(m, detail, TRB_LANE_load, race, j), *d = trb_detail_lane(m, detail, TRB_LANE_interference, race, j);
      const double *v = trb_detail_lane(m, detail, TRB_LANE_mean_speed, race, j);
      for (int k = 0; k < m->n_lanes; k++) load += q[k], deepest = fmax(deepest, d[k]), speed = fmax(speed, v[k]);
    }
    load += ribs[j].load;
    if (ribs[j].interference > 0.0) deepest = fmin(fmax(deepest, 1e-7), ribs[j].interference);
    const double bound = ROUNDINGS * DBL_EPSILON * LENGTH / fmax(deepest, 1e-7), arm = 0.5 * m->params.bearing.pitch_diameter;
    near_vector("force", variant, b->roller.force, a->roller.force, load, bound);
    near_vector("moment", variant, b->roller.moment, a->roller.moment, load * arm, bound);
    near_vector("ring_force", variant, b->on[TRB_BODY_INNER_RING].force, a->on[TRB_BODY_INNER_RING].force, load, bound);
    near_vector("ring_moment", variant, b->on[TRB_BODY_INNER_RING].moment, a->on[TRB_BODY_INNER_RING].moment, load * arm, bound);
    near_vector("outer_force", variant, b->on[TRB_BODY_OUTER_RING].force, a->on[TRB_BODY_OUTER_RING].force, load, bound);
    near_vector("outer_moment", variant, b->on[TRB_BODY_OUTER_RING].moment, a->on[TRB_BODY_OUTER_RING].moment, load * LENGTH, bound);
    near("elastic", variant, b->elastic, a->elastic, load * fmax(deepest, 1e-7), 3.0 * bound);
    for (int k = 0; k < TRB_N_TORQUES; k++) near("torque", variant, b->torque[k], a->torque[k], load * arm, bound);
    for (int k = 0; k < TRB_N_LOSSES; k++) near("power", variant, b->power[k], a->power[k], load * speed, bound);
  }
}

/* Any choice of rollers has the loads that they have among all; the others' loads are left alone. */
static void check_choice(trb_dynamics *d)
{
  const trb_model *m = d->model;
  trb_instant      at = trb_dynamics_instant(d, d->everyone, m->n_rollers);
  trb_loads        all[12];
  int              chosen[12], taken[12] = {0};
  trb_dynamics_slow(d, &at, TRB_ANY_BODY, NULL);
  memcpy(all, d->loads, sizeof all);
  memset(d->loads, 0x55, sizeof all);
  at = trb_dynamics_instant(d, chosen, 0);
  for (int j = 0; j < m->n_rollers; j++) {
    taken[j] = rig_random(&seed) > 0.3;
    if (taken[j]) chosen[at.n++] = j;
  }
  trb_dynamics_slow(d, &at, TRB_ANY_BODY, NULL);
  for (int j = 0; j < m->n_rollers; j++) {
    const double *one = (const double *)&all[j], *other = (const double *)&d->loads[j];
    trb_loads     untouched;
    memset(&untouched, 0x55, sizeof untouched);
    if (!taken[j]) CHECK(memcmp(&d->loads[j], &untouched, sizeof untouched) == 0);
    for (size_t i = 0; taken[j] && i < sizeof all[j] / sizeof *one; i++) CHECK_NEAR(other[i], one[i], 1e-12 * fabs(one[i]));
  }
}

static void check_scene(const char *name, const trb_params *params, double speed)
{
  trb_system      *system = rig_system(params);
  const trb_model *m = system->model;
  double           y[512];
  trb_motion      *motion = rig_motion(rig_state(system, 4930.0, speed, y), speed);
  trb_detail      *detail;
  trb_dynamics    *exact;
  if (!CHECK(trb_dynamics_create(system, motion, "scalar", &exact, NULL) == TRB_OK &&
             trb_detail_create(m, system->pairs, system->n_pairs, &detail, NULL) == TRB_OK))
    return;
  for (int i = 0; i < 20; i++) {
    double disturbed[512];
    memcpy(disturbed, y, sizeof y);
    rig_disturb(system, &seed, disturbed);
    trb_detail_clear(m, detail);
    trb_dynamics_pose(exact, 0.01, disturbed);
    trb_dynamics_loads(exact, NULL, detail);
    for (int v = 0; v < trb_n_kernel_variants; v++) {
      trb_dynamics *other;
      if (!trb_kernel_runs(v)) continue;
      const char *variant = trb_kernel_variants[v].name;
      if (!CHECK(trb_dynamics_create(system, motion, variant, &other, NULL) == TRB_OK)) continue;
      trb_dynamics_pose(other, 0.01, disturbed);
      trb_dynamics_loads(other, NULL, NULL);
      compare(system, variant, exact, other, detail);
      memset(&other->work->counters, 0, sizeof other->work->counters);
      check_choice(other);
      memset(&other->work->counters, 0, sizeof other->work->counters);
      trb_dynamics_loads(other, NULL, NULL);
      /* what is evaluated is the same, too */
      trb_counters a = exact->work->counters, b = other->work->counters;
      memset(&exact->work->counters, 0, sizeof a);
      trb_dynamics_loads(exact, NULL, NULL);
      a = exact->work->counters;
      CHECK(memcmp(&a, &b, sizeof a) == 0);
      trb_dynamics_free(other);
    }
  }
  printf("%-12s %.2f of the bound\n", name, worst);
  worst = 0.0;
  trb_detail_free(detail);
  trb_dynamics_free(exact);
  trb_motion_free(motion);
  rig_free(system);
}

static void test_choice(void)
{
  const trb_params p = rig_params();
  trb_system      *system = rig_system(&p);
  trb_workspace   *work;
  trb_message      message;
  int              fastest = 0;
  for (int v = 0; v < trb_n_kernel_variants; v++)
    if (trb_kernel_runs(v)) fastest = v;
  CHECK(trb_n_kernel_variants >= 2);
  CHECK(strcmp(trb_kernel_variants[0].name, "scalar") == 0 && trb_kernel_runs(0) && trb_kernel_runs(1));
  CHECK(!trb_kernel_runs(-1) && !trb_kernel_runs(trb_n_kernel_variants));
  CHECK(trb_workspace_create(system->pairs, system->n_pairs, "", &work, &message) == TRB_OK && work->variant == fastest);
  trb_workspace_free(work);
  CHECK(trb_workspace_create(system->pairs, system->n_pairs, "mmx", &work, &message) == TRB_ERR_INPUT && work == NULL);
  CHECK_SAYS(message.text, "instruction_set = 'mmx'");
  trb_workspace_free(NULL);
  rig_free(system);
}

int main(void)
{
  const double     speed = 100 * TRB_PI;
  const trb_params paper = rig_params();
  trb_params       p = paper;
  test_choice();
  check_scene("paper", &p, speed);
  check_scene("standstill", &p, 0.0);
  p.effects.damping = 1, p.effects.rolling_pressure_force = 1, p.effects.rib_film = 1, p.effects.quadrature = 1, p.effects.n_slices = 16;
  check_scene("standard", &p, speed);
  p = paper, p.effects.n_slices = 5, p.roller.profile = 1, p.roller.crown_radius = 30.0, p.effects.starvation_factor = 0.2;
  check_scene("starved", &p, speed);
  p = paper, p.oil.viscosity_law = 1, p.effects.n_slices = 200;
  check_scene("roelands", &p, speed);
  p = paper, p.oil.viscosity_law = 2, p.effects.n_slices = 1;
  check_scene("barus", &p, speed);
  p = paper, p.effects.lubrication = 3, p.effects.traction = 1, p.effects.thermal = 0;
  check_scene("coulomb", &p, speed);
  p = paper, p.effects.lubrication = 1, p.effects.rolling_resistance = 0, p.effects.thermal = 0;
  check_scene("boundary", &p, speed);
  p = paper, p.effects.lubrication = 0, p.effects.rolling_resistance = 0, p.effects.thermal = 0;
  check_scene("dry", &p, speed);
  p = paper, p.effects.lubrication = 3, p.effects.traction = 0, p.effects.rolling_resistance = 0;
  check_scene("frictionless", &p, speed);
  p = paper, p.effects.back_rib = 0, p.effects.front_rib = 0, p.roller.profile = 0;
  check_scene("no ribs", &p, speed);
  return check_report();
}
