#include "stepping/ring_tangent.h"

enum { CENTRE = 0, AXIS = 3, VELOCITY = 5, OMEGA = 8 };

int trb_ring_like(int input)
{
  return input < AXIS ? TRB_ROLLER_r : input < VELOCITY ? TRB_ROLLER_skew : input < OMEGA ? TRB_ROLLER_v_r : TRB_ROLLER_omega_n;
}

static void put(trb_vec3 v, double *to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

void trb_ring_inputs(const trb_ring_pose *ring, double cosine, double sine, double *inputs)
{
  const trb_ring_pose in = trb_ring_pose_in_frame(ring, cosine, sine);
  put(in.centre, inputs + CENTRE);
  inputs[AXIS] = in.axis.x, inputs[AXIS + 1] = in.axis.y;
  put(in.velocity, inputs + VELOCITY);
  put(in.omega, inputs + OMEGA);
}

double trb_ring_step(const trb_ring_tangent *t, const trb_dynamics *d, int body, double *step)
{
  const trb_drive *drive = &d->drive;
  double           sum = 0.0;
  trb_ring_inputs(&d->bodies[body].ring, drive->cosine * t->cosine - drive->sine * t->sine,
                  drive->sine * t->cosine + drive->cosine * t->sine, step);
  for (int i = 0; i < TRB_RING_IN; i++) {
    step[i] -= t->origin[i];
    sum += step[i] * t->per[i] * (step[i] * t->per[i]);
  }
  return sum;
}

void trb_ring_reaction(const trb_ring_tangent *t, const trb_wrench *in_r, double *reaction)
{
  put(trb_turn_z(in_r->force, t->cosine, -t->sine), reaction);
  put(trb_turn_z(in_r->moment, t->cosine, -t->sine), reaction + 3);
  for (int i = 6; i < TRB_RING_OUT; i++) reaction[i] = 0.0;
}

trb_wrench trb_ring_wrench(const trb_ring_tangent *t, const double *reaction)
{
  return (trb_wrench){trb_turn_z(trb_v(reaction[0], reaction[1], reaction[2]), t->cosine, t->sine),
                      trb_turn_z(trb_v(reaction[3], reaction[4], reaction[5]), t->cosine, t->sine)};
}

void trb_ring_move(trb_ring_pose *ring, int input, double by)
{
  double *const places[TRB_RING_IN] = {&ring->centre.x, &ring->centre.y,   &ring->centre.z,   &ring->axis.x,
                                       &ring->axis.y,   &ring->velocity.x, &ring->velocity.y, &ring->velocity.z,
                                       &ring->omega.x,  &ring->omega.y,    &ring->omega.z};
  *places[input] += by;
}
