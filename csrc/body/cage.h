/* The cage: rigid, six degrees of freedom. Its coordinates with their tolerances, its pose, its rates under a load. In a bearing without a
 * cage they are there and stand still. */
#ifndef TRB_BODY_CAGE_H
#define TRB_BODY_CAGE_H

#include "body/body.h"

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

/* The spacer takes the place of a cage: it holds all rollers at even spacing on one orbit (motion/spacer.h), and has no play, no friction and
 * no displacement. Of its coordinates only the turn moves. */
extern const trb_body_kind trb_body_cage, trb_body_spacer;

/* What a cage that deforms has of a rigid one. */
void      trb_cage_pose(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose);
void      trb_cage_rates(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *cage, const double *y,
                         const trb_wrench *load, double *rates);
trb_rigid trb_cage_motion(const trb_rigid_pose *cage, int coordinate);
double    trb_cage_mass(const trb_model *m, const trb_body *body);
double    trb_cage_kinetic(const trb_model *m, const trb_body *body, const trb_rigid_pose *cage);

#endif
