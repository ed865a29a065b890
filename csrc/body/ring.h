/* The rings of a bearing. A ring is a rigid surface of revolution that turns. Contacts read its pose and ask no more; where the pose comes
 * from, and whether the work that is done on the ring is booked, is said by its kind: the outer ring rests, the inner one is placed and
 * turned as prescribed (body/rings.c is the table). What is prescribed at an instant is here too. */
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

/* The prescribed pose: displacement and misalignment (rotation vector in the x-y plane), with their rates, and the shaft's speed. */
void trb_ring_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
                    double shaft_speed, trb_drive *drive);

/* Power that a wrench on a ring takes from its drive, W: from the turn about its axis, and from the motion of its place. */
typedef struct trb_ring_power {
  double shaft, place;
} trb_ring_power;

typedef struct trb_ring_kind {
  const char *name;
  trb_body    body;  /* the loads on this body of a pair act on it */
  int         rests; /* 1: its pose is the same at all times, and in every frame that turns about the bearing's axis */
  void (*place)(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose); /* in inertial coordinates */
  /* pose and wrench in the same frame; NULL: it takes none */
  trb_ring_power (*power)(const trb_ring_pose *pose, const trb_drive *drive, const trb_wrench *on_ring);
} trb_ring_kind;

extern const trb_ring_kind trb_ring_at_rest, trb_ring_prescribed;

/* The rings, as in the bodies of body/rigid.h. */
enum { TRB_RING_OUTER, TRB_RING_INNER, TRB_N_RINGS };
extern const trb_ring_kind *const trb_ring_table[TRB_N_RINGS];

/* A ring at an instant. */
typedef struct trb_ring {
  trb_ring_pose  pose;     /* in inertial coordinates */
  trb_ring_pose *in_frame; /* n_rollers: in the cylindrical frame of each roller; NULL where nobody asks for them */
} trb_ring;

/* Poses of all rings, but those in the frames of rollers. */
void trb_rings_place(const trb_model *m, const trb_drive *drive, trb_ring *rings);

static inline trb_ring_pose trb_ring_pose_in_frame(const trb_ring_pose *ring, double cosine, double sine)
{
  return (trb_ring_pose){trb_turn_z(ring->axis, cosine, -sine), trb_turn_z(ring->centre, cosine, -sine),
                         trb_turn_z(ring->velocity, cosine, -sine), trb_turn_z(ring->omega, cosine, -sine)};
}

/* A ring in a frame that is turned about z by the angle whose cosine and sine are given. */
static inline trb_ring_pose trb_ring_in(const trb_ring *rings, int ring, double cosine, double sine)
{
  return trb_ring_table[ring]->rests ? rings[ring].pose : trb_ring_pose_in_frame(&rings[ring].pose, cosine, sine);
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
