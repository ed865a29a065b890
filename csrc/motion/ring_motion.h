/* What is prescribed in time: the inner ring's displacement, misalignment and speed, and gravity. Cubic Hermite between knots, so that
 * velocities are continuous; constant (slope zero) outside. The shaft's angle is the exact integral of its speed. */
#ifndef TRB_MOTION_RING_MOTION_H
#define TRB_MOTION_RING_MOTION_H

#include "base/status.h"
#include "bearing/state.h"

enum { TRB_MOTION_COLUMNS = 1 + 2 * TRB_N_CHANNELS };

typedef struct trb_motion {
  int     n;     /* knots */
  double *table; /* n rows: time, then value and slope of each channel */
  double *angle; /* shaft angle at each knot, rad; zero at the first */
} trb_motion;

/* table: n rows of TRB_MOTION_COLUMNS, times increasing. Constant motion is one knot. */
trb_status trb_motion_create(const double *table, int n, trb_motion **motion, trb_message *message);
void       trb_motion_free(trb_motion *motion);

/* Whether speed, ring or gravity are between two knots of their histories. */
int trb_motion_under_way(const trb_motion *motion, double time);
/* Whether they are so at any time between two. */
int trb_motion_changes(const trb_motion *motion, double from, double to);
/* Where a step from a time on must end at the latest, so that no part of a history is stepped over: the next knot, and within an interval
 * a part of it. INFINITY where nothing changes any more. */
double trb_motion_stop(const trb_motion *motion, double time);
void   trb_motion_at(const trb_motion *motion, const trb_model *m, double time, trb_drive *drive);

/* Pose of the inner ring: displacement and misalignment (rotation vector in the x-y plane), with their rates, and the shaft's speed. */
void trb_ring_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
                    double shaft_speed, trb_drive *drive);

#endif
