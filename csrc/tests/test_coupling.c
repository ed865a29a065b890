/* Slopes of the loads between a roller and its pocket with every coordinate of either, against differences of those loads. */
#include "stepping/coupling.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"

enum { ROWS = 12, COLUMNS = TRB_ROLLER_SIZE + TRB_CAGE_SIZE };

static unsigned long long seed = 41;

/* A roller's force in its cylindrical frame, its moment in its own, and the cage's force and moment in R. */
static void rows_of(const trb_frame *frame, const trb_load *load, double *rows)
{
  const trb_vec3 moment = trb_to_frame(frame, load->on_a.moment);
  const double   all[ROWS] = {load->on_a.force.x,
                              load->on_a.force.y,
                              load->on_a.force.z,
                              moment.x,
                              moment.y,
                              moment.z,
                              load->on_b.force.x,
                              load->on_b.force.y,
                              load->on_b.force.z,
                              load->on_b.moment.x,
                              load->on_b.moment.y,
                              load->on_b.moment.z};
  memcpy(rows, all, sizeof all);
}

static int loads_at(trb_dynamics *d, int roller, const double *y, trb_load *load, trb_slopes *slopes)
{
  trb_counters counters = {0};
  trb_dynamics_pose(d, 0.01, y);
  const trb_instant at = trb_dynamics_instant(d, NULL, 0);
  const trb_gaps    gaps = trb_contact_pocket_of(d->model, &d->system->pairs[TRB_PAIR_pocket], &at, roller, &counters, load, slopes, NULL);
  return !trb_gaps_clear(&gaps) && trb_norm(load->on_b.force) > 0.0;
}

static int entry_of(const trb_system *system, int roller, int column)
{
  return column < TRB_ROLLER_SIZE ? trb_state_roller(system, roller) + column : rig_cage(system) + column - TRB_ROLLER_SIZE;
}

static int is_place(int column) { return column < TRB_ROLLER_SIZE ? column < TRB_ROLLER_v_r : column - TRB_ROLLER_SIZE < TRB_CAGE_v_x; }

/* Central differences by a micrometre's thousandth; 0 where the roller leaves its pocket within them. */
static int differentiate(trb_dynamics *d, int roller, const double *y, double (*slopes)[ROWS])
{
  static const double share[TRB_N_TOLERANCES] = {1e-10, 1e-8, 1e-6, 1e-4, 0};
  const trb_system   *system = d->system;
  double              moved[512], low[ROWS], high[ROWS];
  trb_load            load;
  memcpy(moved, y, (size_t)trb_state_size(system) * sizeof *y);
  for (int c = 0; c < COLUMNS; c++) {
    const int    at = entry_of(system, roller, c);
    const double h = share[trb_state_tolerance(system, at)];
    for (int side = 0; side < 2; side++) {
      moved[at] = y[at] + (side == 0 ? -h : h);
      if (!loads_at(d, roller, moved, &load, NULL)) return 0;
      rows_of(&d->rollers[roller].frame, &load, side == 0 ? low : high);
    }
    moved[at] = y[at];
    for (int i = 0; i < ROWS; i++) slopes[c][i] = (high[i] - low[i]) / (2.0 * h);
  }
  return 1;
}

/* Tolerances: of places and of velocities, over the largest slope of a row with any of them, 10 mm standing for a radian; besides,
 * rounding of the differences. */
typedef struct bound {
  double place, velocity;
} bound;

static void compare(const trb_system *system, int roller, double (*found)[ROWS], double (*exact)[ROWS], const bound *b)
{
  for (int places = 0; places < 2; places++)
    for (int i = 0; i < ROWS; i++) {
      double largest = 0.0, off = 0.0;
      for (int c = 0; c < COLUMNS; c++) {
        const trb_tolerance kind = trb_state_tolerance(system, entry_of(system, roller, c));
        const double        unit = kind != TRB_TOL_POSITION && kind != TRB_TOL_VELOCITY ? 100.0 : 1.0;
        if (is_place(c) != places) continue;
        largest = fmax(largest, unit * fabs(exact[c][i]));
        off = fmax(off, unit * fabs(found[c][i] - exact[c][i]));
      }
      CHECK_NEAR(off, 0.0, places ? b->place * largest + 10.0 : b->velocity * largest + 1e-3);
    }
}

/* most: force of a roller on the cage, N; shift: of the cage along the axis, which its ends take up, m. */
static void check_scene(const trb_params *params, double most, double shift, const bound *within)
{
  rig_bench        b = rig_open(params, 4930.0);
  const trb_model *m = b.system->model;
  double           y[RIG_ROOM], found[COLUMNS][ROWS], exact[COLUMNS][ROWS];
  int              checked = 0;
  for (int trial = 0; trial < 40 && checked < 60; trial++) {
    memcpy(y, b.start, sizeof y);
    rig_disturb(b.system, &seed, y);
    y[rig_cage(b.system) + TRB_CAGE_z] += shift;
    rig_draw_back(b.d, most, b.start, y);
    for (int j = 0; j < m->n_rollers; j++) {
      trb_load     load;
      trb_coupling k;
      k.slopes.modal = NULL;
      if (!loads_at(b.d, j, y, &load, NULL) || !differentiate(b.d, j, y, exact) || !loads_at(b.d, j, y, &load, &k.slopes)) continue;
      trb_coupling_place(&k, &b.d->rollers[j], &b.d->system->bodies[TRB_BODY_CAGE], &b.d->bodies[TRB_BODY_CAGE].pose, &load);
      for (int c = 0; c < COLUMNS; c++) {
        const trb_load slope = c < TRB_ROLLER_SIZE ? trb_coupling_of_roller(&k, c) : trb_coupling_of_body(&k, c - TRB_ROLLER_SIZE);
        rows_of(&b.d->rollers[j].frame, &slope, found[c]);
      }
      compare(b.system, j, found, exact, within);
      checked++;
    }
  }
  CHECK(checked > 30);
  rig_close(&b);
}

int main(void)
{
  trb_params p = rig_params();
  /* without friction and edges nothing is left out: loads of kilonewtons, too */
  p.effects.lubrication = 0, p.friction.dry_friction = 0, p.pocket.edges = 0;
  for (int side = -1; side <= 1; side++) check_scene(&p, 3000.0, 1e-3 * side, &(bound){2e-3, 1e-3});
  /* at edges normals turn; sliding turns with the bodies */
  p = rig_params();
  check_scene(&p, 30.0, 0.0, &(bound){3e-2, 1e-4});
  p.effects.lubrication = 0, p.friction.dry_friction = 0.1;
  check_scene(&p, 30.0, 0.0, &(bound){3e-2, 1e-4});
  p.effects.damping = 1, p.pocket.damping = 2.0;
  check_scene(&p, 30.0, 0.0, &(bound){3e-2, 1e-4});
  return check_report();
}
