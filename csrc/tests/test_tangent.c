/* Tangents of the rings' forces: exact at their origin, wrong by the square of the distance, corrected along the way that was gone, and
 * never used while the prescribed motion is under way. */
#include "stepping/tangent.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"
#include "stepping/integrator.h"

enum { MOST = 512 };

static unsigned long long seed = 3;

/* A model in a state of its own, and what tangents need. */
typedef struct bench {
  trb_system         *system;
  const trb_model    *model;
  trb_motion         *motion;
  trb_dynamics       *d;
  trb_tangents       *tangents;
  trb_arrow_factors  *factors;
  trb_tangent_measure measure;
  double              y[MOST], moved[MOST], relative[MOST], scale[MOST];
} bench;

static void close_bench(bench *b)
{
  trb_arrow_factors_free(b->factors);
  trb_tangents_free(b->tangents);
  trb_dynamics_free(b->d);
  trb_motion_free(b->motion);
  rig_free(b->system);
}

/* Factor of the bounds that lets a tangent be followed anywhere. */
#define ANYWHERE 1e9

/* Of the shaft in the next bench, rad/s. */
static double speed = 100.0 * TRB_PI;

/* The linear system of a vanishing step, whose inverse is one: an error in rates is gamma times that in the state. */
static int open_bench(bench *b, const trb_params *params, double share, double bounds)
{
  static const double tolerance[TRB_N_TOLERANCES] = {3e-10, 3e-8, 1e-4, 1e-2, 1e30};
  trb_arrow          *arrow;
  memset(b, 0, sizeof *b);
  b->system = rig_system(params);
  b->model = b->system->model;
  b->motion = rig_motion(rig_state(b->system, 4930.0, speed, b->y), speed);
  rig_disturb(b->system, &seed, b->y);
  if (!CHECK(trb_dynamics_create(b->system, b->motion, "scalar", &b->d, NULL) == TRB_OK)) return 0;
  if (!CHECK(trb_tangents_create(b->system, &b->tangents, NULL) == TRB_OK)) return 0;
  if (!CHECK(trb_arrow_factors_create(b->model->n_rollers, b->system->layout.hub_width, b->d->work->variant, &b->factors, NULL) == TRB_OK))
    return 0;
  if (!CHECK(trb_arrow_create(b->model->n_rollers, b->system->layout.hub_width, &arrow, NULL) == TRB_OK)) return 0;
  arrow->gamma = 1e-5;
  CHECK(trb_arrow_factor(arrow, arrow->gamma, NULL, arrow->n, b->factors));
  trb_arrow_free(arrow);
  for (int i = 0; i < trb_state_size(b->system); i++) {
    b->scale[i] = tolerance[trb_state_tolerance(b->system, i)];
    b->relative[i] = 0.0;
  }
  b->measure = (trb_tangent_measure){b->relative, b->scale, b->factors->kernels, b->factors->gamma, share, 0.5 * bounds, 1e-3 * bounds};
  memcpy(b->moved, b->y, sizeof b->moved);
  trb_dynamics_pose(b->d, 0.0, b->y);
  trb_tangents_differentiate(b->tangents, b->d, b->d->everyone, b->d->model->n_rollers, b->y, b->moved);
  for (int j = 0; j < b->model->n_rollers; j++) b->tangents->rollers[j].mean_uses = 1e9;
  return 1;
}

/* Largest difference of main rates over the tolerances a step of gamma has for them. */
static double distance(const bench *b, const double *one, const double *other)
{
  double largest = 0.0;
  for (int i = 0; i < trb_state_main_size(b->system); i++)
    largest = fmax(largest, fabs(one[i] - other[i]) * b->factors->gamma / b->scale[i]);
  return largest;
}

/* The same, of each roller's entries the mean square. */
static double roller_distance(const bench *b, int roller, const double *one, const double *other)
{
  double sum = 0.0;
  for (int i = trb_state_roller(b->system, roller); i < trb_state_roller(b->system, roller + 1); i++)
    sum += pow((one[i] - other[i]) * b->factors->gamma / b->scale[i], 2.0) / TRB_ROLLER_SIZE;
  return sqrt(sum);
}

/* A state at some tolerances from y in a fixed direction. */
static void place(const bench *b, double tolerances, double *y)
{
  unsigned long long here = 17;
  memcpy(y, b->y, sizeof b->y);
  for (int i = 0; i < rig_cage(b->system); i++) y[i] += tolerances * b->scale[i] * rig_random(&here);
}

