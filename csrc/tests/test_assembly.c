/* Bearings that are simulated together. Apart from each other, two of different size and oil have the rates and the Jacobian that each has
 * alone, bit for bit. On one shaft, and in one housing, the second one turned round, the rates of the body that they share follow from the
 * forces on both rings, the Jacobian is that of differences, and momentum is not made. */
#include <stdlib.h>
#include <string.h>

#include "body/free_ring.h"
#include "check.h"
#include "rig.h"
#include "stepping/jacobian.h"
#include "system/assembly.h"

enum { N = 2, ROOM = 1024 };

static const double       axial_load = 4930.0, speed = 100.0 * TRB_PI;
static unsigned long long seed = 77;

typedef struct pair_of {
  trb_system   *alone[N];
  trb_assembly  together;
  trb_motion   *motion[N];
  trb_dynamics *d[N];         /* in the assembly */
  double        own[N][ROOM]; /* states of each alone */
  double        y[ROOM];
  double        displacement[N];
} pair_of;

/* A state of a system alone becomes its part of the whole; a carried ring has no part. */
static void put_state(const trb_system *from, const trb_system *to, const double *own, double *whole)
{
  const int z = from->model->n_rollers;
  memcpy(whole + trb_state_roller(to, 0), own, (size_t)(z * TRB_ROLLER_SIZE) * sizeof *own);
  for (int b = 0; b < from->n_bodies; b++)
    if (from->bodies[b].size > 0 && !from->bodies[b].carried)
      memcpy(whole + to->bodies[b].first, own + from->bodies[b].first, (size_t)from->bodies[b].size * sizeof *own);
  memcpy(whole + trb_state_spin(to), own + trb_state_spin(from), (size_t)z * sizeof *own);
}

/* outer_share: speed of the outer ring over that of the shaft */
static trb_motion *motion_of(double displacement, double at_speed, double outer_share)
{
  double      row[TRB_MOTION_COLUMNS] = {0};
  trb_motion *motion;
  row[1 + 2 * TRB_CHANNEL_displacement_z] = displacement;
  row[1 + 2 * TRB_CHANNEL_shaft_speed] = at_speed;
  row[1 + 2 * TRB_CHANNEL_outer_speed] = outer_share * at_speed;
  if (trb_motion_create(row, 1, &motion, NULL) == TRB_OK) return motion;
  exit(1);
}

/* params: of each bearing; sense: of its speed. The state is that of rings whose outer one rests. */
static pair_of *open_pair(const trb_params params[N], const double sense[N])
{
  pair_of          *p = calloc(1, sizeof *p);
  const trb_system *systems[N];
  if (p == NULL) exit(1);
  for (int k = 0; k < N; k++) {
    p->alone[k] = rig_system(&params[k]);
    systems[k] = p->alone[k];
    p->displacement[k] = rig_state(p->alone[k], axial_load, sense[k] * speed, p->own[k]);
    p->motion[k] = motion_of(p->displacement[k], sense[k] * speed, params[k].outer_ring.free > 0.0 ? 0.1 : 0.0);
  }
  if (trb_assembly_make(systems, N, &p->together, NULL) != TRB_OK) exit(1);
  for (int k = 0; k < N; k++) {
    rig_disturb(p->alone[k], &seed, p->own[k]);
    put_state(p->alone[k], &p->together.members[k], p->own[k], p->y);
    if (trb_dynamics_create(&p->together.members[k], p->motion[k], "scalar", &p->d[k], NULL) != TRB_OK) exit(1);
  }
  return p;
}

static void close_pair(pair_of *p)
{
  for (int k = 0; k < N; k++) {
    trb_dynamics_free(p->d[k]);
    trb_motion_free(p->motion[k]);
    rig_free(p->alone[k]);
  }
  free(p);
}

