#include "body/ring.h"

#include <math.h>

void trb_drive_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
                     double shaft_speed, trb_drive *drive)
{
  const double   rx = rotation[0], ry = rotation[1], angle = sqrt(rx * rx + ry * ry);
  const double   sinc = angle > 1e-8 ? sin(angle) / angle : 1.0 - angle * angle / 6.0;
  const double   slope = angle > 1e-4 ? (cos(angle) - sinc) / (angle * angle) : -1.0 / 3.0; /* d sinc / d(angle^2/2) */
  const trb_vec3 axis = trb_v(sinc * ry, -sinc * rx, cos(angle)), centre = trb_v(0.0, 0.0, m->geometry.centre_plane);
  const double   turn = rx * rotation_rate[0] + ry * rotation_rate[1];
  const trb_vec3 axis_rate = trb_v(sinc * rotation_rate[1] + slope * turn * ry, -sinc * rotation_rate[0] - slope * turn * rx, -sinc * turn);
  drive->displacement = displacement;
  drive->ring_omega = trb_cross(axis, axis_rate);
  drive->ring.axis = axis;
  drive->ring.centre = trb_add(displacement, centre);
  drive->ring.velocity = velocity;
  drive->ring.angle = drive->shaft_angle;
  drive->ring.omega = trb_axpy(drive->ring_omega, shaft_speed, axis);
}

/* Moments on a ring at rest are about the apex. */
static void place_at_rest(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  (void)m;
  (void)drive;
  *pose = (trb_ring_pose){.axis = {0, 0, 1}};
}

static void place_as_prescribed(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  (void)m;
  *pose = drive->ring;
}

/* About the apex, as a ring at rest. */
static void place_turning(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  (void)m;
  *pose = (trb_ring_pose){.axis = {0, 0, 1}, .omega = {0, 0, drive->carried_speed}, .angle = drive->carried_angle};
}

static trb_drive_power power_of_turning(const trb_ring_pose *ring, const trb_drive *drive, const trb_wrench *on_ring)
{
  (void)drive;
  return (trb_drive_power){-trb_dot(on_ring->moment, ring->omega), 0.0};
}

static trb_drive_power power_of_drive(const trb_ring_pose *ring, const trb_drive *drive, const trb_wrench *on_ring)
{
  const double shaft = -trb_dot(on_ring->moment, ring->axis) * drive->shaft_speed;
  return (trb_drive_power){shaft, -trb_dot(on_ring->force, ring->velocity) - trb_dot(on_ring->moment, ring->omega) - shaft};
}

const trb_body_kind trb_ring_at_rest = {.name = "ring at rest", .rests = 1, .place = place_at_rest};
const trb_body_kind trb_ring_prescribed = {.name = "ring as prescribed", .place = place_as_prescribed, .power = power_of_drive};
const trb_body_kind trb_ring_turning = {.name = "ring that turns as prescribed", .place = place_turning, .power = power_of_turning};
const trb_body_kind trb_fluid_at_rest = {.name = "fluid at rest", .rests = 1};
