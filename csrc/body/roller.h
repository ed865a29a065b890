/* Rollers: rigid, six degrees of freedom. A roller's coordinates with their tolerances, its pose, its inertia, and what a load does to it. */
#ifndef TRB_BODY_ROLLER_H
#define TRB_BODY_ROLLER_H

#include "body/drive.h"
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

enum {
#define TRB_STATE_ENUM(name, kind, text) TRB_ROLLER_##name,
  TRB_ROLLER_STATE(TRB_STATE_ENUM)
#undef TRB_STATE_ENUM
      TRB_ROLLER_SIZE
};

extern const trb_coordinate trb_roller_coordinates[TRB_ROLLER_SIZE];

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

/* Velocities of pure rolling at a speed of the shaft; the state holds offsets from them. */
typedef struct trb_rolling {
  double v_t;     /* tangential velocity of a roller, m/s */
  double omega_n; /* rad/s */
  double omega_a; /* rad/s */
} trb_rolling;

/* speed: of the inner ring relative to the outer one; carried: speed of the outer ring, with which all turns, rad/s. */
static inline trb_rolling trb_pure_rolling(const trb_model *m, double speed, double carried)
{
  const trb_geometry *g = &m->geometry;
  const double        orbit = g->cage_speed_ratio * speed + carried;
  return (trb_rolling){orbit * g->roller_centre_radius, -orbit * m->axis_sine, orbit * m->axis_cosine - g->roller_spin_ratio * speed};
}

static inline double trb_nominal_angle(const trb_model *m, int roller) { return 2.0 * TRB_PI * roller / m->n_rollers; }

void trb_roller_pose_unpack(const trb_model *m, const trb_drive *drive, int roller, const double *y, trb_roller_pose *pose);
/* Only where the centre is and how it moves: radius, angle with its cosine and sine, x, v. */
void trb_roller_pose_unpack_centre(const trb_model *m, const trb_drive *drive, int roller, const double *y, trb_roller_pose *pose);
/* Rates of a roller's coordinates and of its spin angle without loads; gives the power of gravity, W. */
double trb_roller_inertia(const trb_model *m, const trb_drive *drive, const trb_roller_pose *r, double *rates, double *spin);
/* Added to the rates: what a wrench does. */
void trb_roller_response(const trb_model *m, const trb_roller_pose *r, const trb_wrench *load, double *rates);
/* What stands against a roller's tangential acceleration, kg: its mass, with what frozen tilts add to it in planar motion. */
double trb_roller_orbit_mass(const trb_model *m, const trb_drive *drive, int roller, const double *y);
/* What a coordinate does to a roller's place, or to its velocity, in its cylindrical frame. */
trb_rigid trb_roller_motion(const trb_roller_pose *r, int coordinate);

static inline double trb_roller_kinetic(const trb_model *m, const trb_roller_pose *r)
{
  const trb_geometry *g = &m->geometry;
  return trb_kinetic(g->roller_mass, g->roller_inertia_axial, g->roller_inertia_transverse, r->v, r->omega_frame);
}

#endif
