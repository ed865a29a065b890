/* What changes in time: the layout of the state vector, and the poses that it stands for (docs/theory/motion.md#coordinates).
 *
 * The frame R turns about the bearing axis with the kinematic cage angle. A roller's coordinates are cylindrical and are offsets from
 * pure rolling; its axis is given by skew and tilt in the frame (e_r, e_t, e_z) that orbits with it; its velocities are inertial
 * velocities that are written in orbiting frames. In steady rolling the whole vector stands still. The spin angle is in the tail of the
 * vector, as nothing depends on it. */
#ifndef TRB_BEARING_STATE_H
#define TRB_BEARING_STATE_H

#include "base/vec3.h"
#include "bearing/model.h"
#include "laws/smooth.h"

/* X(name, unit kind, text): kind is the tolerance that the entry is integrated to. */
#define TRB_ROLLER_STATE(X) \
  X(r,       POSITION, "radius of the centre of mass, minus nominal, m") \
  X(psi,     ANGLE,    "orbit angle, minus nominal place and kinematic cage angle, rad") \
  X(z,       POSITION, "axial position of the centre of mass, minus nominal, m") \
  X(skew,    ANGLE,    "axis turned in the tangential direction, rad") \
  X(tilt,    ANGLE,    "axis turned in the axial plane, minus nominal, rad") \
  X(v_r,     VELOCITY, "radial velocity, m/s") \
  X(v_t,     VELOCITY, "tangential velocity, minus kinematic, m/s") \
  X(v_z,     VELOCITY, "axial velocity, m/s") \
  X(omega_n, SPIN,     "angular velocity along n, minus kinematic, rad/s") \
  X(omega_t, SPIN,     "angular velocity along t, rad/s") \
  X(omega_a, SPIN,     "angular velocity along the axis, minus kinematic, rad/s")

#define TRB_CAGE_STATE(X) \
  X(x,       POSITION, "centre of mass along the first axis of R, m") \
  X(y,       POSITION, "centre of mass along the second axis of R, m") \
  X(z,       POSITION, "axial position, minus nominal, m") \
  X(skew,    ANGLE,    "axis turned towards the second axis of R, rad") \
  X(tilt,    ANGLE,    "axis turned towards the first axis of R, rad") \
  X(psi,     ANGLE,    "turn about the own axis, minus kinematic cage angle, rad") \
  X(v_x,     VELOCITY, "inertial velocity along the first axis of R, m/s") \
  X(v_y,     VELOCITY, "inertial velocity along the second axis of R, m/s") \
  X(v_z,     VELOCITY, "axial velocity, m/s") \
  X(omega_n, SPIN,     "angular velocity along n, rad/s") \
  X(omega_t, SPIN,     "angular velocity along t, rad/s") \
  X(omega_a, SPIN,     "angular velocity along the axis, minus kinematic, rad/s")

/* Quadratures of the energy audit (docs/theory/energy.md#quadratures); each has its field loss_* or work_* in a record. */
#define TRB_QUADRATURES(X) \
  X(work_shaft) X(work_ring) X(work_gravity) X(loss_traction_outer) X(loss_traction_inner) X(loss_rolling) \
  X(loss_rolling_pressure) X(loss_rib) X(loss_front_rib) X(loss_pocket) X(loss_damping)

typedef enum trb_tolerance {
  TRB_TOL_POSITION,
  TRB_TOL_ANGLE,
  TRB_TOL_VELOCITY,
  TRB_TOL_SPIN,
  TRB_TOL_QUADRATURE,
  TRB_N_TOLERANCES
} trb_tolerance;

enum {
#define TRB_STATE_ENUM(name, kind, text) TRB_ROLLER_##name,
  TRB_ROLLER_STATE(TRB_STATE_ENUM)
#undef TRB_STATE_ENUM
      TRB_ROLLER_SIZE
};

enum {
#define TRB_STATE_ENUM(name, kind, text) TRB_CAGE_##name,
  TRB_CAGE_STATE(TRB_STATE_ENUM)
#undef TRB_STATE_ENUM
      TRB_CAGE_SIZE
};

