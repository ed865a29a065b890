#include "body/cage.h"

#include <string.h>

static const trb_vec3 none = {0, 0, 0}, first = {1, 0, 0}, second = {0, 1, 0}, third = {0, 0, 1};

void trb_cage_pose(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  const trb_cage_inputs *cage = body->own;
  const trb_angle        turn = trb_angle_of(y[TRB_CAGE_psi]);
  pose->x = trb_v(y[TRB_CAGE_x], y[TRB_CAGE_y], m->geometry.centre_plane + cage->offset + y[TRB_CAGE_z]);
  pose->frame = trb_tilted_frame(y[TRB_CAGE_skew], y[TRB_CAGE_tilt]);
  pose->body.n = trb_add(trb_scale(turn.cosine, pose->frame.n), trb_scale(turn.sine, pose->frame.t));
  pose->body.t = trb_sub(trb_scale(turn.cosine, pose->frame.t), trb_scale(turn.sine, pose->frame.n));
  pose->body.a = pose->frame.a;
  pose->v = trb_v(y[TRB_CAGE_v_x], y[TRB_CAGE_v_y], y[TRB_CAGE_v_z]);
  pose->omega_frame = trb_v(y[TRB_CAGE_omega_n], y[TRB_CAGE_omega_t], drive->frame_speed + y[TRB_CAGE_omega_a]);
  pose->omega = trb_from_frame(&pose->frame, pose->omega_frame);
}

void trb_cage_rates(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *c, const double *y,
                    const trb_wrench *load, double *rates)
{
  const trb_cage_inputs *cage = body->own;
  memset(rates, 0, TRB_CAGE_SIZE * sizeof *rates);
  if (m->params.effects.with_cage <= 0.0) return;
  const double         w = drive->frame_speed, per_mass = 1.0 / cage->mass;
  const trb_vec3       g = trb_has_gravity(drive) ? trb_gravity_in(drive, 1.0, 0.0) : trb_v(0, 0, 0);
  const trb_turn_rates turn =
      trb_euler(&c->frame, c->omega_frame, w, cage->inertia_transverse, cage->inertia_axial, trb_to_frame(&c->frame, load->moment));
  rates[TRB_CAGE_x] = c->v.x + w * y[TRB_CAGE_y];
  rates[TRB_CAGE_y] = c->v.y - w * y[TRB_CAGE_x];
  rates[TRB_CAGE_psi] = c->omega_frame.z - turn.frame_a;
  rates[TRB_CAGE_v_x] = per_mass * load->force.x + g.x + w * c->v.y;
  rates[TRB_CAGE_v_y] = per_mass * load->force.y + g.y - w * c->v.x;
  rates[TRB_CAGE_omega_a] = turn.spin.z - drive->frame_rate;
  if (m->params.effects.planar > 0.0) return;
  rates[TRB_CAGE_z] = c->v.z;
  rates[TRB_CAGE_skew] = turn.skew;
  rates[TRB_CAGE_tilt] = turn.tilt;
  rates[TRB_CAGE_v_z] = per_mass * load->force.z + g.z;
  rates[TRB_CAGE_omega_n] = turn.spin.x;
  rates[TRB_CAGE_omega_t] = turn.spin.y;
}

trb_rigid trb_cage_motion(const trb_rigid_pose *cage, int coordinate)
{
  const trb_frame *f = &cage->frame;
  switch (coordinate) {
  case TRB_CAGE_x:
  case TRB_CAGE_v_x: return (trb_rigid){first, none};
  case TRB_CAGE_y:
  case TRB_CAGE_v_y: return (trb_rigid){second, none};
  case TRB_CAGE_z:
  case TRB_CAGE_v_z: return (trb_rigid){third, none};
  case TRB_CAGE_skew: return (trb_rigid){none, trb_scale(-1.0, f->n)};
  case TRB_CAGE_tilt: return (trb_rigid){none, second};
  case TRB_CAGE_omega_n: return (trb_rigid){none, f->n};
  case TRB_CAGE_omega_t: return (trb_rigid){none, f->t};
  default: return (trb_rigid){none, f->a};
  }
}

double trb_cage_mass(const trb_model *m, const trb_body *body)
{
  const trb_cage_inputs *cage = body->own;
  return m->params.effects.with_cage > 0.0 ? cage->mass : 0.0;
}

double trb_cage_kinetic(const trb_model *m, const trb_body *body, const trb_rigid_pose *c)
{
  const trb_cage_inputs *cage = body->own;
  if (m->params.effects.with_cage <= 0.0) return 0.0;
  return trb_kinetic(cage->mass, cage->inertia_axial, cage->inertia_transverse, c->v, c->omega_frame);
}

static const trb_coordinate coordinates[TRB_CAGE_SIZE] = {TRB_CAGE_STATE(TRB_COORDINATE)};

const trb_body_kind trb_body_cage = {.name = "rigid cage",
                                     .size = TRB_CAGE_SIZE,
                                     .coordinates = coordinates,
                                     .skew = TRB_CAGE_skew,
                                     .pose = trb_cage_pose,
                                     .rates = trb_cage_rates,
                                     .motion = trb_cage_motion,
                                     .mass = trb_cage_mass,
                                     .kinetic = trb_cage_kinetic};

static double spacer_inertia(const trb_body *body) { return ((const trb_cage_inputs *)body->own)->inertia_axial; }

/* A spacer without its rollers; what they add is in motion/spacer.c. */
static void spacer_rates(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                         const trb_wrench *load, double *rates)
{
  (void)m;
  (void)y;
  memset(rates, 0, TRB_CAGE_SIZE * sizeof *rates);
  rates[TRB_CAGE_psi] = pose->omega_frame.z - drive->frame_speed;
  rates[TRB_CAGE_omega_a] = load->moment.z / spacer_inertia(body) - drive->frame_rate;
}

/* What guides it carries its weight. */
static double spacer_mass(const trb_model *m, const trb_body *body)
{
  (void)m;
  (void)body;
  return 0.0;
}

static double spacer_kinetic(const trb_model *m, const trb_body *body, const trb_rigid_pose *pose)
{
  (void)m;
  return 0.5 * spacer_inertia(body) * pose->omega_frame.z * pose->omega_frame.z;
}

const trb_body_kind trb_body_spacer = {.name = "spacer",
                                       .size = TRB_CAGE_SIZE,
                                       .coordinates = coordinates,
                                       .skew = -1,
                                       .pose = trb_cage_pose,
                                       .rates = spacer_rates,
                                       .motion = trb_cage_motion,
                                       .mass = spacer_mass,
                                       .kinetic = spacer_kinetic,
                                       .spacing = spacer_inertia,
                                       .turn = TRB_CAGE_psi,
                                       .turning = TRB_CAGE_omega_a};
