#include "body/free_ring.h"

#include <math.h>
#include <string.h>

#include "body/ring.h"

/* What is prescribed of its turn about its axis, in the axes of its coordinates. */
typedef struct turning {
  double angle, speed, rate;
} turning;

static turning turning_of(const trb_ring_body *own, const trb_drive *drive)
{
  if (own->is_outer)
    return (turning){own->sense * drive->carried_angle, own->sense * drive->carried_speed, own->sense * drive->carried_rate};
  return (turning){own->sense * drive->shaft_angle, own->sense * drive->shaft_speed, own->sense * drive->shaft_rate};
}

/* Coordinates of the inner ring are those of the shaft, in its axes, and those of the outer ring are its housing's. A bearing that sits there
 * the other way round has axes that are turned by half a turn about x. A vector from the axes of the coordinates into the bearing's, or back. */
static trb_vec3 other_axes(const trb_ring_body *own, trb_vec3 v) { return trb_v(v.x, own->sense * v.y, own->sense * v.z); }

/* The centre of mass from its nominal place, in the bearing's axes. */
static trb_vec3 place_of_mass(const trb_ring_body *own, const double *y)
{
  const trb_vec3 place = other_axes(own, trb_v(y[TRB_FREE_RING_x], y[TRB_FREE_RING_y], y[TRB_FREE_RING_z]));
  return trb_v(place.x, place.y, own->shift + place.z);
}

/* Angular velocity in the frame of its axis. */
static trb_vec3 turn_rate(const trb_ring_body *own, const trb_drive *drive, const double *y)
{
  return trb_v(y[TRB_FREE_RING_omega_n], y[TRB_FREE_RING_omega_t], turning_of(own, drive).speed + y[TRB_FREE_RING_omega_a]);
}

static trb_vec3 velocity_of(const double *y) { return trb_v(y[TRB_FREE_RING_v_x], y[TRB_FREE_RING_v_y], y[TRB_FREE_RING_v_z]); }

static trb_frame frame_of(const double *y) { return trb_tilted_frame(y[TRB_FREE_RING_skew], y[TRB_FREE_RING_tilt]); }

/* A vector from the shaft's axes into the frame R of the bearing, and back. */
static trb_vec3 into_r(const trb_ring_body *own, const trb_drive *drive, trb_vec3 v)
{
  return trb_turn_z(other_axes(own, v), drive->cosine, -drive->sine);
}

static trb_vec3 from_r(const trb_ring_body *own, const trb_drive *drive, trb_vec3 v)
{
  return other_axes(own, trb_turn_z(v, drive->cosine, drive->sine));
}

/* From the centre of mass to the reference point, on which loads act; the bearing's axis points along the shaft's or against it. */
static trb_vec3 arm_of(const trb_ring_body *own, const trb_frame *f) { return trb_scale(-own->offset * own->sense, f->a); }

static void ring_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_ring_pose *ring)
{
  (void)m;
  const trb_ring_body *own = body->own;
  const trb_frame      f = frame_of(y);
  const trb_vec3       along = arm_of(own, &f), arm = other_axes(own, along), place = place_of_mass(own, y);
  const trb_vec3       omega = trb_from_frame(&f, turn_rate(own, drive, y));
  ring->axis = other_axes(own, trb_scale(own->sense, f.a));
  ring->centre = trb_v(place.x + arm.x, place.y + arm.y, own->reference + (place.z + (own->offset + arm.z)));
  ring->omega = other_axes(own, omega);
  ring->angle = own->sense * (turning_of(own, drive).angle + y[TRB_FREE_RING_psi]);
  ring->velocity = other_axes(own, trb_add(velocity_of(y), trb_cross(omega, along)));
}

/* Springs between a point of the axis and the surroundings. They do not act where the ring stands at the start: the inner ring where the
 * drive places it, the outer one at its nominal place. */
typedef struct support {
  trb_vec3 force, moment; /* on the ring, about its reference point */
  double   energy;        /* J */
} support;

static support support_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y)
{
  const trb_ring_body *own = body->own;
  support              s = {{0, 0, 0}, {0, 0, 0}, 0.0};
  if (own->support_radial <= 0.0 && own->support_axial <= 0.0 && own->support_tilt <= 0.0) return s;
  const trb_ring_pose  nominal = {.axis = {0, 0, 1}, .centre = {0, 0, own->reference}};
  const trb_ring_pose *start = own->is_outer ? &nominal : &drive->ring;
  trb_ring_pose        ring;
  ring_of(m, body, drive, y, &ring);
  const trb_vec3 leaned = trb_sub(ring.axis, start->axis);
  const trb_vec3 shift = trb_axpy(trb_sub(ring.centre, start->centre), own->support_position, leaned);
  s.force = trb_v(-own->support_radial * shift.x, -own->support_radial * shift.y, -own->support_axial * shift.z);
  s.moment =
      trb_axpy(trb_cross(trb_scale(own->support_position, ring.axis), s.force), -own->support_tilt, trb_cross(start->axis, ring.axis));
  s.energy = -0.5 * trb_dot(s.force, shift) + 0.5 * own->support_tilt * trb_dot(leaned, leaned);
  return s;
}

