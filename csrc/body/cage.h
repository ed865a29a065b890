/* The cage: rigid, six degrees of freedom. Its coordinates with their tolerances, its pose, its rates under a load. */
#ifndef TRB_BODY_CAGE_H
#define TRB_BODY_CAGE_H

#include "body/ring.h"

/* X(name, unit kind, text), as for rollers. */
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

enum {
#define TRB_STATE_ENUM(name, kind, text) TRB_CAGE_##name,
  TRB_CAGE_STATE(TRB_STATE_ENUM)
#undef TRB_STATE_ENUM
      TRB_CAGE_SIZE
};

/* The cage, in R. */
typedef struct trb_cage_pose {
  trb_vec3  x;           /* centre of mass, from the apex, m */
  trb_frame frame;       /* n, t, a; does not turn with the cage */
  trb_frame body;        /* axes of the cage, through which pocket j stands at 2 pi j/Z */
  trb_vec3  v;           /* inertial velocity, m/s */
  trb_vec3  omega;       /* inertial angular velocity, rad/s */
  trb_vec3  omega_frame; /* the same in (n, t, a) */
} trb_cage_pose;

void trb_cage_pose_unpack(const trb_model *m, const trb_drive *drive, const double *y, trb_cage_pose *pose);
/* Rates of the cage's coordinates under a load; zero in a bearing without a cage. */
void trb_cage_rates(const trb_model *m, const trb_drive *drive, const trb_cage_pose *c, const double *y, const trb_wrench *load,
                    double *rates);
/* What a coordinate does to the cage's place, or to its velocity, in R. */
trb_rigid trb_cage_motion(const trb_cage_pose *cage, int coordinate);

static inline double trb_cage_kinetic(const trb_model *m, const trb_cage_pose *c)
{
  if (m->params.with_cage <= 0.0) return 0.0;
  return trb_kinetic(m->params.cage_mass, m->params.cage_inertia_axial, m->params.cage_inertia_transverse, c->v, c->omega_frame);
}

#endif