static void test_origin(const trb_params *params)
{
  bench  b;
  double found[MOST], exact[MOST];
  if (!open_bench(&b, params, 0.05, ANYWHERE)) return;
  /* the first evaluation is exact and becomes the origin, the second follows the tangents from it */
  for (int k = 0; k < 2; k++) {
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, found);
    trb_rhs(b.d, NULL, 0.0, b.y, exact);
    CHECK(b.d->work->counters.tangent_rollers == k * b.model->n_rollers);
    for (int i = 0; i < trb_state_size(b.system); i++) CHECK_NEAR(found[i], exact[i], 1e-13 * fabs(exact[i]) + 1e-12);
  }
  close_bench(&b);
}

/* Slopes of chosen rollers are those that all have, and leave the others' alone. */
static void test_chosen(const trb_params *params)
{
  const int   chosen[2] = {3, 7}, n = (int)params->bearing.n_rollers;
  trb_tangent before[12], alone[12];
  bench       b;
  double      y[MOST];
  if (!open_bench(&b, params, 1.0, ANYWHERE)) return;
  for (int j = 0; j < n; j++) b.tangents->rollers[j].corrected = 30;
  CHECK(trb_tangents_are_worn(b.tangents, 3));
  memcpy(before, b.tangents->rollers, sizeof before);
  place(&b, 40.0, y);
  memcpy(b.moved, y, sizeof b.moved);
  trb_dynamics_pose(b.d, 0.0, y);
  trb_tangents_differentiate(b.tangents, b.d, chosen, 2, y, b.moved);
  memcpy(alone, b.tangents->rollers, sizeof alone);
  for (int j = 0; j < n; j++) {
    const int is_chosen = j == 3 || j == 7;
    CHECK((memcmp(alone[j].slope, before[j].slope, sizeof alone[j].slope) != 0) == is_chosen);
    CHECK(trb_tangents_are_worn(b.tangents, j) == !is_chosen);
  }
  trb_tangents_differentiate(b.tangents, b.d, b.d->everyone, n, y, b.moved);
  for (int k = 0; k < 2; k++) {
    const trb_tangent *one = &alone[chosen[k]], *all = &b.tangents->rollers[chosen[k]];
    CHECK(memcmp(one->slope, all->slope, sizeof one->slope) == 0 && memcmp(one->origin, all->origin, sizeof one->origin) == 0);
    CHECK(memcmp(one->value, all->value, sizeof one->value) == 0 &&
          memcmp(one->by_differences, all->by_differences, sizeof one->by_differences) == 0);
  }
  close_bench(&b);
}

/* Half the distance, a quarter of the error; quadratures are followed like the rates. */
static void test_order(const trb_params *params)
{
  bench  b;
  double y[MOST], found[MOST], exact[MOST], off[2], lost[2];
  if (!open_bench(&b, params, 1.0, ANYWHERE)) return;
  for (int k = 0; k < 2; k++) {
    trb_tangents_differentiate(b.tangents, b.d, b.d->everyone, b.d->model->n_rollers, b.y, b.moved);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, found);
    for (int j = 0; j < b.model->n_rollers; j++) {
      CHECK(b.tangents->rollers[j].has_origin);
      b.tangents->rollers[j].mean_uses = 1e9;
      b.tangents->rollers[j].reach = 1e6;
    }
    place(&b, k == 0 ? 40.0 : 20.0, y);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
    trb_rhs(b.d, NULL, 0.0, y, exact);
    const int power = trb_state_quadrature(b.system) + TRB_Q_loss_traction_inner;
    off[k] = distance(&b, found, exact);
    lost[k] = fabs(found[power] - exact[power]) / fabs(exact[power]);
    trb_tangents_forget(b.tangents);
    trb_dynamics_pose(b.d, 0.0, b.y);
  }
  CHECK(off[0] > 0.0 && lost[0] < 2e-2);
  CHECK_NEAR(off[0] / off[1], 4.0, 0.6);
  CHECK_NEAR(lost[0] / lost[1], 4.0, 0.6);
  close_bench(&b);
}

