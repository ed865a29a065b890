/* What rigid bodies with an axis of symmetry share: kinds of coordinates, Euler's equations, kinetic energy, motions and wrenches. */
#ifndef TRB_BODY_RIGID_H
#define TRB_BODY_RIGID_H

#include "base/vec3.h"

/* How exactly a coordinate is integrated. */
typedef enum trb_tolerance {
  TRB_TOL_POSITION,
  TRB_TOL_ANGLE,
  TRB_TOL_VELOCITY,
  TRB_TOL_SPIN,
  TRB_TOL_QUADRATURE,
  TRB_N_TOLERANCES
} trb_tolerance;

typedef struct trb_coordinate {
  const char   *name;
  trb_tolerance tolerance; /* to which it is integrated */
  const char   *text;
} trb_coordinate;

/* A row of a list X(name, unit kind, text) as a coordinate. */
#define TRB_COORDINATE(name, kind, text) {#name, TRB_TOL_##kind, text},

/* Force, and moment about the body's reference point. */
typedef struct trb_wrench {
  trb_vec3 force;  /* N */
  trb_vec3 moment; /* N m */
} trb_wrench;

static inline void trb_add_wrench(trb_wrench *to, const trb_wrench *w)
{
  to->force = trb_add(to->force, w->force);
  to->moment = trb_add(to->moment, w->moment);
}

/* Place and motion of a rigid body of the hub, in R. */
typedef struct trb_rigid_pose {
  trb_vec3  x;           /* centre of mass, from the apex, m */
  trb_frame frame;       /* n, t, a; does not turn with the body */
  trb_frame body;        /* axes that turn with it; in those of a cage pocket j stands at 2 pi j/Z */
  trb_vec3  v;           /* inertial velocity, m/s */
  trb_vec3  omega;       /* inertial angular velocity, rad/s */
  trb_vec3  omega_frame; /* the same in (n, t, a) */
  double    moving;      /* kinetic energy of what moves within the body, J */
  double    stored;      /* elastic energy within the body, J */
  double    lost;        /* power that is lost within it, W */
} trb_rigid_pose;

/* A rigid motion, about a body's centre of mass. */
typedef struct trb_rigid {
  trb_vec3 shift, turn;
} trb_rigid;

typedef struct trb_turn_rates {
  double   skew, tilt; /* rates of the axis' angles, rad/s */
  double   frame_a;    /* angular velocity of the frame (n, t, a) along a, rad/s */
  trb_vec3 spin;       /* angular acceleration in (n, t, a), rad/s2 */
} trb_turn_rates;

/* Euler's equations in a frame that follows the axis but does not spin (docs/theory/motion.md#eulers-equations); parent: angular
 * velocity, about z, of the frame in which skew and tilt are measured. */
static inline trb_turn_rates trb_euler(const trb_frame *f, trb_vec3 omega, double parent, double transverse, double axial, trb_vec3 moment)
{
  trb_turn_rates out;
  const double   cosine = f->t.y, sine = f->a.y; /* of the skew */
  out.skew = -(omega.x - parent * f->n.z);
  out.tilt = (omega.y - parent * f->t.z) / cosine;
  out.frame_a = parent * f->a.z + out.tilt * sine;
  const double spin = axial * omega.z, turn = transverse * out.frame_a;
  out.spin = trb_v((moment.x - omega.y * spin + turn * omega.y) / transverse, (moment.y - turn * omega.x + omega.x * spin) / transverse,
                   moment.z / axial);
  return out;
}

/* omega in (n, t, a), J. */
static inline double trb_kinetic(double mass, double axial, double transverse, trb_vec3 v, trb_vec3 omega)
{
  return 0.5 * (mass * trb_dot(v, v) + transverse * (omega.x * omega.x + omega.y * omega.y) + axial * omega.z * omega.z);
}

#endif
