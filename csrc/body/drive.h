/* What is prescribed at an instant: where a ring is placed and how fast it turns, how fast the frame R of the rollers turns, gravity, and
 * loads on a ring that moves. */
#ifndef TRB_BODY_DRIVE_H
#define TRB_BODY_DRIVE_H

#include "bearing/model.h"
#include "body/rigid.h"

/* A rigid surface of revolution that turns: position, axis and velocity field v(p) = velocity + omega x (p - centre). */
typedef struct trb_ring_pose {
  trb_vec3 axis;     /* unit vector */
  trb_vec3 centre;   /* reference point, on the axis: of the motion, of moments and of the ring's surfaces, m */
  trb_vec3 velocity; /* of the centre, m/s */
  trb_vec3 omega;    /* angular velocity, rad/s */
  double   angle;    /* that it has turned by about its axis, rad */
} trb_ring_pose;

/* In inertial coordinates. */
typedef struct trb_drive {
  double        time;          /* s */
  double        shaft_angle;   /* rad */
  double        shaft_speed;   /* rad/s */
  double        shaft_rate;    /* rad/s2 */
  double        carried_angle; /* rad */
  double        carried_speed; /* of the outer ring, with which all turns, rad/s */
  double        carried_rate;  /* rad/s2 */
  double        rolling_angle; /* of the shaft relative to the outer ring, rad */
  double        rolling_speed; /* of the shaft relative to the outer ring: rollers' coordinates count from pure rolling at it, rad/s */
  double        rolling_rate;  /* its rate, rad/s2 */
  double        frame_angle;   /* angle of R: that of the kinematic orbit, rad */
  double        frame_speed;   /* rad/s */
  double        frame_rate;    /* rad/s2 */
  double        cosine, sine;  /* of frame_angle */
  trb_ring_pose ring;          /* of the ring that is driven */
  trb_vec3      displacement;  /* of that ring, m */
  trb_vec3      ring_omega;    /* its angular velocity without the shaft's turn, rad/s */
  trb_vec3      gravity;       /* m/s2 */
  trb_wrench    load;          /* on an inner ring with coordinates, about its centre */
  trb_wrench    housing_load;  /* the same on an outer ring */
  double        torque;        /* about its axis, of a ring whose speed is not prescribed, N m */
} trb_drive;

/* Power that a wrench on a body takes from its drive, W: from the turn about its axis, and from the motion of its place. */
typedef struct trb_drive_power {
  double shaft, place;
} trb_drive_power;

static inline trb_ring_pose trb_ring_pose_in_frame(const trb_ring_pose *ring, double cosine, double sine)
{
  return (trb_ring_pose){trb_turn_z(ring->axis, cosine, -sine), trb_turn_z(ring->centre, cosine, -sine),
                         trb_turn_z(ring->velocity, cosine, -sine), trb_turn_z(ring->omega, cosine, -sine), ring->angle};
}

static inline int trb_has_gravity(const trb_drive *drive)
{
  return drive->gravity.x != 0.0 || drive->gravity.y != 0.0 || drive->gravity.z != 0.0;
}

/* Gravity in a frame turned about z by the angle whose cosine and sine are given, on top of R. */
static inline trb_vec3 trb_gravity_in(const trb_drive *drive, double cosine, double sine)
{
  return trb_turn_z(trb_turn_z(drive->gravity, drive->cosine, -drive->sine), cosine, -sine);
}

#endif