static trb_arrow *jacobian_of(const trb_system *const *systems, trb_motion *const *motions, int n, const double *y)
{
  trb_arrow *a;
  if (trb_arrow_create(systems[0]->layout.n_rollers, systems[0]->layout.hub_width, &a, NULL) != TRB_OK) exit(1);
  for (int k = 0; k < n; k++) {
    trb_jacobian *jac;
    if (trb_jacobian_create(systems[k], motions[k], "scalar", &jac, NULL) != TRB_OK) exit(1);
    trb_jacobian_fill(jac, 0.01, y, 1, a);
    trb_jacobian_free(jac);
  }
  return a;
}

static void test_apart(void)
{
  static double whole[ROOM][ROOM], one[ROOM][ROOM];
  const double  sense[N] = {1.0, -0.5};
  trb_params    params[N] = {rig_params(), rig_params()};
  params[1].bearing.n_rollers = 9, params[1].oil.viscosity *= 3.0, params[1].effects.damping = 1.0, params[1].cage.mass *= 2.0;
  pair_of          *p = open_pair(params, sense);
  const trb_system *members[N] = {&p->together.members[0], &p->together.members[1]};
  double            rates[ROOM], expected[ROOM], own[ROOM];
  for (int i = 0; i < ROOM; i++) rates[i] = expected[i] = NAN;
  for (int k = 0; k < N; k++) {
    trb_dynamics *d = rig_dynamics(p->alone[k], p->motion[k]);
    trb_rhs(d, NULL, 0.01, p->own[k], own);
    put_state(p->alone[k], members[k], own, expected);
    memcpy(expected + trb_state_quadrature(members[k]), own + trb_state_quadrature(p->alone[k]),
           (size_t)trb_n_quadratures(members[k]) * sizeof *own);
    trb_rhs(p->d[k], NULL, 0.01, p->y, rates);
    trb_dynamics_free(d);
  }
  const int size = trb_state_size(members[0]);
  CHECK(members[0]->layout.n_rollers == 21 && members[0]->layout.hub_width == 2 * TRB_CAGE_SIZE && size < ROOM);
  CHECK(memcmp(rates, expected, (size_t)size * sizeof *rates) == 0 && isnan(rates[size]));
  trb_arrow *a = jacobian_of(members, p->motion, N, p->y);
  rig_expand(a, ROOM, &whole[0][0]);
  trb_arrow_free(a);
  for (int k = 0; k < N; k++) {
    const trb_system *alone = p->alone[k];
    const int         z = alone->model->n_rollers * TRB_NR, cage = members[k]->bodies[TRB_BODY_CAGE].first;
    a = jacobian_of(&alone, &p->motion[k], 1, p->own[k]);
    rig_expand(a, ROOM, &one[0][0]);
    trb_arrow_free(a);
    int same = 1;
    for (int i = 0; i < z + TRB_CAGE_SIZE; i++)
      for (int c = 0; c < z + TRB_CAGE_SIZE; c++) {
        const int at = i < z ? trb_state_roller(members[k], 0) + i : cage + i - z;
        const int with = c < z ? trb_state_roller(members[k], 0) + c : cage + c - z;
        same &= whole[at][with] == one[i][c];
      }
    CHECK(same);
  }
  const int cages[N] = {members[0]->bodies[TRB_BODY_CAGE].first, members[1]->bodies[TRB_BODY_CAGE].first};
  for (int i = 0; i < TRB_CAGE_SIZE; i++)
    for (int c = 0; c < TRB_CAGE_SIZE; c++) CHECK(whole[cages[0] + i][cages[1] + c] == 0.0 && whole[cages[1] + i][cages[0] + c] == 0.0);
  close_pair(p);
}

/* What both bearings share beside the shaft. */
static const double housing_damping = 30.0, housing_stiffness = 5e7;

