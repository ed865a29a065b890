/* A SUNDIALS context with its messages caught: nothing is printed. */
#ifndef TRB_STEPPING_SUNDIALS_CONTEXT_H
#define TRB_STEPPING_SUNDIALS_CONTEXT_H

#include "base/memory.h"
#include "base/status.h"
#include "stepping/sundials_shim.h"

typedef struct trb_sundials {
  SUNContext context;
  char       text[256]; /* last message of the library */
} trb_sundials;

trb_status trb_sundials_open(trb_sundials *sundials, trb_message *message);
void       trb_sundials_close(trb_sundials *sundials);
/* Route the messages of an integrator's memory here; from 7 on the context does it for all. */
void trb_sundials_quiet_cvode(trb_sundials *sundials, void *memory);
void trb_sundials_quiet_erk(trb_sundials *sundials, void *memory);

/* Whether there is memory for n objects of SUNDIALS. The library makes vectors, matrices and solvers without looking whether there is. */
static inline int trb_sundials_has_room(int n) { return trb_has_room((size_t)n * 4096); }

/* Whether there is memory for all that an integrator makes for a state of a length. Where its first function cannot allocate its vectors, its
 * last one frees them a second time. */
static inline int trb_sundials_has_room_for(int length) { return trb_has_room(40 * (4096 + (size_t)length * sizeof(double))); }

/* A serial vector over an array that the caller owns. NULL: out of memory. */
N_Vector trb_sundials_vector(trb_sundials *sundials, int n, double *values);

/* Version of the library that this was built with. */
const char *trb_sundials_version(void);

#endif
