#include "stepping/constants.h"
#include "stepping/tangent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stepping/tangent_learn.h"

/* Losses by sliding and damping are never negative. Near zero, where they curve most, a tangent could make them so: they are bounded. */
static void set_bounds(trb_tangents *t)
{
#define SENSE(X, name, sense, is_on, text) TRB_SENSE_##sense,
  static const trb_sense senses[] = {TRB_LOSSES(SENSE, 0)};
#undef SENSE
  for (int i = 0; i < TRB_TANGENT_OUT; i++) t->lower_bound[i] = t->no_bound[i] = -INFINITY;
  for (int k = 0; k < TRB_N_ROLLER_LOSSES; k++)
    if (senses[k] == TRB_SENSE_TAKES) t->lower_bound[TRB_FLOW_quadrature + TRB_Q_losses + k] = 0.0;
}

trb_status trb_tangents_create(const trb_system *system, trb_tangents **tangents, trb_message *message)
{
  const trb_model *m = system->model;
  const size_t     n = (size_t)m->n_rollers;
  trb_tangents    *t = calloc(1, sizeof *t);
  *tangents = NULL;
  if (t != NULL) {
    t->model = m;
    t->system = system;
    t->rollers = trb_memory_zeros(&t->memory, n, sizeof *t->rollers);
    t->rings = trb_memory_zeros(&t->memory, n * (size_t)system->n_moving, sizeof *t->rings);
    t->seen = trb_memory_zeros(&t->memory, n * (size_t)system->n_moving, sizeof *t->seen);
    t->flows_of_one_ring = trb_memory_zeros(&t->memory, n, sizeof *t->flows_of_one_ring);
    t->out_of_bounds = trb_memory_zeros(&t->memory, n, sizeof *t->out_of_bounds);
  }
  if (t == NULL || t->memory.lacks) {
    trb_tangents_free(t);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the tangents of %d rollers", m->n_rollers);
  }
  t->arms = trb_ring_arms_of(system);
  t->least_mass = INFINITY;
  for (int k = 0; k < system->n_moving; k++) {
    const trb_body *body = &system->bodies[system->moving[k]];
    t->least_mass = fmin(t->least_mass, body->kind->mass(m, body) / m->n_rollers);
  }
  set_bounds(t);
  *tangents = t;
  return TRB_OK;
}

void trb_tangents_free(trb_tangents *tangents)
{
  if (tangents == NULL) return;
  trb_memory_free(&tangents->memory);
  free(tangents);
}

void trb_tangents_forget(trb_tangents *t)
{
  memset(t->rollers, 0, (size_t)t->model->n_rollers * sizeof *t->rollers);
  t->has_slopes = 0;
  t->time = 0.0;
}

static void differentiate(trb_tangents *t, trb_dynamics *d, const trb_instant *at, int column, double per)
{
  trb_dynamics_slow(d, at, TRB_ANY_BODY, NULL);
  for (int k = 0; k < at->n; k++) {
    const int    j = at->chosen[k];
    trb_tangent *r = &t->rollers[j];
    double       flow[TRB_FLOW_SIZE];
    trb_dynamics_roller_flow(d, j, &d->loads[j], flow);
    for (int i = 0; i < TRB_FLOW_SIZE; i++) r->slope[column][i] = per * (flow[i] - r->value[i]);
    if (column < TRB_NR) memcpy(r->by_differences[column], r->slope[column], sizeof r->by_differences[column]);
    trb_rings_differentiate_reactions(t, d, j, column, per, -1);
  }
}

static int all_finite(const trb_tangents *t, const int *chosen, int n)
{
  double sum = 0.0;
  for (int q = 0; q < n; q++)
    for (int c = 0; c < TRB_TANGENT_IN; c++)
      for (int i = 0; i < TRB_TANGENT_OUT; i++) sum += 0.0 * t->rollers[chosen[q]].slope[c][i];
  for (int i = 0; i < n * t->system->n_moving; i++) {
    const trb_ring_slopes *slopes = &trb_tangents_ring_of(t, chosen[i % n], i / n)->slopes;
    for (int k = 0; k < TRB_RING_IN * TRB_FLOW_ROOM; k++) sum += 0.0 * (&slopes->flow[0][0])[k];
    for (int k = 0; k < TRB_RING_ALL * TRB_RING_OUT; k++) sum += 0.0 * (&slopes->reaction[0][0])[k];
  }
  return sum == 0.0;
}

