/* The structured Jacobian against differences of the whole right-hand side, an entry of the state at a time: every coupling is there,
 * and nothing else is. */
#include "stepping/jacobian.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"

enum { MOST = 12 * TRB_NR + TRB_CAGE_SIZE };

/* Tolerances of a run, by kind: what makes rows and columns comparable. */
static const double       unit[TRB_N_TOLERANCES] = {1e-9, 1e-7, 1e-5, 1e-3, 1.0};
static unsigned long long seed = 5;
static double             dense[MOST][MOST], found[MOST][MOST];

/* d rates / d state by central differences with a share of the unit, in units of the tolerances, row over column. */
static void differentiate(trb_dynamics *d, double time, const double *y, double share)
{
  const trb_system *system = d->system;
  const int         n = trb_state_main_size(system), size = trb_state_size(system);
  double           *moved = malloc(3 * (size_t)size * sizeof *moved), *low = moved + size, *high = low + size;
  if (moved == NULL) exit(1);
  memcpy(moved, y, (size_t)size * sizeof *y);
  for (int c = 0; c < n; c++) {
    const double scale = unit[trb_state_tolerance(system, c)], h = share * scale;
    moved[c] = y[c] + h;
    trb_rhs(d, NULL, time, moved, high);
    moved[c] = y[c] - h;
    trb_rhs(d, NULL, time, moved, low);
    moved[c] = y[c];
    for (int i = 0; i < n; i++) dense[i][c] = (high[i] - low[i]) / (2.0 * h) * scale / unit[trb_state_tolerance(system, i)];
  }
  free(moved);
}

static void expand(const trb_system *system, const trb_arrow *a)
{
  const trb_model *m = system->model;
  const int        n = trb_state_main_size(system), cage = rig_cage(system);
  memset(found, 0, sizeof found);
  for (int j = 0; j < m->n_rollers; j++)
    for (int i = 0; i < TRB_NR; i++) {
      for (int c = 0; c < TRB_NR; c++) found[j * TRB_NR + i][j * TRB_NR + c] = a->rollers[j].own[c][i];
      for (int c = 0; c < TRB_CAGE_SIZE; c++) {
        found[j * TRB_NR + i][cage + c] = a->borders[j].to_hub[c * TRB_NR + i];
        found[cage + c][j * TRB_NR + i] = a->borders[j].from[i * a->room + c];
      }
    }
  for (int i = 0; i < TRB_CAGE_SIZE; i++)
    for (int c = 0; c < TRB_CAGE_SIZE; c++) found[cage + i][cage + c] = a->hub[c * a->room + i];
  for (int i = 0; i < n; i++)
    for (int c = 0; c < n; c++) found[i][c] *= unit[trb_state_tolerance(system, c)] / unit[trb_state_tolerance(system, i)];
}

static int body_of(const trb_system *system, int i)
{
  const trb_model *m = system->model;
  return i < rig_cage(system) ? i / TRB_NR : m->n_rollers;
}

/* Entries of two bodies that do not couple are exactly zero in both; the others agree relative to the largest of their row. */
static void compare(const trb_system *system, double tolerance)
{
  const trb_model *m = system->model;
  const int        n = trb_state_main_size(system);
  for (int i = 0; i < n; i++) {
    double largest = 0.0, off = 0.0;
    for (int c = 0; c < n; c++) {
      largest = fmax(largest, fabs(dense[i][c]));
      off = fmax(off, fabs(found[i][c] - dense[i][c]));
      if (body_of(system, i) != body_of(system, c) && body_of(system, i) < m->n_rollers && body_of(system, c) < m->n_rollers)
        CHECK(dense[i][c] == 0.0);
    }
    CHECK_NEAR(off, 0.0, tolerance * largest + 1e-9);
  }
}

/* most: force of a roller on the cage, N. Loads over radii, which the slopes of pockets leave out, grow with it. */
static void check_scene(const trb_params *params, double load, double most, int touching, double tolerance)
{
  rig_bench         b = rig_open(params, load);
  const trb_system *system = b.system;
  const trb_model  *m = system->model;
  double            y[RIG_ROOM];
  int               coupled = 0;
  trb_jacobian     *jac = rig_jacobian(system, b.motion);
  trb_arrow        *arrow = rig_arrow(system);
  memcpy(y, b.start, sizeof y);
  rig_disturb(system, &seed, y);
  rig_draw_back(b.d, most, b.start, y);
  trb_jacobian_fill(jac, 0.01, y, 1, arrow);
  for (int j = 0; j < m->n_rollers; j++) coupled += arrow->borders[j].parts != 0U;
  CHECK(coupled >= touching);
  expand(system, arrow);
  differentiate(b.d, 0.01, y, 0.05);
  compare(system, tolerance);
  /* what the rings do is kept where it need not be fresh: at the same state it is the same */
  trb_jacobian_fill(jac, 0.01, y, 0, arrow);
  CHECK(jac->rings_evaluations == 1);
  expand(system, arrow);
  compare(system, tolerance);
  trb_jacobian_free(jac);
  trb_arrow_free(arrow);
  rig_close(&b);
}