/* housed: they sit in one housing, too, which has springs and a damper. */
static trb_params on_shaft(int k, int housed)
{
  trb_params p = rig_params();
  p.inner_ring.free = 1.0;
  p.inner_ring.mass = 3.0;
  p.inner_ring.inertia_axial = 2e-3, p.inner_ring.inertia_transverse = 9e-3;
  p.inner_ring.offset = k == 0 ? -0.045 : -0.03;
  p.effects.damping = 1.0;
  if (k > 0) p.inner_ring.carried = p.inner_ring.turned = 1.0;
  if (!housed) return p;
  p.outer_ring.free = p.outer_ring.turns = 1.0;
  p.outer_ring.mass = 5.0;
  p.outer_ring.inertia_axial = 8e-3, p.outer_ring.inertia_transverse = 2e-2;
  p.outer_ring.offset = k == 0 ? -0.02 : -0.055;
  if (k > 0) p.outer_ring.carried = p.outer_ring.turned = 1.0;
  if (k > 0) return p;
  p.outer_ring.damping = housing_damping;
  p.outer_ring.support_axial = housing_stiffness, p.outer_ring.support_radial = housing_stiffness;
  return p;
}

/* Two bearings on one shaft, preloaded against each other; shaft and housing are disturbed. */
static pair_of *open_shaft(int housed)
{
  static const double by[TRB_FREE_RING_SIZE] = {1e-6, 1e-6, 5e-7, 1e-5, 1e-5, 0, 1e-2, 1e-2, 1e-2, 0.2, 0.2, 0};
  trb_params          params[N] = {on_shaft(0, housed), on_shaft(1, housed)};
  const double        sense[N] = {1.0, -1.0};
  pair_of            *first = open_pair(params, sense);
  params[1].inner_ring.shift = first->displacement[0] + first->displacement[1];
  close_pair(first);
  pair_of *p = open_pair(params, sense);
  double  *shaft = p->y + p->together.members[0].bodies[TRB_BODY_INNER_RING].first;
  for (int i = 0; i < TRB_FREE_RING_SIZE; i++) shaft[i] = by[i] * rig_random(&seed);
  shaft[TRB_FREE_RING_z] += p->displacement[0];
  double *housing = p->y + p->together.members[0].bodies[TRB_BODY_OUTER_RING].first;
  for (int i = 0; i < TRB_FREE_RING_SIZE && housed; i++) housing[i] = by[i] * rig_random(&seed);
  return p;
}

/* A vector in a bearing's inertial axes is written in the shaft's. */
static trb_vec3 in_shaft(int k, trb_vec3 v) { return k == 0 ? v : trb_v(v.x, -v.y, -v.z); }