void trb_tangents_differentiate(trb_tangents *t, trb_dynamics *d, const int *chosen, int n, const double *y, double *moved)
{
  const trb_model  *m = d->model;
  const double      time = d->drive.time, frame_speed = d->drive.frame_speed;
  const trb_instant at = trb_dynamics_instant(d, chosen, n);
  d->work->laws_use = TRB_LAWS_KEPT;
  trb_dynamics_slow(d, &at, TRB_ANY_BODY, NULL);
  d->work->laws_use = TRB_LAWS_FOLLOWED;
  for (int k = 0; k < n; k++) {
    const int    j = chosen[k];
    trb_tangent *r = &t->rollers[j];
    trb_dynamics_roller_flow(d, j, &d->loads[j], r->value);
    memcpy(r->margin, d->loads[j].margin, sizeof r->margin);
    memcpy(r->origin, y + trb_state_roller(d->system, j), TRB_NR * sizeof *y);
    r->origin[TRB_TANGENT_TURN] = d->drive.frame_angle;
    trb_tangent_straighten(t, j);
    r->corrected = 0;
    trb_rings_begin(t, d, j);
  }
  trb_rings_see(t, d, 0);
  for (int c = 0; c < TRB_NR; c++) {
    const double h = trb_difference[trb_roller_coordinates[c].tolerance];
    for (int k = 0; k < n; k++) {
      const int j = chosen[k];
      double   *entry = &moved[trb_state_roller(d->system, j) + c];
      *entry = y[trb_state_roller(d->system, j) + c] + h;
      trb_dynamics_pose_roller(d, j, moved + trb_state_roller(d->system, j));
      *entry = y[trb_state_roller(d->system, j) + c];
    }
    differentiate(t, d, &at, c, 1.0 / h);
  }
  if (frame_speed != 0.0) {
    trb_dynamics_pose_of(d, time + trb_turn_difference / fabs(frame_speed), y, chosen, n);
    trb_rings_see(t, d, 1);
    differentiate(t, d, &at, TRB_TANGENT_TURN, copysign(1.0 / trb_turn_difference, frame_speed));
  }
  trb_dynamics_pose_of(d, time, y, chosen, n);
  trb_rings_differentiate(t, d, chosen, n);
  d->work->laws_use = TRB_LAWS_EXACT;
  /* these slopes are exact, so tangents are used at once, with a small reach */
  for (int k = 0; k < n && !t->has_slopes; k++) {
    t->rollers[chosen[k]].reach = trb_first_reach;
    t->rollers[chosen[k]].mean_uses = trb_least_mean_uses;
  }
  if (n == m->n_rollers) {
    t->time = time;
    t->has_slopes = 1;
  }
  if (!all_finite(t, chosen, n)) trb_tangents_forget(t);
}

int trb_tangents_are_worn(const trb_tangents *t, int roller) { return t->rollers[roller].corrected >= TRB_MOST_CORRECTIONS; }

const double *trb_tangents_column(const trb_tangents *t, int roller, int column)
{
  const trb_tangent *r = &t->rollers[roller];
  return r->mean_uses >= trb_least_mean_uses ? r->slope[column] : r->by_differences[column];
}

const trb_ring_tangent *trb_tangents_ring(const trb_tangents *t, int roller, int ring) { return trb_tangents_ring_of(t, roller, ring); }

const trb_ring_slopes *trb_tangents_ring_slopes(const trb_tangents *t, int roller, int ring)
{
  const trb_ring_tangent *of = trb_tangents_ring_of(t, roller, ring);
  return t->rollers[roller].mean_uses >= trb_least_mean_uses ? &of->slopes : &of->by_differences;
}

/* The share of the mean rolling speed that a roller may slip away is meant for the boundary friction of the standard inputs, which turns from
 * its slope to its limit over one part in `trb_decay_of_slip_share` of that speed. Where the scene's law turns over less, this gives the rolling
 * speed at which that one would turn over as little: the range in which friction is linear is the law's own, however fast the bearing runs. */
static double speed_of_range(const trb_model *m, double speed)
{
  const trb_params *p = &m->params;
  const int         dry = p->effects.lubrication == TRB_LUBRICATION_DRY, boundary = p->effects.lubrication == TRB_LUBRICATION_BOUNDARY;
  if (!m->friction) return speed;
  if (boundary || p->effects.lubrication == TRB_LUBRICATION_MIXED)
    speed *= trb_min(trb_decay_of_slip_share / p->friction.boundary_decay, 1.0);
  return dry || (!boundary && p->effects.traction == TRB_TRACTION_COULOMB)
             ? trb_min(speed, trb_decay_of_slip_share * p->friction.coulomb_speed)
             : speed;
}

/* By how much a roller may slip away from its origin so that friction is linear. */
static double slip_allowed(const trb_dynamics *d, double share)
{
  const trb_params  *p = &d->model->params;
  const trb_body_at *driven = &d->bodies[d->system->driven];
  const double       shaft = d->system->n_moving > 0 ? trb_dot(driven->ring.omega, driven->ring.axis) : d->drive.shaft_speed;
  const double       spin = d->model->geometry.roller_spin_ratio * (shaft - d->drive.carried_speed);
  return share * speed_of_range(d->model, trb_max(0.5 * p->roller.diameter * fabs(spin), p->friction.speed_floor));
}

/* By how much a roller has slipped away from its origin, m/s. */
static double slipped(const trb_params *p, const double *step)
{
  return fabs(step[TRB_ROLLER_v_r]) + fabs(step[TRB_ROLLER_v_t]) + fabs(step[TRB_ROLLER_v_z]) +
         0.5 * p->roller.diameter * fabs(step[TRB_ROLLER_omega_a]) +
         p->roller.effective_length * (fabs(step[TRB_ROLLER_omega_n]) + fabs(step[TRB_ROLLER_omega_t]));
}