/* The frame turns under the weight of the rollers, forwards or backwards: half the turn, a quarter of the error. */
static void test_turn(const trb_params *params)
{
  bench  b;
  double found[MOST], exact[MOST], start[MOST], off[2], change[2];
  if (!open_bench(&b, params, 1.0, ANYWHERE)) return;
  trb_rhs(b.d, NULL, 0.0, b.y, start);
  for (int k = 0; k < 2; k++) {
    const double time = (k == 0 ? 0.2 : 0.1) / fabs(b.d->drive.frame_speed);
    trb_tangents_forget(b.tangents);
    trb_dynamics_pose(b.d, 0.0, b.y);
    trb_tangents_differentiate(b.tangents, b.d, b.d->everyone, b.d->model->n_rollers, b.y, b.moved);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, found);
    for (int j = 0; j < b.model->n_rollers; j++) {
      b.tangents->rollers[j].mean_uses = 1e9;
      b.tangents->rollers[j].reach = 1e6;
    }
    trb_tangents_derivative(b.tangents, b.d, &b.measure, time, b.y, found);
    trb_rhs(b.d, NULL, time, b.y, exact);
    off[k] = distance(&b, found, exact);
    change[k] = distance(&b, exact, start);
  }
  CHECK(off[0] > 0.0 && off[0] < 0.2 * change[0]);
  CHECK_NEAR(off[0] / off[1], 4.0, 0.6);
  CHECK_NEAR(change[0] / change[1], 2.0, 0.2);
  close_bench(&b);
}

/* From origins on one way the tangent bends along it: half the way, an eighth of the error, forwards and back. */
static void test_bend(const trb_params *params)
{
  bench  b;
  double found[MOST], exact[MOST], off[2][2];
  if (!open_bench(&b, params, 1e6, ANYWHERE)) return;
  for (int k = 0; k < 2; k++) {
    const double time = (k == 0 ? 0.2 : 0.1) / fabs(b.d->drive.frame_speed), shares[2] = {1.5, 0.5};
    trb_tangents_forget(b.tangents);
    trb_dynamics_pose(b.d, 0.0, b.y);
    trb_tangents_differentiate(b.tangents, b.d, b.d->everyone, b.d->model->n_rollers, b.y, b.moved);
    for (int origin = 0; origin < 2; origin++) {
      for (int j = 0; j < b.model->n_rollers; j++) b.tangents->rollers[j].reach = 0.0, b.tangents->rollers[j].mean_uses = 1e9;
      trb_tangents_derivative(b.tangents, b.d, &b.measure, origin * time, b.y, found);
    }
    for (int j = 0; j < b.model->n_rollers; j++) {
      CHECK(b.tangents->rollers[j].bends);
      b.tangents->rollers[j].reach = 1e6;
    }
    for (int i = 0; i < 2; i++) {
      const long long before = b.d->work->counters.tangent_rollers;
      trb_tangents_derivative(b.tangents, b.d, &b.measure, shares[i] * time, b.y, found);
      CHECK(b.d->work->counters.tangent_rollers - before == b.model->n_rollers);
      trb_rhs(b.d, NULL, shares[i] * time, b.y, exact);
      off[k][i] = distance(&b, found, exact);
    }
  }
  for (int i = 0; i < 2; i++) CHECK_NEAR(off[0][i] / off[1][i], 8.0, 1.5);
  close_bench(&b);
}

/* A step beyond the reach is exact, and from the new origin the tangent leads back to the old one: Broyden's condition. */
static void test_learning(const trb_params *params)
{
  bench  b;
  double y[MOST], before[MOST], found[MOST], exact[MOST];
  if (!open_bench(&b, params, 0.05, ANYWHERE)) return;
  trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, before);
  place(&b, 300.0, y);
  trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
  trb_rhs(b.d, NULL, 0.0, y, exact);
  for (int i = 0; i < trb_state_size(b.system); i++) CHECK_NEAR(found[i], exact[i], 1e-13 * fabs(exact[i]) + 1e-12);
  CHECK(b.d->work->counters.tangent_rollers == 0);
  for (int j = 0; j < b.model->n_rollers; j++) b.tangents->rollers[j].reach = 1e6;
  trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, found);
  CHECK(b.d->work->counters.tangent_rollers == b.model->n_rollers);
  CHECK(distance(&b, found, before) < 1e-6);
  close_bench(&b);
}

/* The error found sets the reach: within it, errors stay near the share of the tolerance. */
static void test_reach(const trb_params *params)
{
  const double share = 0.05;
  bench        b;
  double       y[MOST], found[MOST], exact[MOST], largest = 0.0;
  long long    followed = 0;
  int          wide = 0;
  if (!open_bench(&b, params, share, ANYWHERE)) return;
  for (int k = 0; k < 4000; k++) {
    place(&b, 40.0 * sin(0.01 * k) * sin(0.0037 * k), y);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
    const long long now = b.d->work->counters.tangent_rollers;
    trb_rhs(b.d, NULL, 0.0, y, exact);
    for (int j = 0; j < b.model->n_rollers; j++) {
      const double off = roller_distance(&b, j, found, exact);
      wide += off > 2.0 * share;
      largest = fmax(largest, off);
    }
    followed = now;
  }
  CHECK((double)followed > 0.5 * 4000 * b.model->n_rollers);
  CHECK(wide < 0.1 * (double)followed);
  CHECK(largest < 10.0 * share);
  close_bench(&b);
}

