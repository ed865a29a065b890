#include "body/free_ring.h"

#include <math.h>
#include <string.h>

#include "body/ring.h"

/* Whether its drive keeps the prescribed speed with whatever torque that takes. */
static int keeps_speed(const trb_model *m) { return m->params.ring_free < 2.0; }

/* Coordinates are those of the shaft, in its axes. A bearing that sits on it the other way round has axes that are turned by half a turn
 * about x; this is the sign of y and z between both. */
static double sense_of(const trb_model *m) { return m->params.ring_turned > 0.0 ? -1.0 : 1.0; }

/* A vector from the shaft's axes into the bearing's, or back. */
static trb_vec3 other_axes(const trb_model *m, trb_vec3 v)
{
  const double sense = sense_of(m);
  return trb_v(v.x, sense * v.y, sense * v.z);
}

/* The centre of mass from its nominal place, in the bearing's axes. */
static trb_vec3 place_of_mass(const trb_model *m, const double *y)
{
  const trb_vec3 place = other_axes(m, trb_v(y[TRB_FREE_RING_x], y[TRB_FREE_RING_y], y[TRB_FREE_RING_z]));
  return trb_v(place.x, place.y, m->params.ring_shift + place.z);
}

/* Angular velocity in the shaft's frame. */
static trb_vec3 turn_rate(const trb_model *m, const trb_drive *drive, const double *y)
{
  return trb_v(y[TRB_FREE_RING_omega_n], y[TRB_FREE_RING_omega_t], sense_of(m) * drive->shaft_speed + y[TRB_FREE_RING_omega_a]);
}

static trb_vec3 velocity_of(const double *y) { return trb_v(y[TRB_FREE_RING_v_x], y[TRB_FREE_RING_v_y], y[TRB_FREE_RING_v_z]); }

static trb_frame frame_of(const double *y) { return trb_tilted_frame(y[TRB_FREE_RING_skew], y[TRB_FREE_RING_tilt]); }

/* A vector from the shaft's axes into the frame R of the bearing, and back. */
static trb_vec3 into_r(const trb_model *m, const trb_drive *drive, trb_vec3 v)
{
  return trb_turn_z(other_axes(m, v), drive->cosine, -drive->sine);
}

static trb_vec3 from_r(const trb_model *m, const trb_drive *drive, trb_vec3 v)
{
  return other_axes(m, trb_turn_z(v, drive->cosine, drive->sine));
}

/* From the centre of mass to the reference point, on which loads act; the bearing's axis points along the shaft's or against it. */
static trb_vec3 arm_of(const trb_model *m, const trb_frame *f) { return trb_scale(-m->params.ring_offset * sense_of(m), f->a); }

static void ring_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_ring_pose *ring)
{
  (void)body;
  const trb_frame f = frame_of(y);
  const trb_vec3  along = arm_of(m, &f), arm = other_axes(m, along), place = place_of_mass(m, y);
  const trb_vec3  omega = trb_from_frame(&f, turn_rate(m, drive, y));
  ring->axis = other_axes(m, trb_scale(sense_of(m), f.a));
  ring->centre = trb_v(place.x + arm.x, place.y + arm.y, m->geometry.centre_plane + (place.z + (m->params.ring_offset + arm.z)));
  ring->omega = other_axes(m, omega);
  ring->velocity = other_axes(m, trb_add(velocity_of(y), trb_cross(omega, along)));
}

/* Springs between a point of the axis and the surroundings, without force where the drive places the ring: at the start. */
typedef struct support {
  trb_vec3 force, moment; /* on the ring, about its reference point */
  double   energy;        /* J */
} support;

