/* A simulation owns what changes: dynamics, state, integrator, buffers of a record. Models and motions are shared and const. Bearings that
 * are simulated together are an assembly (system/assembly.h): records, peaks and what users ask about states are made bearing by bearing. */
#ifndef TRB_STEPPING_SIMULATION_H
#define TRB_STEPPING_SIMULATION_H

#include "motion/peaks.h"
#include "motion/record.h"
#include "stepping/integrator.h"
#include "stepping/recorder.h"

typedef struct trb_simulation {
  trb_assembly     assembly;
  trb_integrator   integrator;              /* with the dynamics of the integration */
  trb_record_parts parts[TRB_MOST_MEMBERS]; /* what records of each bearing are made with */
  unsigned        *apart[TRB_MOST_MEMBERS]; /* what is known not to touch at an output time */
  double          *between;                 /* state at an output time */
  double           previous;                /* start of the last step, s */
  int              with_peaks;              /* whether peaks are kept */
  trb_recorder    *recorder;                /* within a run that has one; else NULL */
  trb_memory       memory;                  /* of all arrays */
} trb_simulation;

/* Of n bearings: their systems, which are copied, and what is prescribed for each. kind: name of an integrator, or "auto": trb_integrator_choose; variant: of a kernel variant
 * or "". n_state: length of the state. */
trb_status trb_simulation_create(const trb_system *const *systems, const trb_motion *const *motions, int n, const char *kind,
                                 const char *variant, const trb_settings *settings, double time, const double *state, int n_state,
                                 trb_simulation **simulation, trb_message *message);
void       trb_simulation_free(trb_simulation *s);

/* Start the integrator again at a state. */
trb_status trb_simulation_set_state(trb_simulation *s, double time, const double *state, trb_message *message);

/* One step. On an error time and state are those of the last good step. */
trb_status trb_simulation_step(trb_simulation *s, trb_message *message);

/* The state at an instant of the last step. */
trb_status trb_simulation_state_at(trb_simulation *s, double time, double *y, trb_message *message);

/* Start to keep peaks from an instant of the last step on; end it. */
trb_status trb_simulation_begin_peaks(trb_simulation *s, double time, trb_message *message);
void       trb_simulation_end_peaks(trb_simulation *s);
/* Go on with peaks that were saved at this simulation's time: length numbers. */
trb_status trb_simulation_restore_peaks(trb_simulation *s, const double *saved, int length, trb_message *message);

/* Length of what peaks are saved in; 0 where none are kept. */
int  trb_simulation_peaks_length(const trb_simulation *s);
void trb_simulation_save_peaks(const trb_simulation *s, double *to);
/* Rows of peaks of all bearings from their beginning to an instant of the last step, one after the other, and their length. */
int  trb_simulation_whole_length(const trb_simulation *s);
void trb_simulation_whole_peaks(const trb_simulation *s, double time, double *to);

/* Length of a row of records: of each bearing a record, and after it a row of peaks if they are kept. */
int trb_simulation_row(const trb_simulation *s);

/* Steps until all of n increasing times are passed, at most max_steps, and no more after the first step that ends at or after
 * stop_after. Writes one row of records for each time. Output times never change the steps. beside: whether records and peaks are
 * computed by a second thread. */
trb_status trb_simulation_run(trb_simulation *s, const double *times, int n, double stop_after, double *records, long max_steps, int beside,
                              int *rows, long *steps, trb_message *message);

#endif