/* Whatever was learned: a tangent is not followed where a contact could begin or end, nor where a roller slips by 1e-3 of the rolling
 * speed, or of the speed at which the usual boundary friction turns over as little as the scene's. */
static void test_bounds(const trb_params *params, double of_rolling, double speed_of_range)
{
  bench  b;
  double y[MOST], found[MOST];
  if (!open_bench(&b, params, 1.0, 1.0)) return;
  const double    rolling = fabs(0.5 * params->roller.diameter * b.model->geometry.roller_spin_ratio * 100.0 * TRB_PI);
  const double    slip = 1e-3 * fmin(of_rolling * rolling, speed_of_range);
  const trb_cone *face = &((const trb_rib *)b.system->pairs[TRB_PAIR_rib].own)->face;
  for (int k = 0; k < 5; k++) {
    const int j = 3 + k, beyond = k == 1 || k == 2 || k == 4;
    double    origin[MOST], *margins = b.tangents->rollers[j].margin;
    for (int i = 0; i < b.model->n_rollers; i++) b.tangents->rollers[i].reach = 0.0;
    memcpy(origin, b.y, sizeof origin);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, origin, found);
    /* near the rib */
    origin[trb_state_roller(b.system, j) + TRB_ROLLER_z] += 0.9 * margins[TRB_PAIR_rib] / face->sine;
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, origin, found); /* the origins are there */
    for (int i = 0; i < b.model->n_rollers; i++) b.tangents->rollers[i].reach = b.tangents->rollers[i].mean_uses = 1e9;
    const long long before = b.d->work->counters.tangent_rollers;
    const double    race = fmin(margins[TRB_PAIR_outer], margins[TRB_PAIR_inner]), rib = fabs(margins[TRB_PAIR_rib]);
    /* a slip within what is allowed, a way along the rib and towards a raceway, a slip beyond, a way along the rib that its bound does not tell
     * from one towards it, and one towards it */
    const double by = k == 1 ? 0.55 * race : 0.4 * race;
    const double moved[TRB_ROLLER_SIZE] = {[TRB_ROLLER_r] = k == 1 || k == 3 ? by : 0.0,
                                           [TRB_ROLLER_z] = k == 1 || k == 3 ? by * face->cosine / face->sine
                                                            : k == 4         ? 0.52 * rib
                                                                             : 0.0,
                                           [TRB_ROLLER_v_t] = k == 0   ? 0.99 * slip
                                                              : k == 2 ? 1.01 * slip
                                                                       : 0.0};
    if (!CHECK(rib < 0.1 * race && 2.0 * fabs(face->cosine) * by > 0.6 * rib)) return;
    memcpy(y, origin, sizeof y);
    for (int i = 0; i < TRB_ROLLER_SIZE; i++) y[trb_state_roller(b.system, j) + i] += moved[i];
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
    CHECK(b.d->work->counters.tangent_rollers - before == b.model->n_rollers - beyond);
    CHECK(b.tangents->out_of_bounds[j] == beyond);
  }
  close_bench(&b);
}

/* Coulomb's friction turns over a speed of its own, and boundary friction over one part in its decay: 181.46 is the usual one. */
static void test_range_of_friction(void)
{
  trb_params p = rig_params();
  test_bounds(&p, 1.0, INFINITY);
  p.effects.lubrication = TRB_LUBRICATION_DRY;
  test_bounds(&p, 1.0, 181.46 * p.friction.coulomb_speed);
  p.friction.dry_friction = 0.0;
  test_bounds(&p, 1.0, INFINITY);
  p = rig_params(), p.friction.boundary_decay = 5.0 * 181.46;
  test_bounds(&p, 0.2, INFINITY);
  p = rig_params(), p.effects.traction = TRB_TRACTION_COULOMB;
  test_bounds(&p, 1.0, 181.46 * p.friction.coulomb_speed);
}

