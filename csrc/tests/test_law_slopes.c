/* Slopes of the laws of raceway contacts: forces that follow them have the slopes of the forces themselves. */
#include "check.h"
#include "laws/profile.h"
#include "laws/rolling_resistance.h"
#include "rig.h"

static unsigned long long seed = 11;

/* Steps by which differences of fourth order are taken: position, angle, velocity, spin. */
static const double steps[TRB_N_TOLERANCES] = {1e-9, 1e-7, 1e-6, 1e-4, 1.0};

/* Slopes of a roller's flow over one of its coordinates. */
static void slopes_of(trb_dynamics *d, int roller, int c, double *y, double *slopes)
{
  const trb_instant at = trb_dynamics_instant(d, &roller, 1);
  const double weights[4] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0}, was = y[c], h = steps[trb_roller_coordinates[c].tolerance];
  memset(slopes, 0, TRB_FLOW_SIZE * sizeof *slopes);
  for (int k = 0; k < 4; k++) {
    double flow[TRB_FLOW_SIZE];
    y[c] = was + h * (k < 2 ? k - 2 : k - 1);
    trb_dynamics_pose_roller(d, roller, y);
    trb_dynamics_slow(d, &at, TRB_ANY_BODY, NULL);
    trb_dynamics_roller_flow(d, roller, &d->loads[roller], flow);
    for (int i = 0; i < TRB_FLOW_SIZE; i++) slopes[i] += weights[k] / h * flow[i];
  }
  y[c] = was;
  trb_dynamics_pose_roller(d, roller, y);
}

/* Largest difference between slopes along those of the laws and slopes of the forces, of all rollers of a disturbed state; each entry of a flow over
 * the largest that any coordinate gives by a step. */
static double slopes_off(const trb_params *params)
{
  rig_bench         b = rig_open(params, 4930.0);
  trb_memory        memory = {0};
  double            worst = 0.0, y[RIG_ROOM];
  const trb_instant at = trb_dynamics_instant(b.d, b.d->everyone, b.d->model->n_rollers);
  memcpy(y, b.start, sizeof y);
  rig_disturb(b.system, &seed, y);
  trb_law_slopes_create(b.system->model, &memory, b.d->work);
  if (!CHECK(b.d->work->laws != NULL)) return INFINITY;
  trb_dynamics_pose(b.d, 0.0, y);
  b.d->work->laws_use = TRB_LAWS_KEPT;
  trb_dynamics_slow(b.d, &at, TRB_ANY_BODY, NULL);
  for (int j = 0; j < b.system->model->n_rollers; j++) {
    double *own = y + trb_state_roller(b.system, j), exact[TRB_NR][TRB_FLOW_SIZE], along[TRB_NR][TRB_FLOW_SIZE];
    for (int c = 0; c < TRB_NR; c++) {
      b.d->work->laws_use = TRB_LAWS_EXACT;
      slopes_of(b.d, j, c, own, exact[c]);
      b.d->work->laws_use = TRB_LAWS_FOLLOWED;
      slopes_of(b.d, j, c, own, along[c]);
    }
    for (int i = 0; i < TRB_FLOW_SIZE; i++) {
      double largest = 0.0, off = 0.0;
      for (int c = 0; c < TRB_NR; c++) {
        const double h = steps[trb_roller_coordinates[c].tolerance];
        largest = fmax(largest, fabs(exact[c][i]) * h);
        off = fmax(off, fabs(along[c][i] - exact[c][i]) * h);
      }
      if (largest > 0.0) worst = fmax(worst, off / largest);
    }
  }
  trb_memory_free(&memory);
  rig_close(&b);
  return worst;
}

int main(void)
{
  const trb_params paper = rig_params();
  trb_params       cases[9];
  for (int k = 0; k < 9; k++) cases[k] = k == 7 ? rig_cylinder() : paper;
  for (int k = 1; k < 9; k++) {
    cases[k].effects.quadrature = TRB_QUADRATURE_GAUSS;
    cases[k].effects.n_slices = 16;
    cases[k].effects.rolling_resistance = TRB_ROLLING_LINE_SOLUTION;
    cases[k].effects.rolling_pressure_force = 1.0;
    cases[k].effects.thermal = 1.0;
    cases[k].effects.damping = 2.0;
  }
  cases[2].effects.lubrication = TRB_LUBRICATION_DRY;
  cases[3].effects.oil_height = 20e-6;
  cases[4].effects.rolling_resistance = TRB_ROLLING_BIBOULET_HOUPERT;
  cases[5].oil.viscosity = 0.002; /* mixed friction */
  cases[6].effects.thermal = 0.0;
  cases[8].effects.rolling_resistance = TRB_ROLLING_ZHOU_HOEPRICH; /* sets in with the film of the deepest node */
  for (int k = 0; k < 9; k++) {
    const double off = slopes_off(&cases[k]);
    if (!CHECK(off < 2e-6)) printf("case %d: %g\n", k, off);
  }
  /* laws that join the nodes of a contact have no slopes of their own */
  cases[1].effects.flooded_gaps = 1.0;
  rig_bench  b = rig_open(&cases[1], 4930.0);
  trb_memory memory = {0};
  trb_law_slopes_create(b.system->model, &memory, b.d->work);
  CHECK(b.d->work->laws == NULL);
  rig_close(&b);
  return check_report();
}