/* Whether contacts that a bound leaves open have changed their interference by less than a share of their margin all the same. Bounds add up what
 * bodies do that move together, as a roller that follows a rib which leans. Of a point contact the interference itself can be had. */
static int is_near(const trb_tangents *t, const trb_dynamics *d, int roller, const double *y, unsigned open)
{
  const double   *margin = t->rollers[roller].margin, share = t->measure->margin_share;
  trb_roller_pose pose;
  for (int i = 0; i < t->arms.n; i++)
    if (open >> i & 1U && d->system->pairs[t->arms.row[i]].kind->depth == NULL) return 0;
  trb_roller_pose_unpack(d->model, &d->drive, roller, y, &pose);
  for (int i = 0; i < t->arms.n; i++) {
    if (!(open >> i & 1U)) continue;
    const int           row = t->arms.row[i];
    const trb_pair     *pair = &d->system->pairs[row];
    const trb_ring_pose ring = trb_dynamics_ring_seen(d, pair->b, &pose);
    if (!(fabs(pair->kind->depth(pair, &pose, &ring) - margin[row]) <= share * fabs(margin[row]))) return 0;
  }
  return 1;
}

/* No tangent holds while the prescribed motion is under way. */
static void begin(void *self, const trb_dynamics *d, double time)
{
  trb_tangents *t = self;
  t->under_way = trb_motion_under_way(d->motion, time);
  t->slip = slip_allowed(d, t->measure->slip_share);
  trb_ring_offsets_of(d->system, d->bodies, t->offsets);
  trb_rings_place(t, d);
  for (int j = 0; t->under_way && j < d->model->n_rollers; j++) t->rollers[j].has_origin = 0;
}

static int follow(void *self, const trb_dynamics *d, int roller, const double *y, double *flow, trb_wrench *reactions)
{
  trb_tangents              *t = self;
  trb_tangent               *r = &t->rollers[roller];
  const trb_tangent_measure *measure = t->measure;
  const trb_block_kernels   *kernels = measure->kernels;
  double                     step[TRB_TANGENT_IN] = {0}, of_ring[TRB_MOST_MOVING_RINGS][TRB_RING_ROOM];
  if (t->under_way) return 0;
  const double distance2 = r->has_origin
                               ? kernels->step_from(r->origin, r->per, y, d->drive.frame_angle, step) + trb_rings_step(t, roller, of_ring)
                               : (double)INFINITY;
  const double slid = slipped(&t->model->params, step) + trb_rings_moved(t, d, roller);
  t->out_of_bounds[roller] = !(distance2 <= r->reach * r->reach) || !(slid <= t->slip);
  if (!t->out_of_bounds[roller]) {
    const unsigned open = trb_bounds_open(&t->arms, t->offsets, r->margin, measure->margin_share, r->origin, step, step[TRB_TANGENT_TURN]);
    t->out_of_bounds[roller] = open != 0U && !is_near(t, d, roller, y, open);
  }
  r->uses += !t->out_of_bounds[roller];
  if (t->out_of_bounds[roller] || !(r->mean_uses >= trb_least_mean_uses || r->uses > trb_least_uses)) return 0;
  const double by = r->bends ? trb_tangent_bend(trb_tangent_share(t, roller, step, of_ring)) : 0.0;
  kernels->follow(r->value, (const double (*)[TRB_TANGENT_OUT])r->slope, step, r->curve, by, t->lower_bound, flow);
  for (int k = 0; k < t->system->n_moving; k++) {
    const trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    double                  reaction[TRB_RING_OUT];
    kernels->follow_ring(&ring->slopes, ring->value, step, of_ring[k], t->lower_bound, flow, reaction);
    for (int i = 0; i < TRB_RING_OUT; i++) reaction[i] += by * ring->curve[i];
    reactions[k] = trb_ring_wrench(reaction);
  }
  return 1;
}

static void learn_exact(void *self, const trb_dynamics *d, int roller, const double *y, const double *flow, const trb_wrench *reactions)
{
  trb_tangents *t = self;
  if (t->under_way || !t->out_of_bounds[roller] || !t->has_slopes || !(t->measure->gamma > 0.0)) return;
  trb_tangent_learn(t, d, roller, y, flow, reactions);
}

trb_approximation trb_tangents_open(trb_tangents *t, const trb_tangent_measure *measure)
{
  t->measure = measure;
  return (trb_approximation){.self = t, .begin = begin, .follow = follow, .learn = learn_exact};
}

void trb_tangents_derivative(trb_tangents *t, trb_dynamics *d, const trb_tangent_measure *measure, double time, const double *y,
                             double *rates)
{
  const trb_approximation tangents = trb_tangents_open(t, measure);
  trb_rhs(d, &tangents, time, y, rates);
  t->measure = NULL;
}
