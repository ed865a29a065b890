/* Records and peaks of a run, computed beside the stepping by a second thread.
 *
 * A record needs an exact evaluation of every contact, and peaks look at all loads at the end of every step; together they cost more
 * than half as much as the steps themselves. Both follow from the states that the integrator has reached, and change nothing in it. So the
 * stepping puts each state that they need into a queue, in their order, and goes on; the second thread takes the states from the queue
 * and computes. What it computes is the same to the bit as without it. The thread lives within one call of `trb_simulation_run`: when
 * the call returns, the queue is empty and the thread has ended. It never calls Python, and takes no signals. */
#ifndef TRB_STEPPING_RECORDER_H
#define TRB_STEPPING_RECORDER_H

#include "motion/peaks.h"
#include "motion/record.h"

typedef struct trb_recorder trb_recorder;

/* What a recorder works with; nothing else may use it until the recorder is closed. */
typedef struct trb_recorder_parts {
  const trb_model *model;
  trb_dynamics    *onlooker;
  trb_detail      *detail;
  trb_peaks       *peaks; /* NULL: not asked for */
} trb_recorder_parts;

/* Starts the thread. NULL where there is no memory or no thread to be had: the caller then computes by itself. */
trb_recorder *trb_recorder_open(const trb_recorder_parts *parts, int n_state);
/* The end of a step, for peaks. */
void trb_recorder_step(trb_recorder *r, double time, const double *y);
/* A record at a state; stepping: the dynamics that the steps are taken with; row: where it goes, peaks after it. */
void trb_recorder_record(trb_recorder *r, const trb_dynamics *stepping, double time, const double *y, double *row);
/* Waits until everything is computed, and ends the thread. */
void trb_recorder_close(trb_recorder *r);

#endif
