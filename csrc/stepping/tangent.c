#include "stepping/tangent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stepping/tangent_rings.h"

_Static_assert(TRB_TANGENT_IN % 4 == 0, "sums of four");

const double trb_difference[TRB_N_TOLERANCES] = {1e-10, 1e-8, 1e-7, 1e-5, 1.0};

/* Turn of the frame R that counts as one tolerance, and turn by which slopes over it are computed, rad. */
static const double turn_unit = 1e-3, turn_difference = 1e-5;
/* A tangent is used if its origins were good for this many evaluations in the mean, or the present one for that many; weight of the last
 * origin in the mean. */
static const double enough = 3.0, enough_now = 9.0, newest = 0.2;
/* Decay of the usual boundary friction with the slide-roll ratio. */
static const double usual_decay = 181.46;
/* Error that a tangent may have in its powers, as a share of all power. */
static const double power_share = 0.03;
/* Reach: smallest, first and largest value; largest growth and decline in one change; factor of caution; distance beyond which the
 * slopes are not corrected. */
static const double least_reach = 1e-3, first_reach = 1.0, largest_reach = 1e3, growth = 3.0, decline = 0.05, caution = 0.8, farthest = 1e5;
/* Corrections after which slopes are computed again by differences, which cost about as many exact evaluations: each correction is right along its
 * own step only. */
enum { most_corrections = 20 };
/* Steps between origins that go on one way, or back: least cosine of the angle between them, in the metric of the tolerances; largest ratio of
 * lengths of steps that go on evenly. */
static const double least_cosine = 0.9, most_uneven = 3.0;
/* The same of a reach where the tangent bends: what a bend promises holds near the origins between which it was seen. */
static const double bent_growth = 1.2, bent_caution = 0.7;

/* Losses by sliding and damping are never negative. Near zero, where they curve most, a tangent could make them so: they are bounded. */
static void set_bounds(trb_tangents *t)
{
#define SENSE(X, name, sense, is_on, text) TRB_SENSE_##sense,
  static const trb_sense senses[] = {TRB_LOSSES(SENSE, 0)};
#undef SENSE
  for (int i = 0; i < TRB_TANGENT_OUT; i++) t->least[i] = t->anything[i] = -INFINITY;
  for (int k = 0; k < TRB_N_ROLLER_LOSSES; k++)
    if (senses[k] == TRB_SENSE_TAKES) t->least[TRB_FLOW_quadrature + TRB_Q_losses + k] = 0.0;
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
    t->rollers = trb_zeros(n, sizeof *t->rollers);
    t->rings = trb_zeros(n * (size_t)system->n_moving + 1, sizeof *t->rings);
    t->seen = calloc(n * (size_t)system->n_moving + 1, sizeof *t->seen);
    t->partly = calloc(n, sizeof *t->partly);
    t->beyond = calloc(n, sizeof *t->beyond);
  }
  if (t == NULL || t->rollers == NULL || t->rings == NULL || t->seen == NULL || t->partly == NULL || t->beyond == NULL) {
    trb_tangents_free(t);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the tangents of %d rollers", m->n_rollers);
  }
  t->arms = trb_margin_arms_of(system);
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
  free(tangents->rollers);
  free(tangents->rings);
  free(tangents->seen);
  free(tangents->partly);
  free(tangents->beyond);
  free(tangents);
}

void trb_tangents_forget(trb_tangents *t)
{
  memset(t->rollers, 0, (size_t)t->model->n_rollers * sizeof *t->rollers);
  t->has_slopes = 0;
  t->time = 0.0;
}

/* No bend is known, as slopes were found at the origin. */
static void straighten(trb_tangents *t, int roller)
{
  trb_tangent *r = &t->rollers[roller];
  memset(r->curve, 0, sizeof r->curve);
  memset(r->along, 0, sizeof r->along);
  r->length = 0.0;
  r->bends = 0;
  for (int k = 0; k < t->system->n_moving; k++) {
    trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    memset(ring->curve, 0, sizeof ring->curve);
    memset(ring->along, 0, sizeof ring->along);
  }
}