/* What acts on the ring at its reference point but for contacts and springs. */
static trb_wrench given_on(const trb_ring_body *own, const trb_drive *drive) { return own->is_outer ? drive->housing_load : drive->load; }

static void pose_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  const trb_ring_body *own = body->own;
  const trb_frame      f = frame_of(y);
  const double         turn = turning_of(own, drive).angle + y[TRB_FREE_RING_psi], turn_cos = cos(turn), turn_sin = sin(turn);
  const trb_vec3       v = velocity_of(y), about = trb_v(y[TRB_FREE_RING_omega_n], y[TRB_FREE_RING_omega_t], 0.0);
  const trb_vec3       place = place_of_mass(own, y);
  pose->x = trb_turn_z(trb_v(place.x, place.y, own->reference + own->offset + place.z), drive->cosine, -drive->sine);
  pose->frame = (trb_frame){into_r(own, drive, f.n), into_r(own, drive, f.t), into_r(own, drive, f.a)};
  pose->body.n = trb_add(trb_scale(turn_cos, pose->frame.n), trb_scale(turn_sin, pose->frame.t));
  pose->body.t = trb_sub(trb_scale(turn_cos, pose->frame.t), trb_scale(turn_sin, pose->frame.n));
  pose->body.a = pose->frame.a;
  pose->v = into_r(own, drive, v);
  pose->omega_frame = turn_rate(own, drive, y);
  pose->omega = trb_from_frame(&pose->frame, pose->omega_frame);
  pose->moving = 0.0;
  pose->stored = support_of(m, body, drive, y).energy;
  pose->lost = own->damping * trb_dot(v, v) + own->damping_turns * trb_dot(about, about);
}

/* What acts on the ring, in the shaft's axes, which do not move. */
typedef struct loading {
  trb_vec3 force, moment; /* sum, about the centre of mass */
  trb_vec3 unbalance;     /* force */
} loading;

/* m e (W^2 (cos phi, sin phi) + W' (sin phi, -cos phi)) (Genta, Dynamics of Rotating Systems). */
static trb_vec3 unbalance_of(const trb_ring_body *own, const trb_drive *drive, const double *y)
{
  if (own->unbalance <= 0.0) return trb_v(0, 0, 0);
  const turning turned = turning_of(own, drive);
  const double  phi = turned.angle + y[TRB_FREE_RING_psi] + own->unbalance_angle, c = cos(phi), s = sin(phi);
  const double  speed = turned.speed + y[TRB_FREE_RING_omega_a];
  return trb_scale(own->unbalance, trb_v(speed * speed * c + turned.rate * s, speed * speed * s - turned.rate * c, 0.0));
}

/* load: of contacts, about the reference point, in R. */
static loading loading_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_frame *f, const double *y,
                          const trb_wrench *load)
{
  const trb_ring_body *own = body->own;
  const trb_wrench     given = given_on(own, drive);
  const trb_vec3       across = trb_v(y[TRB_FREE_RING_omega_n], y[TRB_FREE_RING_omega_t], 0.0);
  const support        held = support_of(m, body, drive, y);
  const trb_vec3       at_centre = trb_add(trb_add(from_r(own, drive, load->force), given.force), held.force);
  loading              on = {.unbalance = unbalance_of(own, drive, y)};
  on.force = trb_axpy(trb_add(at_centre, on.unbalance), -own->damping, velocity_of(y));
  on.moment = trb_add(trb_add(from_r(own, drive, load->moment), given.moment), trb_cross(arm_of(own, f), at_centre));
  on.moment = trb_add(on.moment, held.moment);
  on.moment = trb_axpy(on.moment, -own->damping_turns, trb_from_frame(f, across));
  return on;
}