enum {
#define TRB_QUADRATURE_ENUM(name) TRB_Q_##name,
  TRB_QUADRATURES(TRB_QUADRATURE_ENUM)
#undef TRB_QUADRATURE_ENUM
      TRB_N_QUADRATURES
};

/* State vector: rollers, cage, then the tail: a spin angle per roller, the quadratures. */
static inline int trb_state_roller(int roller) { return roller * TRB_ROLLER_SIZE; }
static inline int trb_state_cage(const trb_model *m) { return m->n_rollers * TRB_ROLLER_SIZE; }
static inline int trb_state_main_size(const trb_model *m) { return trb_state_cage(m) + TRB_CAGE_SIZE; }
static inline int trb_state_spin(const trb_model *m) { return trb_state_main_size(m); }
static inline int trb_state_quadrature(const trb_model *m) { return trb_state_spin(m) + m->n_rollers; }
static inline int trb_state_size(const trb_model *m) { return trb_state_quadrature(m) + TRB_N_QUADRATURES; }

/* Rollers of a state of this size. */
static inline int trb_state_rollers(int size) { return (size - TRB_CAGE_SIZE - TRB_N_QUADRATURES) / (TRB_ROLLER_SIZE + 1); }

/* Tolerance kind of every entry. */
trb_tolerance trb_state_tolerance(const trb_model *m, int index);

/* A rigid surface that turns: position, axis and velocity field v(p) = velocity + omega x (p - centre). */
typedef struct trb_ring_pose {
  trb_vec3 apex;     /* apex of the raceway cone, m */
  trb_vec3 axis;     /* unit vector */
  trb_vec3 centre;   /* reference point of the motion, on the axis in the roller-centre plane, m */
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

/* A roller, in its own cylindrical frame (e_r, e_t, e_z) at its orbit angle; origin: the apex. */
typedef struct trb_roller_pose {
  double    radius;       /* of the centre of mass from the bearing axis, m */
  double    angle;        /* orbit angle in R: nominal place plus psi, rad */
  double    cosine, sine; /* of angle */
  double    orbit_speed;  /* inertial rate of the orbit angle, rad/s */
  trb_vec3  x;            /* centre of mass, m */
  trb_frame frame;        /* n, t, a; does not spin */
  trb_vec3  v;            /* inertial velocity, m/s */
  trb_vec3  omega;        /* inertial angular velocity, rad/s */
  trb_vec3  omega_frame;  /* the same in (n, t, a) */
} trb_roller_pose;

/* The cage, in R. */
typedef struct trb_cage_pose {
  trb_vec3  x;           /* centre of mass, from the apex, m */
  trb_frame frame;       /* n, t, a; does not turn with the cage */
  trb_frame body;        /* axes of the cage, through which pocket j stands at 2 pi j/Z */
  trb_vec3  v;           /* inertial velocity, m/s */
  trb_vec3  omega;       /* inertial angular velocity, rad/s */
  trb_vec3  omega_frame; /* the same in (n, t, a) */
} trb_cage_pose;

/* Velocities of pure rolling; the state holds offsets from them. */
typedef struct trb_rolling {
  double v_t;     /* tangential velocity of a roller, m/s */
  double omega_n; /* rad/s */
  double omega_a; /* rad/s */
} trb_rolling;

static inline trb_rolling trb_pure_rolling(const trb_model *m, double shaft_speed)
{
  const trb_geometry *g = &m->geometry;
  const double        orbit = g->cage_speed_ratio * shaft_speed;
  return (trb_rolling){orbit * g->roller_centre_radius, -orbit * m->axis_sine, orbit * m->axis_cosine - g->roller_spin_ratio * shaft_speed};
}

static inline double trb_nominal_angle(const trb_model *m, int roller) { return 2.0 * TRB_PI * roller / m->n_rollers; }

void trb_roller_pose_unpack(const trb_model *m, const trb_drive *drive, int roller, const double *y, trb_roller_pose *pose);
void trb_cage_pose_unpack(const trb_model *m, const trb_drive *drive, const double *y, trb_cage_pose *pose);

/* The inner ring as a roller's cylindrical frame sees it. */
trb_ring_pose trb_ring_pose_in_frame(const trb_ring_pose *ring, double cosine, double sine);

#endif
