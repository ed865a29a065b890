/* Clearances: as long as one holds nothing touches, wherever bodies have moved since it was found. */
#include "motion/clearance.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"

enum { MOST = 512 };

static unsigned long long seed = 23;

/* Lower bounds of a roller's gaps at a state, and whether its pocket pushes. */
static trb_gaps gaps_at(trb_dynamics *d, int roller, const double *y, int *touches)
{
  trb_load     load = {0};
  trb_counters counters = {0};
  trb_dynamics_pose(d, 0.0, y);
  const trb_instant at = trb_dynamics_instant(d);
  const trb_gaps    gaps = trb_contact_pocket_of(d->model, &d->system->pairs[TRB_PAIR_pocket], &at, roller, &counters, &load, NULL, NULL);
  *touches = trb_norm(load.on_b.force) > 0.0 || counters.pocket_nodes > 0;
  return gaps;
}

/* From a state without contact, on along a random direction of all coordinates until the clearance ends. */
static void walk(const trb_system *system, trb_dynamics *d, const double *start, const double *unit, int *held, int *reached)
{
  const trb_model   *m = system->model;
  trb_clearance_arms arms[TRB_N_GAPS];
  double             direction[MOST] = {0}, y[MOST];
  trb_pair_pocket.clearance(m, arms);
  const int only = (int)(11.0 * (0.5 + 0.5 * rig_random(&seed))), alone = rig_random(&seed) > 0.0;
  for (int i = 0; i < TRB_CLEARANCE_BODY; i++) direction[rig_cage(system) + i] = unit[TRB_CLEARANCE_ROLLER + i] * rig_random(&seed);
  for (int j = 0; j < m->n_rollers; j++)
    for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) direction[trb_state_roller(system, j) + i] = unit[i] * rig_random(&seed);
  for (int j = 0; j < m->n_rollers; j++) {
    trb_clearance c;
    int           touches;
    memcpy(y, start, sizeof y);
    const trb_gaps gaps = gaps_at(d, j, y, &touches);
    CHECK(!(trb_gaps_clear(&gaps) && touches));
    trb_clearance_set(m, &c, &gaps, y + trb_state_roller(system, j), y + rig_cage(system));
    if (!trb_gaps_clear(&gaps)) {
      CHECK(!trb_clearance_holds(&c, arms, NULL, y + trb_state_roller(system, j), y + rig_cage(system)));
      continue;
    }
    for (double along = 0.0; along < 40.0; along += 0.02) {
      for (int i = 0; i < TRB_CLEARANCE_BODY; i++)
        if (!alone || only == TRB_CLEARANCE_ROLLER + i)
          y[rig_cage(system) + i] = start[rig_cage(system) + i] + along * direction[rig_cage(system) + i];
      for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++)
        if (!alone || only == i)
          y[trb_state_roller(system, j) + i] = start[trb_state_roller(system, j) + i] + along * direction[trb_state_roller(system, j) + i];
      const int      holds = trb_clearance_holds(&c, arms, NULL, y + trb_state_roller(system, j), y + rig_cage(system));
      const trb_gaps now = gaps_at(d, j, y, &touches);
      if (holds) {
        ++*held;
        CHECK(!touches);
        CHECK(trb_gaps_clear(&now));
      } else {
        *reached += touches;
        if (touches) break;
      }
    }
  }
}

static void check_scene(const trb_params *params)
{
  /* so that each coordinate alone moves surfaces by some tens of micrometres */
  static const double unit[TRB_CLEARANCE_ROLLER + TRB_CLEARANCE_BODY] = {2e-5, 5e-4, 2e-5, 1e-3, 1e-3, 2e-5, 2e-5, 2e-5, 5e-4, 5e-4, 5e-4};
  const double        speed = 100 * TRB_PI;
  trb_system         *system = rig_system(params);
  trb_dynamics       *d;
  double              y[MOST], start[MOST];
  trb_motion         *motion = rig_motion(rig_state(system, 4930.0, speed, y), speed);
  int                 held = 0, reached = 0;
  if (!CHECK(trb_dynamics_create(system, motion, "scalar", &d, NULL) == TRB_OK)) return;
  for (int trial = 0; trial < 12; trial++) {
    memcpy(start, y, sizeof start);
    if (trial % 3 == 0) rig_disturb(system, &seed, start);
    for (int i = 0; i < TRB_CLEARANCE_BODY; i++) start[rig_cage(system) + i] += unit[TRB_CLEARANCE_ROLLER + i] * rig_random(&seed);
    walk(system, d, start, unit, &held, &reached);
  }
  CHECK(held > 1000);
  CHECK(reached > 50);
  trb_dynamics_free(d);
  trb_motion_free(motion);
  rig_free(system);
}

/* Not a number, and displacements beyond those that the arms are made for, prove nothing. */
static void test_limits(void)
{
  const trb_params   p = rig_params();
  trb_system        *system = rig_system(&p);
  const trb_model   *m = system->model;
  trb_clearance_arms arms[TRB_N_GAPS];
  const trb_gaps     near = {{1e-4, 1e-4}}, unknown = {{1e-4, (double)NAN}};
  double             roller[TRB_ROLLER_SIZE] = {0}, cage[TRB_CAGE_SIZE] = {0};
  trb_clearance      c;
  trb_pair_pocket.clearance(m, arms);
  trb_clearance_set(m, &c, &near, roller, cage);
  CHECK(trb_clearance_holds(&c, arms, NULL, roller, cage));
  trb_clearance_set(m, &c, &unknown, roller, cage);
  CHECK(!trb_clearance_holds(&c, arms, NULL, roller, cage));
  trb_clearance_set(m, &c, &near, roller, cage);
  cage[TRB_CAGE_psi] = NAN;
  CHECK(!trb_clearance_holds(&c, arms, NULL, roller, cage));
  cage[TRB_CAGE_psi] = 0.0, cage[TRB_CAGE_x] = 1.0;
  trb_clearance_set(m, &c, &near, roller, cage);
  CHECK(!trb_clearance_holds(&c, arms, NULL, roller, cage));
  rig_free(system);
}

/* A cage leans about its centre of mass: as far as that is from its middle plane, to either side, its pockets are further away. */
static void test_lean(void)
{
  double lean[3][TRB_N_GAPS];
  for (int k = 0; k < 3; k++) {
    trb_clearance_arms arms[TRB_N_GAPS];
    trb_params         p = rig_params();
    p.cage_offset = 5e-3 * (k - 1);
    trb_model *m = rig_model(&p);
    trb_pair_pocket.clearance(m, arms);
    for (int g = 0; g < TRB_N_GAPS; g++) {
      CHECK(arms[g].body[TRB_CAGE_skew] == arms[g].body[TRB_CAGE_tilt]);
      lean[k][g] = arms[g].body[TRB_CAGE_skew];
    }
    trb_model_free(m);
  }
  for (int g = 0; g < TRB_N_GAPS; g++) {
    CHECK_NEAR(lean[0][g] - lean[1][g], 5e-3, 1e-15);
    CHECK_NEAR(lean[2][g] - lean[1][g], 5e-3, 1e-15);
  }
}

int main(void)
{
  trb_params p = rig_params();
  check_scene(&p);
  p.pocket_edges = 0;
  check_scene(&p);
  p = rig_params(), p.n_slices = 8, p.cage_offset = 3e-3;
  check_scene(&p);
  test_limits();
  test_lean();
  p = rig_cylinder();
  check_scene(&p);
  return check_report();
}