/* Rates of the body that both bearings share, against the forces on their rings, its springs and its damper. */
static void check_shared(pair_of *p, int body, const double *rates)
{
  const trb_system    *members[N] = {&p->together.members[0], &p->together.members[1]};
  const int            at = members[0]->bodies[body].first, race = body == TRB_BODY_INNER_RING ? TRB_RACE_INNER : TRB_RACE_OUTER;
  const trb_ring_body *is = &members[0]->model->ring[race];
  const double        *y = p->y + at;
  /* places, velocities and axes of both rings are those of points of one body */
  const trb_vec3       v = trb_v(y[TRB_FREE_RING_v_x], y[TRB_FREE_RING_v_y], y[TRB_FREE_RING_v_z]);
  const trb_ring_pose *one = &p->d[0]->bodies[body].ring, *other = &p->d[1]->bodies[body].ring;
  const trb_vec3       omega = one->omega, omega_other = in_shaft(1, other->omega);
  CHECK(members[1]->bodies[body].first == at);
  CHECK_NEAR(trb_norm(trb_sub(omega, omega_other)), 0.0, 1e-12 * speed);
  CHECK_NEAR(trb_norm(trb_add(one->axis, in_shaft(1, other->axis))), 0.0, 1e-15);
  CHECK_NEAR(one->angle + other->angle, 0.0, 1e-12);
  const trb_vec3 arm[N] = {trb_scale(-is->offset, one->axis), trb_scale(members[1]->model->ring[race].offset, one->axis)};
  for (int k = 0; k < N; k++) {
    const trb_vec3 expected = trb_add(v, trb_cross(omega, arm[k]));
    const trb_vec3 seen = in_shaft(k, p->d[k]->bodies[body].ring.velocity);
    CHECK_NEAR(trb_norm(trb_sub(expected, seen)), 0.0, 1e-12);
  }
  /* forces on both rings make the acceleration; what acts on another ring, rollers and cage of a bearing is left to that ring */
  trb_vec3 force = trb_v(0, 0, 0), moment = trb_v(0, 0, 0);
  for (int k = 0; k < N; k++) {
    trb_vec3 of_ring = trb_v(0, 0, 0), about = trb_v(0, 0, 0);
    for (int j = 0; j < members[k]->model->n_rollers; j++) {
      const trb_roller_pose *r = &p->d[k]->rollers[j];
      const trb_drive       *drive = &p->d[k]->drive;
      trb_dynamics_loads(p->d[k], NULL, NULL);
      const trb_wrench *on = &p->d[k]->loads[j].on[body];
      of_ring = trb_add(of_ring, trb_turn_z(trb_turn_z(on->force, r->cosine, r->sine), drive->cosine, drive->sine));
      about = trb_add(about, trb_turn_z(trb_turn_z(on->moment, r->cosine, r->sine), drive->cosine, drive->sine));
    }
    of_ring = in_shaft(k, of_ring);
    force = trb_add(force, of_ring);
    moment = trb_add(trb_add(moment, in_shaft(k, about)), trb_cross(arm[k], of_ring));
  }
  CHECK(trb_norm(force) > 10.0);
  if (body == TRB_BODY_OUTER_RING) { /* its springs hold a point of its axis */
    force = trb_axpy(force, -housing_damping, v);
    const trb_vec3 gone = trb_sub(one->centre, trb_axpy(trb_v(0, 0, 0), is->support_position, trb_sub(trb_v(0, 0, 1), one->axis)));
    const trb_vec3 held = trb_scale(-housing_stiffness, gone);
    force = trb_add(force, held);
    moment = trb_add(moment, trb_cross(trb_scale(is->support_position - is->offset, one->axis), held));
  }
  CHECK_NEAR(is->mass * rates[at + TRB_FREE_RING_v_x], force.x, 1e-9 * trb_norm(force) + 1e-6);
  CHECK_NEAR(is->mass * rates[at + TRB_FREE_RING_v_y], force.y, 1e-9 * trb_norm(force) + 1e-6);
  CHECK_NEAR(is->mass * rates[at + TRB_FREE_RING_v_z], force.z, 1e-9 * trb_norm(force) + 1e-6);
  const trb_frame f = trb_tilted_frame(y[TRB_FREE_RING_skew], y[TRB_FREE_RING_tilt]);
  const double    spin = (body == TRB_BODY_INNER_RING ? speed : 0.1 * speed) * is->inertia_axial, turn = is->inertia_transverse;
  CHECK_NEAR(turn * rates[at + TRB_FREE_RING_omega_n] + spin * y[TRB_FREE_RING_omega_t], trb_dot(moment, f.n), 0.02 * trb_norm(moment));
  CHECK_NEAR(turn * rates[at + TRB_FREE_RING_omega_t] - spin * y[TRB_FREE_RING_omega_n], trb_dot(moment, f.t), 0.02 * trb_norm(moment));
}

static void test_shaft(int housed)
{
  pair_of          *p = open_shaft(housed);
  const trb_system *members[N] = {&p->together.members[0], &p->together.members[1]};
  double            rates[ROOM];
  CHECK(members[0]->layout.hub_width == 2 * TRB_CAGE_SIZE + (housed ? 2 : 1) * TRB_FREE_RING_SIZE);
  for (int k = 0; k < N; k++) trb_rhs(p->d[k], NULL, 0.01, p->y, rates);
  check_shared(p, TRB_BODY_INNER_RING, rates);
  if (housed) check_shared(p, TRB_BODY_OUTER_RING, rates);
  trb_arrow *a = jacobian_of(members, p->motion, N, p->y);
  CHECK_NEAR(rig_jacobian_error(p->d, N, a, 0.01, p->y), 0.0, 0.05);
  trb_arrow_free(a);
  close_pair(p);
}

