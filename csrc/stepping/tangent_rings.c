#include "stepping/tangent_rings.h"

#include <math.h>
#include <string.h>

#include "base/variant.h"
#include "stepping/constants.h"

enum { CENTRE = 0, AXIS = 3, VELOCITY = 5, OMEGA = 8 };

/* A roller's coordinate of the same kind as an input of a ring, which has its tolerance. */
static int like(int input)
{
  return input < AXIS ? TRB_ROLLER_r : input < VELOCITY ? TRB_ROLLER_skew : input < OMEGA ? TRB_ROLLER_v_r : TRB_ROLLER_omega_n;
}

static void put(trb_vec3 v, double *to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

static trb_vec3 get(const double *from) { return trb_v(from[0], from[1], from[2]); }

void trb_ring_inputs(const trb_ring_pose *ring, const trb_drive *drive, double *inputs)
{
  const trb_ring_pose in = trb_ring_pose_in_frame(ring, drive->cosine, drive->sine);
  put(in.centre, inputs + CENTRE);
  inputs[AXIS] = in.axis.x, inputs[AXIS + 1] = in.axis.y;
  put(in.velocity, inputs + VELOCITY);
  put(in.omega, inputs + OMEGA);
}

static trb_wide load(const double *from)
{
  trb_wide v;
  memcpy(&v, from, sizeof v);
  return v;
}

_Static_assert(TRB_RING_ROOM % TRB_WIDE == 0, "inputs are whole vectors");

/* Step of a ring's inputs from the origin; gives the sum of squares of step times per. */
static double step_of(const trb_ring_tangent *t, const double *restrict inputs, double *restrict step)
{
  trb_wide all = {0};
  double   sum = 0.0;
  for (int i = 0; i < TRB_RING_ROOM; i += TRB_WIDE) {
    const trb_wide by = load(inputs + i) - load(t->origin + i), weighted = by * load(t->per + i);
    memcpy(step + i, &by, sizeof by);
    all += weighted * weighted;
  }
  for (int k = 0; k < TRB_WIDE; k++) sum += all[k];
  return sum;
}

void trb_ring_move(trb_ring_pose *ring, int input, double by, double cosine, double sine)
{
  double moved[TRB_RING_IN] = {0};
  moved[input] = by;
  ring->centre = trb_add(ring->centre, trb_turn_z(get(moved + CENTRE), cosine, -sine));
  ring->axis = trb_add(ring->axis, trb_turn_z(trb_v(moved[AXIS], moved[AXIS + 1], 0.0), cosine, -sine));
  ring->velocity = trb_add(ring->velocity, trb_turn_z(get(moved + VELOCITY), cosine, -sine));
  ring->omega = trb_add(ring->omega, trb_turn_z(get(moved + OMEGA), cosine, -sine));
}

void trb_ring_reaction(const trb_wrench *wrench, double *reaction)
{
  put(wrench->force, reaction);
  put(wrench->moment, reaction + 3);
  for (int i = 6; i < TRB_RING_OUT; i++) reaction[i] = 0.0;
}

trb_wrench trb_ring_wrench(const double *reaction) { return (trb_wrench){get(reaction), get(reaction + 3)}; }

void trb_rings_differentiate_reactions(trb_tangents *t, const trb_dynamics *d, int roller, int input, double per, int only)
{
  trb_wrench reactions[TRB_MOST_MOVING_RINGS];
  trb_dynamics_roller_reactions(d, roller, &d->loads[roller], reactions);
  for (int k = 0; k < t->system->n_moving; k++) {
    trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    double            moved[TRB_RING_OUT];
    if (only >= 0 && k != only) continue;
    trb_ring_reaction(&reactions[k], moved);
    for (int i = 0; i < TRB_RING_OUT; i++) ring->slopes.reaction[input][i] = per * (moved[i] - ring->value[i]);
  }
}

void trb_rings_see(trb_tangents *t, trb_dynamics *d, int put_back)
{
  const size_t n = (size_t)d->model->n_rollers;
  for (int k = 0; k < t->system->n_moving; k++) {
    trb_ring_pose *in_frame = d->bodies[t->system->moving[k]].in_frame, *seen = t->seen + (size_t)k * n;
    memcpy(put_back ? in_frame : seen, put_back ? seen : in_frame, n * sizeof *seen);
  }
}

void trb_rings_begin(trb_tangents *t, const trb_dynamics *d, int roller)
{
  trb_wrench reactions[TRB_MOST_MOVING_RINGS];
  trb_dynamics_roller_reactions(d, roller, &d->loads[roller], reactions);
  for (int k = 0; k < t->system->n_moving; k++) {
    trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    ring->from = d->bodies[t->system->moving[k]].ring;
    trb_ring_inputs(&ring->from, &d->drive, ring->origin);
    trb_ring_reaction(&reactions[k], ring->value);
  }
}

void trb_rings_differentiate(trb_tangents *t, trb_dynamics *d, const int *chosen, int n)
{
  const trb_instant at = trb_dynamics_instant(d, chosen, n);
  for (int k = 0; k < t->system->n_moving; k++) {
    const int body = t->system->moving[k];
    trb_dynamics_slow(d, &at, body, NULL);
    for (int i = 0; i < n; i++) trb_dynamics_roller_flow(d, chosen[i], &d->loads[chosen[i]], t->flows_of_one_ring[chosen[i]]);
    for (int c = 0; c < TRB_RING_IN; c++) {
      const double h = trb_difference[trb_roller_coordinates[like(c)].tolerance], per = 1.0 / h;
      for (int i = 0; i < n; i++) {
        const trb_roller_pose *r = &d->rollers[chosen[i]];
        trb_ring_move(&d->bodies[body].in_frame[chosen[i]], c, h, r->cosine, r->sine);
      }
      trb_dynamics_slow(d, &at, body, NULL);
      for (int q = 0; q < n; q++) {
        const int         j = chosen[q];
        trb_ring_tangent *ring = trb_tangents_ring_of(t, j, k);
        double            flow[TRB_FLOW_SIZE];
        trb_dynamics_roller_flow(d, j, &d->loads[j], flow);
        for (int i = 0; i < TRB_FLOW_SIZE; i++) ring->slopes.flow[c][i] = per * (flow[i] - t->flows_of_one_ring[j][i]);
        trb_rings_differentiate_reactions(t, d, j, TRB_TANGENT_IN + c, per, k);
      }
      trb_rings_see(t, d, 1);
    }
    for (int i = 0; i < n; i++) {
      trb_ring_tangent *ring = trb_tangents_ring_of(t, chosen[i], k);
      ring->by_differences = ring->slopes;
    }
  }
}

double trb_rings_error(const trb_tangents *t, const trb_ring_tangent *ring, const trb_tangent_measure *measure, const double *error)
{
  const double gamma = measure->gamma, arm = 0.5 * t->model->params.bearing.pitch_diameter;
  /* gamma times an acceleration in the velocity, and gamma times that in the place */
  const double per = gamma / t->least_mass * hypot(ring->per[5], gamma * ring->per[0]);
  double       sum = 0.0;
  for (int i = 0; i < 6; i++) {
    const double off = per * error[i] / (i < 3 ? 1.0 : arm);
    sum += off * off;
  }
  return sqrt(sum);
}

void trb_rings_place(trb_tangents *t, const trb_dynamics *d)
{
  for (int k = 0; k < t->system->n_moving; k++) trb_ring_inputs(&d->bodies[t->system->moving[k]].ring, &d->drive, t->inputs[k]);
}

double trb_rings_step(const trb_tangents *t, int roller, double (*steps)[TRB_RING_ROOM])
{
  double sum = 0.0;
  for (int k = 0; k < t->system->n_moving; k++) sum += step_of(trb_tangents_ring_of(t, roller, k), t->inputs[k], steps[k]);
  return sum;
}

void trb_rings_correct(trb_ring_tangent *ring, const double *in_flow, const double *in_reaction, const double *to_roller,
                       const double *to_ring)
{
  for (int c = 0; c < TRB_RING_IN; c++)
    for (int i = 0; i < TRB_TANGENT_OUT; i++) ring->slopes.flow[c][i] += in_flow[i] * to_ring[c];
  for (int c = 0; c < TRB_RING_ALL; c++) {
    const double along = c < TRB_TANGENT_IN ? to_roller[c] : to_ring[c - TRB_TANGENT_IN];
    for (int i = 0; i < TRB_RING_OUT; i++) ring->slopes.reaction[c][i] += in_reaction[i] * along;
  }
}

void trb_rings_move_origin(trb_tangents *t, const trb_dynamics *d, int roller, const trb_tangent_measure *measure,
                           const trb_wrench *reactions)
{
  for (int k = 0; k < t->system->n_moving; k++) {
    trb_ring_tangent *ring = trb_tangents_ring_of(t, roller, k);
    ring->from = d->bodies[t->system->moving[k]].ring;
    memcpy(ring->origin, t->inputs[k], sizeof ring->origin);
    trb_ring_reaction(&reactions[k], ring->value);
    for (int i = 0; i < TRB_RING_IN; i++) ring->per[i] = trb_tangent_weight(measure, like(i), ring->origin[i]);
  }
}

double trb_rings_moved(trb_tangents *t, const trb_dynamics *d, int roller)
{
  double slid = 0.0;
  for (int k = 0; k < t->system->n_moving; k++) {
    const int            body = t->system->moving[k];
    const trb_ring_pose *from = &trb_tangents_ring_of(t, roller, k)->from, *to = &d->bodies[body].ring;
    trb_ring_offset     *offset = &t->offsets[body];
    offset->leaned = trb_norm(trb_sub(to->axis, from->axis));
    offset->shifted = trb_norm(trb_sub(to->centre, from->centre));
    slid += trb_norm(trb_sub(to->velocity, from->velocity)) +
            0.5 * t->model->params.bearing.pitch_diameter * trb_norm(trb_sub(to->omega, from->omega));
  }
  return slid;
}