/* Between two knots of the motion everything is exact, to the bit; after them new tangents are made. */
static void test_under_way(const trb_params *params)
{
  bench  b;
  double table[2][TRB_MOTION_COLUMNS] = {{0}}, found[MOST], exact[MOST];
  if (!open_bench(&b, params, 1.0, ANYWHERE)) return;
  trb_motion_free(b.motion);
  for (int k = 0; k < 2; k++) {
    table[k][0] = k;
    table[k][1 + 2 * TRB_CHANNEL_shaft_speed] = 300.0 + 10.0 * k;
  }
  if (!CHECK(trb_motion_create(&table[0][0], 2, &b.motion, NULL) == TRB_OK)) return;
  b.d->motion = b.motion;
  const double times[] = {1e-9, 0.5, 1.0 - 1e-12};
  for (int k = 0; k < 3; k++) {
    trb_tangents_derivative(b.tangents, b.d, &b.measure, times[k], b.y, found);
    trb_rhs(b.d, NULL, times[k], b.y, exact);
    CHECK(memcmp(found, exact, (size_t)trb_state_size(b.system) * sizeof *found) == 0);
  }
  CHECK(b.d->work->counters.tangent_rollers == 0);
  for (int k = 0; k < 2; k++) trb_tangents_derivative(b.tangents, b.d, &b.measure, 1.0, b.y, found);
  CHECK(b.d->work->counters.tangent_rollers == b.model->n_rollers);
  close_bench(&b);
}

/* A tangent that is left after one or two evaluations is not used; one that is good for many is used after a while. */
static void test_seldom(const trb_params *params)
{
  bench     b;
  double    y[MOST], found[MOST], exact[MOST];
  long long used = 0;
  if (!open_bench(&b, params, 0.05, ANYWHERE)) return;
  for (int j = 0; j < b.model->n_rollers; j++) b.tangents->rollers[j].mean_uses = 0.0;
  for (int k = 0; k < 400; k++) {
    place(&b, k % 2 == 0 ? 3e4 : -3e4, y);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
    trb_rhs(b.d, NULL, 0.0, y, exact);
    for (int i = 0; i < trb_state_size(b.system); i++) CHECK_NEAR(found[i], exact[i], 1e-13 * fabs(exact[i]) + 1e-12);
  }
  CHECK(b.d->work->counters.tangent_rollers == 0);
  for (int k = 0; k < 4000; k++) {
    place(&b, 0.02 * k, y);
    trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
    if (k == 2000) used = b.d->work->counters.tangent_rollers;
  }
  CHECK((double)(b.d->work->counters.tangent_rollers - used) > 0.5 * 2000 * b.model->n_rollers);
  close_bench(&b);
}

/* What is not a number is not learned. */
static void test_not_finite(const trb_params *params)
{
  bench  b;
  double y[MOST], found[MOST], exact[MOST];
  if (!open_bench(&b, params, 0.05, ANYWHERE)) return;
  trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, found);
  memcpy(y, b.y, sizeof y);
  y[trb_state_roller(b.system, 2) + TRB_ROLLER_v_t] = NAN;
  trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, y, found);
  CHECK(!isfinite(found[trb_state_roller(b.system, 2) + TRB_ROLLER_v_t]));
  trb_tangents_derivative(b.tangents, b.d, &b.measure, 0.0, b.y, found);
  trb_rhs(b.d, NULL, 0.0, b.y, exact);
  CHECK(distance(&b, found, exact) < 1e-6);
  y[trb_state_roller(b.system, 2) + TRB_ROLLER_v_t] = 1e300;
  trb_dynamics_pose(b.d, 0.0, y);
  trb_tangents_differentiate(b.tangents, b.d, b.d->everyone, b.d->model->n_rollers, y, b.moved);
  CHECK(!b.tangents->has_slopes);
  close_bench(&b);
}

int main(void)
{
  trb_params p = rig_params();
  test_origin(&p);
  test_order(&p);
  test_learning(&p);
  test_reach(&p);
  test_range_of_friction();
  test_under_way(&p);
  test_seldom(&p);
  test_not_finite(&p);
  p.effects.damping = 1, p.effects.rolling_pressure_force = 1;
  test_origin(&p);
  test_order(&p);
  p = rig_params(), p.effects.planar = 1;
  test_origin(&p);
  for (int sign = 1; sign >= -1; sign -= 2) {
    p = rig_params(), speed = sign * 100.0 * TRB_PI;
    test_turn(&p);
    test_bend(&p);
  }
  test_chosen(&p);
  p = rig_cylinder();
  test_origin(&p);
  test_order(&p);
  test_reach(&p);
  test_under_way(&p);
  return check_report();
}
