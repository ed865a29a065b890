#include "stepping/tangent_learn.h"

#include <string.h>

/* Turn of the frame R that counts as one tolerance, rad. */
static const double turn_unit = 1e-3;
/* Weight of the last origin in the mean of how many evaluations use an origin. */
static const double newest = 0.2;
/* Error that a tangent may have in its powers, as a share of all power. */
static const double power_share = 0.03;
/* Reach: smallest and largest value; largest growth and decline in one change; factor of caution; distance beyond which the
 * slopes are not corrected. */
static const double least_reach = 1e-3, largest_reach = 1e3, growth = 3.0, decline = 0.05, caution = 0.8, farthest = 1e5;
/* Steps between origins that go on one way, or back: least cosine of the angle between them, in the metric of the tolerances; largest ratio of
 * lengths of steps that go on evenly. */
static const double least_cosine = 0.9, most_uneven = 3.0;
/* The same of a reach where the tangent bends: what a bend promises holds near the origins between which it was seen. */
static const double bent_growth = 1.2, bent_caution = 0.7;

/* No bend is known, as slopes were found at the origin. */
void trb_tangent_straighten(trb_tangents *t, int roller)
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

static void weigh(trb_tangent *r, const trb_tangent_measure *measure, const double *y)
{
  for (int i = 0; i < TRB_NR; i++) r->per[i] = trb_tangent_weight(measure, i, y[i]);
  r->per[TRB_TANGENT_TURN] = 1.0 / turn_unit;
}

/* Error of a step, in tolerances, that follows from an error in the rates: gamma times it, the measure of the test of Newton's method
 * (stepping/newton.c). */
static double step_error(const trb_tangent *r, const trb_tangent_measure *measure, const double *error)
{
  const double gamma = measure->gamma;
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
  const trb_block_kernels *kernels = measure->kernels;
  const double             by = trb_tangent_bend(trb_tangent_share(t, roller, step, of_ring));
  double                   left[TRB_TANGENT_OUT], left_off[TRB_MOST_MOVING_RINGS][TRB_RING_OUT];
  kernels->follow(r->value, (const double (*)[TRB_TANGENT_OUT])r->slope, step, r->curve, 0.0, t->anything, error);
  for (int k = 0; k < t->system->n_moving; k++) {
    const trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    double                  exact[TRB_RING_OUT];
    kernels->follow_ring(&ring->slopes, ring->value, step, of_ring[k], t->anything, error, off[k]);
    trb_ring_reaction(&reactions[k], exact);
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
void trb_tangent_learn(trb_tangents *t, const trb_dynamics *d, int roller, const double *y, const double *flow, const trb_wrench *reactions)
{
  const trb_tangent_measure *measure = t->measure;
  const double               turn = d->drive.frame_angle, *margin = d->loads[roller].margin;
  const int                  n_moving = t->system->n_moving;
  double                     of_ring[TRB_MOST_MOVING_RINGS][TRB_RING_IN], off[TRB_MOST_MOVING_RINGS][TRB_RING_OUT];
  trb_tangent               *r = &t->rollers[roller];
  const trb_block_kernels   *kernels = measure->kernels;
  double                     step[TRB_TANGENT_IN], error[TRB_TANGENT_OUT];
  if (!kernels->finite(flow, TRB_FLOW_SIZE)) return;
  const double by_rings = r->known ? trb_rings_step(t, roller, of_ring) : 0.0;
  const double length = r->known ? sqrt(kernels->step_from(r->origin, r->per, y, turn, step) + by_rings) : 0.0;
  if (r->known && length > 0.0 && length < farthest) {
    double          direction[TRB_TANGENT_IN];
    const trb_found found = compare(t, roller, measure, flow, reactions, step, of_ring, error, off);
    /* going back to the origin before, the prediction is right there whatever it is worth elsewhere */
    const double way = trb_tangent_share(t, roller, step, of_ring) * r->length / length, most = way < -least_cosine ? 1.0 : growth;
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
    r->reach = trb_first_reach;
    trb_tangent_straighten(t, roller);
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
