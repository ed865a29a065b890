#include "body/ring.h"

#include <math.h>

void trb_ring_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
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
  drive->inner.axis = axis;
  drive->inner.centre = trb_add(displacement, centre);
  drive->inner.velocity = velocity;
  drive->inner.omega = trb_axpy(drive->ring_omega, shaft_speed, axis);
}

void trb_rings_place(const trb_model *m, const trb_drive *drive, trb_ring *rings)
{
  for (int r = 0; r < TRB_N_RINGS; r++) trb_ring_table[r]->place(m, drive, &rings[r].pose);
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
  *pose = drive->inner;
}

static trb_ring_power power_of_drive(const trb_ring_pose *ring, const trb_drive *drive, const trb_wrench *on_ring)
{
  const double shaft = -trb_dot(on_ring->moment, ring->axis) * drive->shaft_speed;
  return (trb_ring_power){shaft, -trb_dot(on_ring->force, ring->velocity) - trb_dot(on_ring->moment, ring->omega) - shaft};
}

const trb_ring_kind trb_ring_at_rest = {.name = "outer ring at rest", .body = TRB_BODY_OUTER_RING, .rests = 1, .place = place_at_rest};

const trb_ring_kind trb_ring_prescribed = {
    .name = "inner ring as prescribed", .body = TRB_BODY_INNER_RING, .place = place_as_prescribed, .power = power_of_drive};