/* Steps of both methods come to the same; the energy of each bearing, the first with the shaft, changes by works and losses alone. */
static void test_steps(int housed)
{
  pair_of                *p = open_shaft(housed);
  const trb_system *const systems[N] = {p->alone[0], p->alone[1]};
  const trb_motion *const motions[N] = {p->motion[0], p->motion[1]};
  const char *const       kinds[N] = {"bdf", "erk"};
  const int               size = trb_state_size(&p->together.members[0]), main_size = trb_state_main_size(&p->together.members[0]);
  double                  end[N][ROOM];
  for (int k = 0; k < N; k++) {
    trb_settings    settings = rig_settings();
    trb_simulation *s;
    trb_message     message = {TRB_OK, ""};
    settings.atol_position *= 1e-3, settings.atol_angle *= 1e-3, settings.atol_velocity *= 1e-3, settings.atol_spin *= 1e-3;
    settings.rtol *= 1e-3, settings.max_step = 1e-7;
    CHECK(trb_simulation_create(systems, motions, N, kinds[k], "", &settings, 0.0, p->y, size - 1, &s, &message) == TRB_ERR_INPUT);
    CHECK_SAYS(message.text, "values needed");
    if (!CHECK(trb_simulation_create(systems, motions, N, kinds[k], "", &settings, 0.0, p->y, size, &s, &message) == TRB_OK)) return;
    const int length = trb_simulation_row(s);
    double   *row = calloc(2 * (size_t)length, sizeof *row), times[2] = {0.0, 1e-4};
    int       rows;
    long      steps;
    if (!CHECK(row != NULL)) return;
    CHECK(trb_simulation_run(s, times, 2, INFINITY, row, 1000000, k, &rows, &steps, &message) == TRB_OK && rows == 2);
    CHECK(trb_simulation_state_at(s, times[1], end[k], NULL) == TRB_OK);
    for (int i = 0, at = 0; i < N; i++) {
      const trb_model *m = p->alone[i]->model;
      const double    *last = row + length + at, *first = row + at;
      const double    *q = end[k] + trb_state_quadrature(&s->assembly.members[i]);
      const int        stored[] = {TRB_FIELD_AT_kinetic_energy, TRB_FIELD_AT_elastic_energy};
      double           change = 0.0, work = 0.0, lost = 0.0;
      for (int e = 0; e < 2; e++)
        change += last[trb_record_offset(p->alone[i], stored[e])] - first[trb_record_offset(p->alone[i], stored[e])];
      for (int w = 0; w < TRB_Q_losses; w++) work += q[w];
      for (int l = 0; l < m->n_losses; l++) lost += q[TRB_Q_losses + l];
      CHECK(fabs(change) > 1e-3 && lost > 1e-3);
      CHECK_NEAR(change - (work - lost), 0.0, 1e-3 * (fabs(change) + lost));
      at += trb_record_parts_length(&s->parts[i]);
    }
    free(row);
    trb_simulation_free(s);
  }
  /* of all places, angles, velocities and angular velocities: the root of the sum of squares */
  double off[TRB_N_TOLERANCES] = {0}, moved[TRB_N_TOLERANCES] = {0};
  for (int i = 0; i < main_size; i++) {
    const trb_system   *owner = trb_assembly_owner(&p->together, i);
    const trb_tolerance kind = trb_state_tolerance(owner, i);
    off[kind] += pow(end[0][i] - end[1][i], 2.0), moved[kind] += pow(end[1][i] - p->y[i], 2.0);
  }
  for (int kind = 0; kind < TRB_TOL_QUADRATURE; kind++) CHECK_NEAR(sqrt(off[kind] / moved[kind]), 0.0, 5e-3);
  close_pair(p);
}

/* Factors of the tolerances of both bearings, and the weights that follow, at a state at which the bounds of gaps are known. */
static void look_at(trb_integrator *it, const double *y, double step, double *weights)
{
  memcpy(it->y, y, (size_t)it->n * sizeof *it->y);
  CHECK(trb_integrator_rates(it, it->time, it->y, weights) == 0);
  for (int k = 0; k < N; k++) {
    const trb_dynamics *d = it->members[k].dynamics;
    trb_impacts_forget(d->model, &it->members[k].impacts);
    trb_integrator_look(it, k, step, d->everyone, d->model->n_rollers);
  }
  trb_integrator_weights(it, it->y, weights);
}