static void rates_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                     const trb_wrench *load, double *rates)
{
  (void)pose;
  const trb_ring_body *own = body->own;
  const trb_frame      f = frame_of(y);
  const loading        on = loading_of(m, body, drive, &f, y, load);
  const double         per_mass = 1.0 / own->mass;
  const trb_turn_rates turn =
      trb_euler(&f, turn_rate(own, drive, y), 0.0, own->inertia_transverse, own->inertia_axial, trb_to_frame(&f, on.moment));
  memset(rates, 0, TRB_FREE_RING_SIZE * sizeof *rates);
  rates[TRB_FREE_RING_x] = y[TRB_FREE_RING_v_x];
  rates[TRB_FREE_RING_y] = y[TRB_FREE_RING_v_y];
  rates[TRB_FREE_RING_v_x] = per_mass * on.force.x + drive->gravity.x;
  rates[TRB_FREE_RING_v_y] = per_mass * on.force.y + drive->gravity.y;
  if (!own->keeps_speed) {
    rates[TRB_FREE_RING_psi] = y[TRB_FREE_RING_omega_a] - turn.frame_a;
    rates[TRB_FREE_RING_omega_a] = turn.spin.z + drive->torque / own->inertia_axial - drive->shaft_rate;
  }
  if (m->params.effects.planar > 0.0) return;
  rates[TRB_FREE_RING_z] = y[TRB_FREE_RING_v_z];
  rates[TRB_FREE_RING_skew] = turn.skew;
  rates[TRB_FREE_RING_tilt] = turn.tilt;
  rates[TRB_FREE_RING_v_z] = per_mass * on.force.z + drive->gravity.z;
  rates[TRB_FREE_RING_omega_n] = turn.spin.x;
  rates[TRB_FREE_RING_omega_t] = turn.spin.y;
}

static double mass_of(const trb_model *m, const trb_body *body)
{
  (void)m;
  return ((const trb_ring_body *)body->own)->mass;
}

static double kinetic_of(const trb_model *m, const trb_body *body, const trb_rigid_pose *pose)
{
  (void)m;
  const trb_ring_body *own = body->own;
  return trb_kinetic(own->mass, own->inertia_axial, own->inertia_transverse, pose->v, pose->omega_frame);
}

/* The drive keeps the speed against all moments about the axis, or gives its torque; it carries the unbalance round, too. The loads move
 * with the reference point. */
static trb_drive_power work_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, const trb_wrench *load)
{
  const trb_ring_body *own = body->own;
  const trb_wrench     given = given_on(own, drive);
  const trb_frame      f = frame_of(y);
  const loading        on = loading_of(m, body, drive, &f, y, load);
  const double         kept = own->inertia_axial * turning_of(own, drive).rate - trb_dot(on.moment, f.a);
  const double         torque = own->keeps_speed ? kept : drive->torque;
  trb_ring_pose        ring;
  ring_of(m, body, drive, y, &ring);
  return (trb_drive_power){torque * turn_rate(own, drive, y).z + trb_dot(on.unbalance, velocity_of(y)),
                           trb_dot(given.force, ring.velocity) + trb_dot(given.moment, ring.omega)};
}

/* A force moves the centre of mass, and a moment about it turns the ring, but where the drive keeps the speed and carries it. */
static trb_drive_power added_by(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, const trb_wrench *load,
                                double *rates)
{
  const trb_ring_body *own = body->own;
  const trb_frame      f = frame_of(y);
  const trb_vec3       force = from_r(own, drive, load->force);
  const trb_vec3       moment = trb_to_frame(&f, trb_add(from_r(own, drive, load->moment), trb_cross(arm_of(own, &f), force)));
  const double         per_mass = 1.0 / own->mass;
  memset(rates, 0, TRB_FREE_RING_SIZE * sizeof *rates);
  rates[TRB_FREE_RING_v_x] = per_mass * force.x;
  rates[TRB_FREE_RING_v_y] = per_mass * force.y;
  if (!own->keeps_speed) rates[TRB_FREE_RING_omega_a] = moment.z / own->inertia_axial;
  if (!(m->params.effects.planar > 0.0)) {
    rates[TRB_FREE_RING_v_z] = per_mass * force.z;
    rates[TRB_FREE_RING_omega_n] = moment.x / own->inertia_transverse;
    rates[TRB_FREE_RING_omega_t] = moment.y / own->inertia_transverse;
  }
  return (trb_drive_power){own->keeps_speed ? -moment.z * turn_rate(own, drive, y).z : 0.0, 0.0};
}

/* Where they stand where no state is known. */
static void place_of(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose) { trb_ring_prescribed.place(m, drive, pose); }

static void place_outer(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose) { trb_ring_turning.place(m, drive, pose); }

static const trb_coordinate coordinates[TRB_FREE_RING_SIZE] = {TRB_FREE_RING_STATE(TRB_COORDINATE)};

#define RING(text, where) \
  {.name = text, \
   .place = where, \
   .size = TRB_FREE_RING_SIZE, \
   .coordinates = coordinates, \
   .skew = TRB_FREE_RING_skew, \
   .loses = 1, \
   .pose = pose_of, \
   .ring = ring_of, \
   .rates = rates_of, \
   .mass = mass_of, \
   .kinetic = kinetic_of, \
   .work = work_of, \
   .added = added_by}

const trb_body_kind trb_ring_free = RING("free ring", place_of), trb_ring_housed = RING("free ring in a housing", place_outer);