static support support_of(const trb_model *m, const trb_drive *drive, const double *y)
{
  const trb_params    *p = &m->params;
  const trb_ring_pose *start = &drive->ring;
  support              s = {{0, 0, 0}, {0, 0, 0}, 0.0};
  trb_ring_pose        ring;
  if (p->ring_support_radial <= 0.0 && p->ring_support_axial <= 0.0 && p->ring_support_tilt <= 0.0) return s;
  ring_of(m, NULL, drive, y, &ring);
  const trb_vec3 leaned = trb_sub(ring.axis, start->axis);
  const trb_vec3 shift = trb_axpy(trb_sub(ring.centre, start->centre), p->ring_support_position, leaned);
  s.force = trb_v(-p->ring_support_radial * shift.x, -p->ring_support_radial * shift.y, -p->ring_support_axial * shift.z);
  s.moment = trb_axpy(trb_cross(trb_scale(p->ring_support_position, ring.axis), s.force), -p->ring_support_tilt,
                      trb_cross(start->axis, ring.axis));
  s.energy = -0.5 * trb_dot(s.force, shift) + 0.5 * p->ring_support_tilt * trb_dot(leaned, leaned);
  return s;
}

static void pose_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  (void)body;
  const trb_params *p = &m->params;
  const trb_frame   f = frame_of(y);
  const double      turn = sense_of(m) * drive->shaft_angle + y[TRB_FREE_RING_psi], turn_cos = cos(turn), turn_sin = sin(turn);
  const trb_vec3    v = velocity_of(y), about = trb_v(y[TRB_FREE_RING_omega_n], y[TRB_FREE_RING_omega_t], 0.0);
  const trb_vec3    place = place_of_mass(m, y);
  pose->x = trb_turn_z(trb_v(place.x, place.y, m->geometry.centre_plane + p->ring_offset + place.z), drive->cosine, -drive->sine);
  pose->frame = (trb_frame){into_r(m, drive, f.n), into_r(m, drive, f.t), into_r(m, drive, f.a)};
  pose->body.n = trb_add(trb_scale(turn_cos, pose->frame.n), trb_scale(turn_sin, pose->frame.t));
  pose->body.t = trb_sub(trb_scale(turn_cos, pose->frame.t), trb_scale(turn_sin, pose->frame.n));
  pose->body.a = pose->frame.a;
  pose->v = into_r(m, drive, v);
  pose->omega_frame = turn_rate(m, drive, y);
  pose->omega = trb_from_frame(&pose->frame, pose->omega_frame);
  pose->moving = 0.0;
  pose->stored = support_of(m, drive, y).energy;
  pose->lost = p->ring_damping * trb_dot(v, v) + p->ring_damping_turns * trb_dot(about, about);
}

/* What acts on the ring, in the shaft's axes, which do not move. */
typedef struct loading {
  trb_vec3 force, moment; /* sum, about the centre of mass */
  trb_vec3 unbalance;     /* force */
} loading;

/* m e (W^2 (cos phi, sin phi) + W' (sin phi, -cos phi)) (Genta, Dynamics of Rotating Systems). */
static trb_vec3 unbalance_of(const trb_model *m, const trb_drive *drive, const double *y)
{
  const trb_params *p = &m->params;
  if (p->ring_unbalance <= 0.0) return trb_v(0, 0, 0);
  const double sense = sense_of(m), phi = sense * drive->shaft_angle + y[TRB_FREE_RING_psi] + p->ring_unbalance_angle, c = cos(phi),
               s = sin(phi);
  const double speed = sense * drive->shaft_speed + y[TRB_FREE_RING_omega_a], rate = sense * drive->shaft_rate;
  return trb_scale(p->ring_unbalance, trb_v(speed * speed * c + rate * s, speed * speed * s - rate * c, 0.0));
}

/* load: of contacts, about the reference point, in R. */
static loading loading_of(const trb_model *m, const trb_drive *drive, const trb_frame *f, const double *y, const trb_wrench *load)
{
  const trb_params *p = &m->params;
  const trb_vec3    across = trb_v(y[TRB_FREE_RING_omega_n], y[TRB_FREE_RING_omega_t], 0.0);
  const support     held = support_of(m, drive, y);
  const trb_vec3    at_centre = trb_add(trb_add(from_r(m, drive, load->force), drive->load.force), held.force);
  loading           on = {.unbalance = unbalance_of(m, drive, y)};
  on.force = trb_axpy(trb_add(at_centre, on.unbalance), -p->ring_damping, velocity_of(y));
  on.moment = trb_add(trb_add(from_r(m, drive, load->moment), drive->load.moment), trb_cross(arm_of(m, f), at_centre));
  on.moment = trb_add(on.moment, held.moment);
  on.moment = trb_axpy(on.moment, -p->ring_damping_turns, trb_from_frame(f, across));
  return on;
}

