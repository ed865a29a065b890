#include "stepping/ring_tangent.h"

enum { CENTRE = 0, AXIS = 3, VELOCITY = 5, OMEGA = 8 };

int trb_ring_like(int input)
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

double trb_ring_step(const trb_ring_tangent *t, const double *inputs, double *step)
{
  double sum = 0.0;
  for (int i = 0; i < TRB_RING_IN; i++) {
    step[i] = inputs[i] - t->origin[i];
    sum += step[i] * t->per[i] * (step[i] * t->per[i]);
  }
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
