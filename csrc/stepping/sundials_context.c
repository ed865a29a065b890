#include "stepping/sundials_context.h"

#include <stdio.h>

#if TRB_SUNDIALS_AT_LEAST(7, 0)
static void keep_message(int line, const char *function, const char *file, const char *text, SUNErrCode code, void *data,
                         SUNContext context)
{
  trb_sundials *s = data;
  (void)line;
  (void)file;
  (void)code;
  (void)context;
  (void)snprintf(s->text, sizeof s->text, "%s: %s", function != NULL ? function : "?", text != NULL ? text : "?");
}
#else
static void keep_message(int code, const char *module, const char *function, char *text, void *data)
{
  trb_sundials *s = data;
  (void)code;
  (void)module;
  (void)snprintf(s->text, sizeof s->text, "%s: %s", function, text);
}
#endif

trb_status trb_sundials_open(trb_sundials *sundials, trb_message *message)
{
  sundials->text[0] = '\0';
  sundials->context = NULL;
  if (!trb_sundials_has_room(1)) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  if (SUNContext_Create(TRB_SUN_NO_COMM, &sundials->context) != 0 || sundials->context == NULL)
    return trb_fail(message, TRB_ERR_SOLVER, "SUNDIALS: no context");
#if TRB_SUNDIALS_AT_LEAST(7, 0)
  if (SUNContext_ClearErrHandlers(sundials->context) != 0 || SUNContext_PushErrHandler(sundials->context, keep_message, sundials) != 0) {
    trb_sundials_close(sundials);
    return trb_fail(message, TRB_ERR_SOLVER, "SUNDIALS: no error handler");
  }
#endif
  return TRB_OK;
}

void trb_sundials_close(trb_sundials *sundials)
{
  if (sundials->context != NULL) (void)SUNContext_Free(&sundials->context);
  sundials->context = NULL;
}

N_Vector trb_sundials_vector(trb_sundials *sundials, int n, double *values)
{
  return trb_sundials_has_room(1) ? N_VMake_Serial((sunindextype)n, values, sundials->context) : NULL;
}

void trb_sundials_quiet_cvode(trb_sundials *sundials, void *memory)
{
  (void)CVodeSetMaxHnilWarns(memory, -1); /* steps too small to move the time: not an error, and its warning would be printed */
#if TRB_SUNDIALS_AT_LEAST(7, 0)
  (void)sundials;
  (void)memory;
#else
  (void)CVodeSetErrHandlerFn(memory, keep_message, sundials);
#endif
}

void trb_sundials_quiet_erk(trb_sundials *sundials, void *memory)
{
  (void)TRB_ARK(SetMaxHnilWarns)(memory, -1);
#if TRB_SUNDIALS_AT_LEAST(7, 0)
  (void)sundials;
  (void)memory;
#else
  (void)ERKStepSetErrHandlerFn(memory, keep_message, sundials);
#endif
}

const char *trb_sundials_version(void) { return SUNDIALS_VERSION; }