static void rates_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                     const trb_wrench *load, double *rates)
{
  (void)body;
  (void)pose;
  const trb_params    *p = &m->params;
  const trb_frame      f = frame_of(y);
  const loading        on = loading_of(m, drive, &f, y, load);
  const double         per_mass = 1.0 / p->ring_mass;
  const trb_turn_rates turn =
      trb_euler(&f, turn_rate(m, drive, y), 0.0, p->ring_inertia_transverse, p->ring_inertia_axial, trb_to_frame(&f, on.moment));
  memset(rates, 0, TRB_FREE_RING_SIZE * sizeof *rates);
  rates[TRB_FREE_RING_x] = y[TRB_FREE_RING_v_x];
  rates[TRB_FREE_RING_y] = y[TRB_FREE_RING_v_y];
  rates[TRB_FREE_RING_v_x] = per_mass * on.force.x + drive->gravity.x;
  rates[TRB_FREE_RING_v_y] = per_mass * on.force.y + drive->gravity.y;
  if (!keeps_speed(m)) {
    rates[TRB_FREE_RING_psi] = y[TRB_FREE_RING_omega_a] - turn.frame_a;
    rates[TRB_FREE_RING_omega_a] = turn.spin.z + drive->torque / p->ring_inertia_axial - drive->shaft_rate;
  }
  if (p->planar > 0.0) return;
  rates[TRB_FREE_RING_z] = y[TRB_FREE_RING_v_z];
  rates[TRB_FREE_RING_skew] = turn.skew;
  rates[TRB_FREE_RING_tilt] = turn.tilt;
  rates[TRB_FREE_RING_v_z] = per_mass * on.force.z + drive->gravity.z;
  rates[TRB_FREE_RING_omega_n] = turn.spin.x;
  rates[TRB_FREE_RING_omega_t] = turn.spin.y;
}

static double mass_of(const trb_model *m, const trb_body *body)
{
  (void)body;
  return m->params.ring_mass;
}

static double kinetic_of(const trb_model *m, const trb_body *body, const trb_rigid_pose *pose)
{
  (void)body;
  const trb_params *p = &m->params;
  return trb_kinetic(p->ring_mass, p->ring_inertia_axial, p->ring_inertia_transverse, pose->v, pose->omega_frame);
}

/* The drive keeps the speed against all moments about the axis, or gives its torque; it carries the unbalance round, too. The loads move
 * with the reference point. */
static trb_drive_power work_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, const trb_wrench *load)
{
  const trb_frame f = frame_of(y);
  const loading   on = loading_of(m, drive, &f, y, load);
  const double    kept = m->params.ring_inertia_axial * drive->shaft_rate - trb_dot(on.moment, f.a);
  const double    torque = keeps_speed(m) ? kept : drive->torque;
  trb_ring_pose   ring;
  ring_of(m, body, drive, y, &ring);
  return (trb_drive_power){torque * turn_rate(m, drive, y).z + trb_dot(on.unbalance, velocity_of(y)),
                           trb_dot(drive->load.force, ring.velocity) + trb_dot(drive->load.moment, ring.omega)};
}

static void place_of(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose) { trb_ring_prescribed.place(m, drive, pose); }

#define COORDINATE(name, kind, text) {#name, TRB_TOL_##kind, text},
static const trb_coordinate coordinates[TRB_FREE_RING_SIZE] = {TRB_FREE_RING_STATE(COORDINATE)};
#undef COORDINATE

const trb_body_kind trb_ring_free = {.name = "free ring",
                                     .place = place_of,
                                     .size = TRB_FREE_RING_SIZE,
                                     .coordinates = coordinates,
                                     .skew = TRB_FREE_RING_skew,
                                     .loses = 1,
                                     .pose = pose_of,
                                     .ring = ring_of,
                                     .rates = rates_of,
                                     .mass = mass_of,
                                     .kinetic = kinetic_of,
                                     .work = work_of};
