/* A ring as a rigid body, the inner one with what turns with it, the outer one with its housing: six degrees of freedom under its load, its
 * unbalance, its weight, supports and dampers to the surroundings (docs/theory/motion.md#a-free-ring). Its coordinates are inertial, so that
 * they stand still under a constant load. */
#ifndef TRB_BODY_FREE_RING_H
#define TRB_BODY_FREE_RING_H

#include "body/body.h"

/* X(name, unit kind, text), as for rollers. */
#define TRB_FREE_RING_STATE(X) \
  X(x,       POSITION, "centre of mass along x, m") \
  X(y,       POSITION, "centre of mass along y, m") \
  X(z,       POSITION, "axial position of the centre of mass, minus nominal, m") \
  X(skew,    ANGLE,    "axis turned towards y, rad") \
  X(tilt,    ANGLE,    "axis turned towards x, rad") \
  X(psi,     ANGLE,    "turn about the own axis, minus prescribed shaft angle, rad") \
  X(v_x,     VELOCITY, "velocity along x, m/s") \
  X(v_y,     VELOCITY, "velocity along y, m/s") \
  X(v_z,     VELOCITY, "axial velocity, m/s") \
  X(omega_n, SPIN,     "angular velocity along n, rad/s") \
  X(omega_t, SPIN,     "angular velocity along t, rad/s") \
  X(omega_a, SPIN,     "angular velocity along the axis, minus prescribed shaft speed, rad/s")

enum {
#define TRB_STATE_ENUM(name, kind, text) TRB_FREE_RING_##name,
  TRB_FREE_RING_STATE(TRB_STATE_ENUM)
#undef TRB_STATE_ENUM
      TRB_FREE_RING_SIZE
};
_Static_assert((int)TRB_FREE_RING_SIZE <= (int)TRB_MOST_CARRIED, "room for what a carried ring adds to the rates of the shaft");

extern const trb_body_kind trb_ring_free, trb_ring_housed;

#endif
