/* What is prescribed in time: the inner ring's displacement, misalignment and speed, gravity, and loads on a free ring (docs/theory/motion.md#the-inner-ring).
 * Cubic Hermite between knots, so that velocities are continuous. Steps end at joints: the ends of the parts that a history consists of.
 * A knot that only samples a smooth curve, as those of a ring's path, is none. Before the first knot everything is constant; after the last knot too,
 * or the last part of the table repeats. The angles of shaft and outer
 * ring are the exact integrals of their speeds. */
#ifndef TRB_MOTION_RING_MOTION_H
#define TRB_MOTION_RING_MOTION_H

#include "base/memory.h"
#include "base/status.h"
#include "body/drive.h"

enum { TRB_MOTION_COLUMNS = 1 + 2 * TRB_N_CHANNELS + 1, TRB_MOTION_SMOOTH = TRB_MOTION_COLUMNS - 1 };

typedef struct trb_motion {
  int     n;     /* knots */
  double *table; /* n rows: time, then value and slope of each channel, then 1 where the curves go on smoothly at the knot, or 0 */
  double *angle; /* for each knot, the angles of shaft and outer ring, rad */
  int    *joint; /* for each knot, the last knot at or before it at which a history has a part of its own: 0, or one that is not smooth */
  int    *next;  /* and the first one after it; n: none */
  int     tail;  /* knot at which the part that repeats begins; n - 1: nothing repeats */
  int     moves; /* 1: a channel that contacts depend on changes: any but the loads on a free ring */
  trb_memory memory; /* of all arrays */
} trb_motion;

/* table: n rows of TRB_MOTION_COLUMNS, times increasing. Two rows may have the same time: the motion has a kink or a step there, from
 * the first of them to the second. Constant motion is one knot. */
trb_status trb_motion_create(const double *table, int n, trb_motion **motion, trb_message *message);
void       trb_motion_free(trb_motion *motion);

/* After the last knot the motion repeats what lies between the knot `period` before the last and the last one; both must have the same
 * values and slopes. */
trb_status trb_motion_repeat(trb_motion *motion, double period, trb_message *message);
/* Sets where angles are counted from: those of shaft and outer ring at a time. Without it they are zero at the first knot. */
void trb_motion_set_angles(trb_motion *motion, double time, double shaft, double carried);

/* Whether speed, a prescribed ring's place or gravity change at a time: all that forces depend on but the state. */
int trb_motion_under_way(const trb_motion *motion, double time);
/* Whether they change at any time between two. */
int trb_motion_changes(const trb_motion *motion, double from, double to);
/* Where a step from a time on must end at the latest, so that no part of a history is stepped over: the next joint, and between two
 * joints a part of what lies between. INFINITY where nothing changes any more. */
double trb_motion_stop(const trb_motion *motion, double time);
/* The longest step from a time on. Works and losses are integrated beside the motion and control no step: where bodies follow a smooth
 * history in long steps, a power that rises and falls within it would be summed up from a few values. Where nothing changes it is `most`,
 * what steps may be at most otherwise; elsewhere a whole number of such steps reaches the next joint, so that no sliver is left before it. */
double trb_motion_longest_step(const trb_motion *motion, double time, double most);
void   trb_motion_at(const trb_motion *motion, const trb_model *m, double time, trb_drive *drive);

#endif
