/* The rings: the outer one stands still, the inner one is placed and turned as prescribed. Here too what is prescribed at an instant. */
#ifndef TRB_BODY_RING_H
#define TRB_BODY_RING_H

#include "bearing/model.h"
#include "body/rigid.h"

/* A rigid surface that turns: position, axis and velocity field v(p) = velocity + omega x (p - centre). */
typedef struct trb_ring_pose {
  trb_vec3 axis;     /* unit vector */
  trb_vec3 centre;   /* reference point, on the axis: of the motion, of moments and of the ring's surfaces, m */
  trb_vec3 velocity; /* of the centre, m/s */
  trb_vec3 omega;    /* angular velocity, rad/s */
} trb_ring_pose;

/* What is prescribed at an instant; inertial coordinates. */
typedef struct trb_drive {
  double        time;         /* s */
  double        shaft_angle;  /* rad */
  double        shaft_speed;  /* rad/s */
  double        shaft_rate;   /* rad/s2 */
  double        frame_angle;  /* angle of R: kinematic cage angle, rad */
  double        frame_speed;  /* rad/s */
  double        frame_rate;   /* rad/s2 */
  double        cosine, sine; /* of frame_angle */
  trb_ring_pose inner;        /* inner ring */
  trb_vec3      displacement; /* of the inner ring, m */
  trb_vec3      ring_omega;   /* its angular velocity without the shaft's turn, rad/s */
  trb_vec3      gravity;      /* m/s2 */
} trb_drive;

/* Pose of the inner ring: displacement and misalignment (rotation vector in the x-y plane), with their rates, and the shaft's speed. */
void trb_ring_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
                    double shaft_speed, trb_drive *drive);

/* The inner ring as a roller's cylindrical frame sees it. */
trb_ring_pose trb_ring_pose_in_frame(const trb_ring_pose *ring, double cosine, double sine);

/* Power that a wrench of rollers on the inner ring takes from the shaft's turn, and from the motion of its place, W. */
typedef struct trb_ring_power {
  double shaft, place;
} trb_ring_power;
static inline trb_ring_power trb_ring_power_of(const trb_ring_pose *ring, double shaft_speed, const trb_wrench *on_ring)
{
  const double shaft = -trb_dot(on_ring->moment, ring->axis) * shaft_speed;
  return (trb_ring_power){shaft, -trb_dot(on_ring->force, ring->velocity) - trb_dot(on_ring->moment, ring->omega) - shaft};
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
