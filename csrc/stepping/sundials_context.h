/* A SUNDIALS context with its messages caught: nothing is printed. */
#ifndef TRB_STEPPING_SUNDIALS_CONTEXT_H
#define TRB_STEPPING_SUNDIALS_CONTEXT_H

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

/* A serial vector over an array that the caller owns. */
static inline N_Vector trb_sundials_vector(trb_sundials *sundials, int n, double *values)
{
  return N_VMake_Serial((sunindextype)n, values, sundials->context);
}

/* Version of the library that this was built with. */
const char *trb_sundials_version(void);

#endif