/* A step along the way of the origins, over the last step between them. */
static double share_of(const trb_tangents *t, int roller, const double *step, double (*of_ring)[TRB_RING_IN])
{
  const double *along = t->rollers[roller].along;
  double        sum[4] = {0}; /* side by side: one sum alone would wait for each of its additions */
  for (int i = 0; i < TRB_TANGENT_IN; i += 4)
    for (int k = 0; k < 4; k++) sum[k] += along[i + k] * step[i + k];
  for (int k = 0; k < t->system->n_moving; k++) {
    const double *of = trb_tangents_ring_of(t, roller, k)->along;
    for (int i = 0; i < TRB_RING_IN; i++) sum[i % 4] += of[i] * of_ring[k][i];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* What the bend counts at a share of that step: nothing at both origins. */
static double bend_at(double share) { return share * (share + 1.0); }

static void differentiate(trb_tangents *t, trb_dynamics *d, const trb_instant *at, int column, double per)
{
  trb_contact_slow(d->model, at, d->work, d->loads, NULL);
  for (int k = 0; k < at->n; k++) {
    const int    j = at->chosen[k];
    trb_tangent *r = &t->rollers[j];
    double       flow[TRB_FLOW_SIZE];
    trb_dynamics_roller_flow(d, j, &d->loads[j], flow);
    for (int i = 0; i < TRB_FLOW_SIZE; i++) r->slope[column][i] = per * (flow[i] - r->value[i]);
    if (column < TRB_NR) memcpy(r->found[column], r->slope[column], sizeof r->found[column]);
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
  const trb_model *m = d->model;
  const double     time = d->drive.time, frame_speed = d->drive.frame_speed;
  trb_instant      at = trb_dynamics_instant(d);
  at.chosen = chosen;
  at.n = n;
  trb_contact_slow(m, &at, d->work, d->loads, NULL);
  for (int k = 0; k < n; k++) {
    const int    j = chosen[k];
    trb_tangent *r = &t->rollers[j];
    trb_dynamics_roller_flow(d, j, &d->loads[j], r->value);
    memcpy(r->margin, d->loads[j].margin, sizeof r->margin);
    memcpy(r->origin, y + trb_state_roller(d->system, j), TRB_NR * sizeof *y);
    r->origin[TRB_TANGENT_TURN] = d->drive.frame_angle;
    straighten(t, j);
    r->corrected = 0;
    trb_rings_begin(t, d, j);
  }
  trb_rings_see(t, d, 0);
  for (int c = 0; c < TRB_NR; c++) {
    const double h = trb_difference[trb_roller_tolerance(c)];
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
    trb_dynamics_pose(d, time + turn_difference / fabs(frame_speed), y);
    trb_rings_see(t, d, 1);
    differentiate(t, d, &at, TRB_TANGENT_TURN, copysign(1.0 / turn_difference, frame_speed));
  }
  trb_dynamics_pose(d, time, y);
  trb_rings_differentiate(t, d, chosen, n);
  /* these slopes are exact, so tangents are used at once, with a small reach */
  for (int k = 0; k < n && !t->has_slopes; k++) {
    t->rollers[chosen[k]].reach = first_reach;
    t->rollers[chosen[k]].usual = enough;
  }
  if (n == m->n_rollers) {
    t->time = time;
    t->has_slopes = 1;
  }
  if (!all_finite(t, chosen, n)) trb_tangents_forget(t);
}

int trb_tangents_are_worn(const trb_tangents *t, int roller) { return t->rollers[roller].corrected >= most_corrections; }

const double *trb_tangents_column(const trb_tangents *t, int roller, int column)
{
  const trb_tangent *r = &t->rollers[roller];
  return r->usual >= enough ? r->slope[column] : r->found[column];
}

const trb_ring_tangent *trb_tangents_ring(const trb_tangents *t, int roller, int ring) { return trb_tangents_ring_of(t, roller, ring); }

const trb_ring_slopes *trb_tangents_ring_slopes(const trb_tangents *t, int roller, int ring)
{
  const trb_ring_tangent *of = trb_tangents_ring_of(t, roller, ring);
  return t->rollers[roller].usual >= enough ? &of->slopes : &of->found;
}

static void weigh(trb_tangent *r, const trb_tangent_measure *measure, const double *y)
{
  for (int i = 0; i < TRB_NR; i++) r->per[i] = trb_tangent_weight(measure, i, y[i]);
  r->per[TRB_TANGENT_TURN] = 1.0 / turn_unit;
}

/* Error of a step, in tolerances, that follows from an error in the rates: gamma times it, the measure of the test of Newton's method
 * (stepping/newton.c). */
static double step_error(const trb_tangent *r, const trb_tangent_measure *measure, const double *error)
{
  const double gamma = measure->factors->gamma;
  double       sum = 0.0;
  for (int i = 0; i < TRB_NR; i++) sum += gamma * error[i] * r->per[i] * (gamma * error[i] * r->per[i]);
  return sqrt(sum);
}

/* Error in the powers over all power of the roller. In a stiff contact an error may hardly move the state and still change the work. */
static double power_error(const double *flow, const double *error)
{
  double off = 0.0, all = 0.0;
  for (int i = TRB_FLOW_quadrature; i < TRB_FLOW_SIZE; i++) {
    off += fabs(error[i]);
    all += fabs(flow[i]);
  }
  return off / (all + 1e-300);
}

/* The bend along the last step, of the length given: its direction, how its flow and reactions differ from the slopes, and whether it goes on
 * as the step before did (same_way). With x the way along it, L and K the lengths of both steps and e the difference, Newton's
 * interpolation through the three origins is f + (slope + e/L) x + e/(L (L + K)) x (x + L); where slopes were found at the origin before,
 * K = 0. If the way does not go on evenly, nothing is known of a bend. */
static void bend(trb_tangents *t, int roller, double length, int same_way, const double *direction, const double *error,
                 double (*of_ring)[TRB_RING_IN], double (*off)[TRB_RING_OUT])
{
  trb_tangent *r = &t->rollers[roller];
  const int    even = length < most_uneven * r->length && r->length < most_uneven * length;
  r->bends = r->length == 0.0 || (same_way && even);
  const double share = r->bends ? length / (length + r->length) : 0.0;
  for (int i = 0; i < TRB_TANGENT_OUT; i++) r->curve[i] = share * error[i];
  memcpy(r->along, direction, sizeof r->along);
  r->length = length;
  for (int k = 0; k < t->system->n_moving; k++) {
    trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    for (int i = 0; i < TRB_RING_OUT; i++) ring->curve[i] = share * off[k][i];
    memcpy(ring->along, of_ring[k], sizeof ring->along);
  }
}

/* Error over that allowed, of a flow and of reactions. */
static double over_allowed(const trb_tangents *t, int roller, const trb_tangent_measure *measure, const double *flow, const double *error,
                           double (*off)[TRB_RING_OUT])
{
  double in_state = step_error(&t->rollers[roller], measure, error);
  for (int k = 0; k < t->system->n_moving; k++)
    in_state = trb_max(in_state, trb_rings_error(t, trb_tangents_ring_of(t, roller, k), measure, off[k]));
  return trb_max(in_state / measure->share, power_error(flow, error) / power_share);
}

/* Errors over those allowed: of the slopes alone, and of the prediction, which bends. */
typedef struct trb_found {
  double straight, bent;
} trb_found;

/* How an exact flow and the exact reactions differ from the slopes. */
static trb_found compare(const trb_tangents *t, int roller, const trb_tangent_measure *measure, const double *flow,
                         const trb_wrench *reactions, const double *step, double (*of_ring)[TRB_RING_IN], double *error,
                         double (*off)[TRB_RING_OUT])
{
  const trb_tangent       *r = &t->rollers[roller];
  const trb_block_kernels *kernels = measure->factors->kernels;
  const double             by = bend_at(share_of(t, roller, step, of_ring));
  double                   left[TRB_TANGENT_OUT], left_off[TRB_MOST_MOVING_RINGS][TRB_RING_OUT];
  kernels->follow(r->value, (const double (*)[TRB_TANGENT_OUT])r->slope, step, r->curve, 0.0, t->anything, error);
  for (int k = 0; k < t->system->n_moving; k++) {
    const trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    double                  exact[TRB_RING_OUT];
    kernels->follow_ring(&ring->slopes, ring->value, step, of_ring[k], t->anything, error, off[k]);
    trb_ring_reaction(ring, &reactions[k], exact);
    for (int i = 0; i < TRB_RING_OUT; i++) {
      off[k][i] = exact[i] - off[k][i];
      left_off[k][i] = off[k][i] - by * ring->curve[i];
    }
  }
  for (int i = 0; i < TRB_TANGENT_OUT; i++) {
    error[i] = flow[i] - error[i];
    left[i] = error[i] - by * r->curve[i];
  }
  return (trb_found){over_allowed(t, roller, measure, flow, error, off), over_allowed(t, roller, measure, flow, left, left_off)};
}

/* An exact flow becomes the origin. With s the step from the old origin, P the diagonal matrix of weights and e = flow - prediction by the
 * slopes, these become L + e (P^2 s)^T/(s^T P^2 s) (Broyden 1965, Math. Comp. 19, 577, in the metric of the tolerances), so that they
 * explain this flow. The reach becomes the distance times the root of allowed over found error, as errors grow with the square of the distance
 * where nothing is known of a bend. */
static void learn(trb_tangents *t, const trb_dynamics *d, int roller, const trb_tangent_measure *measure, const double *y,
                  const double *flow, const trb_wrench *reactions)
{
  const double             turn = d->drive.frame_angle, *margin = d->loads[roller].margin;
  const int                n_moving = t->system->n_moving;
  double                   of_ring[TRB_MOST_MOVING_RINGS][TRB_RING_IN], off[TRB_MOST_MOVING_RINGS][TRB_RING_OUT];
  trb_tangent             *r = &t->rollers[roller];
  const trb_block_kernels *kernels = measure->factors->kernels;
  double                   step[TRB_TANGENT_IN], error[TRB_TANGENT_OUT];
  if (!kernels->finite(flow, TRB_FLOW_SIZE)) return;
  const double by_rings = r->known ? trb_rings_step(t, d, roller, of_ring) : 0.0;
  const double length = r->known ? sqrt(kernels->step_from(r->origin, r->per, y, turn, step) + by_rings) : 0.0;
  if (r->known && length > 0.0 && length < farthest) {
    double          direction[TRB_TANGENT_IN];
    const trb_found found = compare(t, roller, measure, flow, reactions, step, of_ring, error, off);
    /* going back to the origin before, the prediction is right there whatever it is worth elsewhere */
    const double way = share_of(t, roller, step, of_ring) * r->length / length, most = way < -least_cosine ? 1.0 : growth;
    const double straight = trb_clamp(caution / sqrt(found.straight + 1e-300), decline, most);
    const double bent = trb_clamp(bent_caution / sqrt(found.bent + 1e-300), decline, trb_min(most, bent_growth));
    const int    pays = r->bends ? bent > straight : straight < bent_growth;
    const int    same_way = pays && way > least_cosine;
    r->reach = trb_clamp(length * trb_max(straight, bent), least_reach, largest_reach);
    for (int c = 0; c < TRB_TANGENT_IN; c++) direction[c] = step[c] * r->per[c] * r->per[c] / (length * length);
    for (int c = 0; c < TRB_TANGENT_IN; c++)
      for (int i = 0; i < TRB_TANGENT_OUT; i++) r->slope[c][i] += error[i] * direction[c];
    for (int k = 0; k < n_moving; k++) {
      trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
      for (int c = 0; c < TRB_RING_IN; c++) of_ring[k][c] *= ring->per[c] * ring->per[c] / (length * length);
      trb_rings_correct(ring, error, off[k], direction, of_ring[k]);
    }
    bend(t, roller, length, same_way, direction, error, of_ring, off);
  } else {
    r->reach = first_reach;
    straighten(t, roller);
  }
  memcpy(r->margin, margin, sizeof r->margin);
  memcpy(r->value, flow, sizeof r->value);
  memcpy(r->origin, y, TRB_NR * sizeof *y);
  r->origin[TRB_TANGENT_TURN] = turn;
  weigh(r, measure, y);
  trb_rings_move_origin(t, d, roller, measure, reactions);
  r->usual += newest * (r->served - r->usual);
  r->served = 0;
  r->known = 1;
  r->corrected++;
}

/* The share of the mean rolling speed that a roller may slip away is meant for the usual boundary friction, which turns from its slope
 * to its limit over one part in `usual_decay` of that speed. Where the scene's law turns over less, this gives the rolling speed at which
 * the usual one would turn over as little: the range in which friction is linear is the law's own, however fast the bearing runs. */
static double speed_of_range(const trb_model *m, double speed)
{
  const trb_params *p = &m->params;
  const int         dry = p->lubrication == TRB_LUBRICATION_DRY, boundary = p->lubrication == TRB_LUBRICATION_BOUNDARY;
  if (!m->friction) return speed;
  if (boundary || p->lubrication == TRB_LUBRICATION_MIXED) speed *= trb_min(usual_decay / p->boundary_decay, 1.0);
  return dry || (!boundary && p->traction == TRB_TRACTION_COULOMB) ? trb_min(speed, usual_decay * p->coulomb_speed) : speed;
}

/* By how much a roller may slip away from its origin so that friction is linear. */
static double slip_allowed(const trb_dynamics *d, double share)
{
  const trb_params  *p = &d->model->params;
  const trb_body_at *driven = &d->bodies[d->system->driven];
  const double       shaft = d->system->n_moving > 0 ? trb_dot(driven->ring.omega, driven->ring.axis) : d->drive.shaft_speed;
  const double       spin = d->model->geometry.roller_spin_ratio * (shaft - d->drive.carried_speed);
  return share * speed_of_range(d->model, trb_max(0.5 * p->roller_diameter * fabs(spin), p->speed_floor));
}

/* By how much a roller has slipped away from its origin, m/s. */
static double slipped(const trb_params *p, const double *step)
{
  return fabs(step[TRB_ROLLER_v_r]) + fabs(step[TRB_ROLLER_v_t]) + fabs(step[TRB_ROLLER_v_z]) +
         0.5 * p->roller_diameter * fabs(step[TRB_ROLLER_omega_a]) +
         p->effective_length * (fabs(step[TRB_ROLLER_omega_n]) + fabs(step[TRB_ROLLER_omega_t]));
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
  for (int j = 0; t->under_way && j < d->model->n_rollers; j++) t->rollers[j].known = 0;
}

static int follow(void *self, const trb_dynamics *d, int roller, const double *y, double *flow, trb_wrench *reactions)
{
  trb_tangents              *t = self;
  trb_tangent               *r = &t->rollers[roller];
  const trb_tangent_measure *measure = t->measure;
  const trb_block_kernels   *kernels = measure->factors->kernels;
  double                     step[TRB_TANGENT_IN] = {0}, of_ring[TRB_MOST_MOVING_RINGS][TRB_RING_IN];
  if (t->under_way) return 0;
  const double distance2 =
      r->known ? kernels->step_from(r->origin, r->per, y, d->drive.frame_angle, step) + trb_rings_step(t, d, roller, of_ring)
               : (double)INFINITY;
  const double slid = slipped(&t->model->params, step) + trb_rings_moved(t, d, roller);
  t->beyond[roller] = !(distance2 <= r->reach * r->reach) || !(slid <= t->slip);
  if (!t->beyond[roller]) {
    const unsigned open = trb_margin_open(&t->arms, t->offsets, r->margin, measure->margin_share, r->origin, step, step[TRB_TANGENT_TURN]);
    t->beyond[roller] = open != 0U && !is_near(t, d, roller, y, open);
  }
  r->served += !t->beyond[roller];
  if (t->beyond[roller] || !(r->usual >= enough || r->served > enough_now)) return 0;
  const double by = r->bends ? bend_at(share_of(t, roller, step, of_ring)) : 0.0;
  kernels->follow(r->value, (const double (*)[TRB_TANGENT_OUT])r->slope, step, r->curve, by, t->least, flow);
  for (int k = 0; k < t->system->n_moving; k++) {
    const trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    double                  reaction[TRB_RING_OUT];
    kernels->follow_ring(&ring->slopes, ring->value, step, of_ring[k], t->least, flow, reaction);
    for (int i = 0; i < TRB_RING_OUT; i++) reaction[i] += by * ring->curve[i];
    reactions[k] = trb_ring_wrench(ring, reaction);
  }
  return 1;
}

static void learn_exact(void *self, const trb_dynamics *d, int roller, const double *y, const double *flow, const trb_wrench *reactions)
{
  trb_tangents *t = self;
  if (t->under_way || !t->beyond[roller] || !t->has_slopes || !(t->measure->factors->gamma > 0.0)) return;
  learn(t, d, roller, t->measure, y, flow, reactions);
}

void trb_tangents_derivative(trb_tangents *t, trb_dynamics *d, const trb_tangent_measure *measure, double time, const double *y,
                             double *rates)
{
  const trb_approximation tangents = {.self = t, .begin = begin, .follow = follow, .learn = learn_exact};
  t->measure = measure;
  trb_rhs(d, &tangents, time, y, rates);
  t->measure = NULL;
}