/* A roller that is added to the system of the others: as if it had been there. Its part of the hub's block leaves out what differences of the rates see of
 * loads over radii. */
static void test_added(void)
{
  const trb_params  p = rig_params();
  rig_bench         b = rig_open(&p, 4930.0);
  const trb_system *system = b.system;
  const int         n_rollers = system->model->n_rollers, n = trb_state_main_size(system);
  double            y[RIG_ROOM];
  int               others[64], added = 0;
  trb_jacobian     *jac = rig_jacobian(system, b.motion);
  trb_arrow        *arrow = rig_arrow(system);
  memcpy(y, b.start, sizeof y);
  rig_disturb(system, &seed, y);
  rig_draw_back(b.d, 20.0, b.start, y);
  trb_jacobian_fill(jac, 0.01, y, 1, arrow);
  while (added < n_rollers && arrow->borders[added].parts == 0U) added++;
  if (CHECK(added < n_rollers)) {
    expand(system, arrow);
    memcpy(dense, found, sizeof dense);
    for (int k = 0; k < n_rollers - 1; k++) others[k] = k + (k >= added);
    trb_jacobian_fill_of(jac, 0.01, y, 0, others, n_rollers - 1, arrow);
    expand(system, arrow);
    const int at = rig_cage(system) + TRB_CAGE_v_x;
    CHECK(memcmp(found[at], dense[at], sizeof found[at]) != 0);
    trb_jacobian_add(jac, 0.01, y, added, arrow);
    expand(system, arrow);
    for (int i = 0; i < n; i++) {
      double largest = 0.0, off = 0.0;
      for (int c = 0; c < n; c++) largest = fmax(largest, fabs(dense[i][c])), off = fmax(off, fabs(found[i][c] - dense[i][c]));
      CHECK_NEAR(off, 0.0, 1e-3 * largest + 1e-9);
    }
  }
  trb_jacobian_free(jac);
  trb_arrow_free(arrow);
  rig_close(&b);
}

/* As impacts are, and with loads of kilonewtons. */
static void check_both(const trb_params *params, double load)
{
  check_scene(params, load, 20.0, 1, 1e-2);
  check_scene(params, load, INFINITY, 2, 0.1);
}

int main(void)
{
  trb_params p = rig_params();
  for (int i = 0; i < 5; i++) check_both(&p, 4930.0);
  check_both(&p, 1230.0);
  p.effects.damping = 1, p.effects.rolling_pressure_force = 1, p.effects.rib_film = 1;
  check_both(&p, 4930.0);
  p = rig_params(), p.effects.lubrication = 0, p.effects.rolling_resistance = 0, p.effects.thermal = 0;
  check_both(&p, 4930.0);
  p = rig_params(), p.effects.with_cage = 0;
  check_scene(&p, 4930.0, INFINITY, 0, 2e-3);
  p = rig_params(), p.effects.planar = 1;
  check_both(&p, 4930.0);
  p = rig_params(), p.effects.guidance = TRB_GUIDANCE_INNER_LAND, p.effects.damping = 1;
  check_both(&p, 4930.0);
  p = rig_params(), p.effects.guidance = TRB_GUIDANCE_OUTER_LAND, p.land.clearance = 0.3e-3, p.land.contact_film = 3e-6;
  check_both(&p, 4930.0);
  p = rig_params(), p.pocket.film = 50e-6;
  for (int i = 0; i < 3; i++) check_both(&p, 4930.0);
  p = rig_cylinder();
  for (int i = 0; i < 3; i++) check_both(&p, 4930.0);
  p = rig_params(), p.effects.with_cage = 2;
  check_scene(&p, 4930.0, INFINITY, 0, 2e-3);
  p.effects.oil_fill = 0.1, p.effects.drag_coefficient = 1.0, p.cage.face_outer = 0.05, p.cage.face_inner = 0.04;
  check_scene(&p, 4930.0, INFINITY, 0, 2e-3);
  p = rig_params(), p.effects.planar = 1, p.effects.with_cage = 2;
  check_scene(&p, 4930.0, INFINITY, 0, 2e-3);
  test_added();
  return check_report();
}
