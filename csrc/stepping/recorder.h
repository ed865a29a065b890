/* Records and peaks of a run, computed by a second thread beside the stepping: they follow from the states that the integrator has reached, change
 * nothing in it, and cost together more than half as much as the steps. What is computed is the same to the bit as without it. The thread lives
 * within one call of `trb_simulation_run`, never calls Python, and takes no signals. */
#ifndef TRB_STEPPING_RECORDER_H
#define TRB_STEPPING_RECORDER_H

#include "motion/peaks.h"
#include "motion/record.h"

typedef struct trb_recorder trb_recorder;

/* What the records of a bearing are made with. */
typedef struct trb_record_parts {
  const trb_dynamics *stepping; /* that the steps are taken with */
  trb_dynamics       *onlooker; /* of records and of what users ask about states, so that the integration is not disturbed */
  trb_detail         *detail;
  trb_peaks          *peaks; /* NULL: not asked for */
} trb_record_parts;

/* Length of a bearing's part of a row: a record, then peaks if they are kept. */
int trb_record_parts_length(const trb_record_parts *parts);
/* Fills it; apart: of trb_fast_apart. */
void trb_record_parts_fill(const trb_record_parts *parts, const unsigned *apart, double time, const double *y, double *row);

/* Starts the thread. parts: of n bearings; nothing else may use what they hold until the recorder is closed, but for the dynamics of the
 * stepping. NULL where there is no memory or no thread to be had: the caller then computes by itself. */
trb_recorder *trb_recorder_open(const trb_record_parts *parts, int n, int n_state);
/* Records at a state; row: where they go, bearing by bearing; NULL: the end of a step, for peaks. */
void trb_recorder_put(trb_recorder *r, double time, const double *y, double *row);
/* Waits until everything is computed, and ends the thread. */
void trb_recorder_close(trb_recorder *r);

#endif