/* A cage that is about to hit its rollers makes their tolerances smaller, and its own, but no others: not those of the other bearing, and not the
 * shaft's, which hits nothing. What bearings ask for of the shaft, of which the rings are parts, holds for it: the smaller of both. */
static void test_tolerances(void)
{
  const double            fast = 10.0, step = 1e-5; /* m/s, s: gaps close within some steps at this speed */
  trb_settings            settings = rig_settings();
  pair_of                *p = open_shaft(0);
  const trb_system *const systems[N] = {p->alone[0], p->alone[1]};
  const trb_motion *const motions[N] = {p->motion[0], p->motion[1]};
  const trb_system *const members = p->together.members;
  const int               size = trb_state_size(&members[0]), shaft = members[0].bodies[TRB_BODY_INNER_RING].first;
  trb_simulation         *s;
  double                  before[ROOM], now[ROOM];
  settings.impact_share = 1e-4, settings.atol_velocity = 1e-2; /* so that even this impact needs smaller tolerances */
  if (!CHECK(trb_simulation_create(systems, motions, N, "bdf", "", &settings, 0.0, p->y, size, &s, NULL) == TRB_OK)) return;
  trb_integrator *it = &s->integrator;
  look_at(it, p->y, step, before);
  for (int hit = 0; hit < N; hit++) {
    const int z = systems[hit]->model->n_rollers, roller = trb_state_roller(&members[hit], 0),
              cage = members[hit].bodies[TRB_BODY_CAGE].first;
    int       finer = 0;
    double    y[ROOM];
    memcpy(y, p->y, (size_t)size * sizeof *y);
    y[cage + TRB_CAGE_v_x] += fast;
    look_at(it, y, step, now);
    CHECK(it->members[hit].impacts.factor[z + TRB_BODY_CAGE] < 1.0);
    for (int i = 0; i < size; i++) {
      const int of_roller = i >= roller && i < roller + z * TRB_NR, of_cage = i >= cage && i < cage + TRB_CAGE_SIZE;
      finer += of_roller && now[i] > before[i];
      CHECK(of_roller || of_cage || now[i] == before[i]);
    }
    CHECK(finer > 0);
  }
  look_at(it, p->y, step, before);
  for (int k = N - 1; k >= 0; k--) {
    it->members[k].impacts.factor[systems[k]->model->n_rollers + TRB_BODY_INNER_RING] = k == 0 ? 0.25 : 0.5;
    trb_integrator_weights(it, it->y, now);
    for (int i = 0; i < size; i++) CHECK(now[i] == (i >= shaft && i < shaft + TRB_FREE_RING_SIZE ? (k == 0 ? 4.0 : 2.0) : 1.0) * before[i]);
  }
  trb_simulation_free(s);
  close_pair(p);
}

static void test_refused(int housed)
{
  trb_params        p[N] = {on_shaft(1, housed), on_shaft(0, housed)};
  trb_system       *one = rig_system(&p[0]), *other = rig_system(&p[1]);
  const trb_params  held = rig_params();
  trb_system       *without = rig_system(&held);
  const trb_system *first_carried[N] = {one, other}, *held_first[N] = {without, one};
  trb_assembly      a;
  trb_message       message = {TRB_OK, ""};
  CHECK(trb_assembly_make(first_carried, N, &a, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "only bearings after the first");
  CHECK(trb_assembly_make(held_first, N, &a, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "no free ring");
  CHECK(trb_assembly_make(held_first, TRB_MOST_MEMBERS + 1, &a, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "an assembly has from 1 to");
  rig_free(one);
  rig_free(other);
  rig_free(without);
}

int main(void)
{
  test_apart();
  test_tolerances();
  for (int housed = 0; housed < 2; housed++) {
    test_shaft(housed);
    test_steps(housed);
    test_refused(housed);
  }
  return check_report();
}
