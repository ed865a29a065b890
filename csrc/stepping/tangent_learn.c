#include "stepping/tangent_learn.h"

#include <string.h>

#include "stepping/constants.h"

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
  r->per[TRB_TANGENT_TURN] = 1.0 / trb_turn_tolerance;
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
  return off / (all + trb_above_zero);
}

/* The bend along the last step, of the length given: its direction, how its flow and reactions differ from the slopes, and whether it goes on
 * as the step before did (same_way). With x the way along it, L and K the lengths of both steps and e the difference, Newton's
 * interpolation through the three origins is f + (slope + e/L) x + e/(L (L + K)) x (x + L); where slopes were found at the origin before,
 * K = 0. If the way does not go on evenly, nothing is known of a bend. */
static void bend(trb_tangents *t, int roller, double length, int same_way, const double *direction, const double *error,
                 double (*of_ring)[TRB_RING_ROOM], double (*off)[TRB_RING_OUT])
{
  trb_tangent *r = &t->rollers[roller];
  const int    even = length < trb_even_steps_ratio * r->length && r->length < trb_even_steps_ratio * length;
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
  return trb_max(in_state / measure->share, power_error(flow, error) / trb_power_share);
}

/* Errors over those allowed: of the slopes alone, and of the prediction, which bends. */
typedef struct tangent_errors {
  double straight, bent;
} tangent_errors;

/* How an exact flow and the exact reactions differ from the slopes. */
static tangent_errors compare(const trb_tangents *t, int roller, const trb_tangent_measure *measure, const double *flow,
                              const trb_wrench *reactions, const double *step, double (*of_ring)[TRB_RING_ROOM], double *error,
                              double (*off)[TRB_RING_OUT])
{
  const trb_tangent       *r = &t->rollers[roller];
  const trb_block_kernels *kernels = measure->kernels;
  const double             by = trb_tangent_bend(trb_tangent_share(t, roller, step, of_ring));
  double                   left[TRB_TANGENT_OUT], left_off[TRB_MOST_MOVING_RINGS][TRB_RING_OUT];
  kernels->follow(r->value, (const double (*)[TRB_TANGENT_OUT])r->slope, step, r->curve, 0.0, t->no_bound, error);
  for (int k = 0; k < t->system->n_moving; k++) {
    const trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    double                  exact[TRB_RING_OUT];
    kernels->follow_ring(&ring->slopes, ring->value, step, of_ring[k], t->no_bound, error, off[k]);
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
  return (tangent_errors){over_allowed(t, roller, measure, flow, error, off), over_allowed(t, roller, measure, flow, left, left_off)};
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
  double                     of_ring[TRB_MOST_MOVING_RINGS][TRB_RING_ROOM], off[TRB_MOST_MOVING_RINGS][TRB_RING_OUT];
  trb_tangent               *r = &t->rollers[roller];
  const trb_block_kernels   *kernels = measure->kernels;
  double                     step[TRB_TANGENT_IN], error[TRB_TANGENT_OUT];
  if (!kernels->finite(flow, TRB_FLOW_SIZE)) return;
  const double by_rings = r->has_origin ? trb_rings_step(t, roller, of_ring) : 0.0;
  const double length = r->has_origin ? sqrt(kernels->step_from(r->origin, r->per, y, turn, step) + by_rings) : 0.0;
  if (r->has_origin && length > 0.0 && length < trb_farthest_correction) {
    double               direction[TRB_TANGENT_IN];
    const tangent_errors errors = compare(t, roller, measure, flow, reactions, step, of_ring, error, off);
    /* going back to the origin before, the prediction is right there whatever it is worth elsewhere */
    const double way = trb_tangent_share(t, roller, step, of_ring) * r->length / length;
    const double most = way < -trb_same_way_cosine ? 1.0 : trb_reach_growth;
    const double straight = trb_clamp(trb_reach_caution / sqrt(errors.straight + trb_above_zero), trb_reach_decline, most);
    const double bent =
        trb_clamp(trb_bent_reach_caution / sqrt(errors.bent + trb_above_zero), trb_reach_decline, trb_min(most, trb_bent_reach_growth));
    const int pays = r->bends ? bent > straight : straight < trb_bent_reach_growth;
    const int same_way = pays && way > trb_same_way_cosine;
    r->reach = trb_clamp(length * trb_max(straight, bent), trb_least_reach, trb_largest_reach);
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
  r->mean_uses += trb_newest_origin_weight * (r->uses - r->mean_uses);
  r->uses = 0;
  r->has_origin = 1;
  r->corrected++;
}
