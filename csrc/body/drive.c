#include "body/drive.h"

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
