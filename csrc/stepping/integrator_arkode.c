/* Explicit Runge-Kutta methods of ARKODE, for cross-checks. They need neither Jacobian nor Newton's method, and all forces are exact. */
#include <math.h>
#include <stdlib.h>

#include "stepping/constants.h"
#include "stepping/integrator.h"
#include "stepping/sundials_context.h"

typedef struct erk {
  trb_sundials   sundials;
  void          *memory;
  N_Vector       y;        /* over it->y */
  N_Vector       scratch;  /* of its own */
  trb_statistics before;   /* totals up to the last restart */
  double         smallest; /* smallest step, s */
} erk;

static int rates(sunrealtype time, N_Vector y, N_Vector out, void *data)
{
  return trb_integrator_rates(data, time, N_VGetArrayPointer(y), N_VGetArrayPointer(out));
}

static int weights(N_Vector y, N_Vector out, void *data)
{
  trb_integrator_weights(data, N_VGetArrayPointer(y), N_VGetArrayPointer(out));
  return 0;
}

#define CHECK(call) \
  do { \
    if ((call) != ARK_SUCCESS) return trb_fail(message, TRB_ERR_SOLVER, "ARKODE: %s failed: %s", #call, self->sundials.text); \
  } while (0)

static trb_status erk_create(trb_integrator *it, trb_message *message)
{
  erk *self = calloc(1, sizeof *self);
  if (self == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  it->self = self;
  self->smallest = INFINITY;
  const trb_status status = trb_sundials_open(&self->sundials, message);
  if (status != TRB_OK) return status;
  self->y = trb_sundials_vector(&self->sundials, it->n, it->y);
  if (self->y != NULL) self->scratch = N_VClone(self->y);
  if (self->y != NULL && trb_sundials_has_room_for(it->n)) self->memory = ERKStepCreate(rates, it->time, self->y, self->sundials.context);
  if (!self->y || !self->scratch || !self->memory) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  trb_sundials_quiet_erk(&self->sundials, self->memory);
  CHECK(TRB_ARK(SetUserData)(self->memory, it));
  CHECK(TRB_ARK(WFtolerances)(self->memory, weights));
  CHECK(TRB_ARK(SetOrder)(self->memory, TRB_EXPLICIT_ORDER));
  CHECK(TRB_ARK(SetMaxStep)(self->memory, it->settings.max_step));
  CHECK(TRB_ARK(SetInterpolantDegree)(self->memory, 3));
  if (it->settings.first_step > 0.0) CHECK(TRB_ARK(SetInitStep)(self->memory, it->settings.first_step));
  return TRB_OK;
}

static void erk_free(trb_integrator *it)
{
  erk *self = it->self;
  if (self == NULL) return;
  if (self->memory != NULL) TRB_ARK(Free)(&self->memory);
  if (self->scratch != NULL) N_VDestroy(self->scratch);
  if (self->y != NULL) N_VDestroy(self->y);
  trb_sundials_close(&self->sundials);
  free(self);
  it->self = NULL;
}

static void read_totals(const trb_integrator *it, trb_statistics *s)
{
  const erk *self = it->self;
  long       value = 0;
  *s = (trb_statistics){0};
  /* these getters fail only without memory, which create has checked */
  (void)TRB_ARK(GetNumSteps)(self->memory, &value);
  s->steps = self->before.steps + (double)value;
  value = 0;
#if TRB_SUNDIALS_AT_LEAST(7, 2)
  (void)ARKodeGetNumRhsEvals(self->memory, 0, &value);
#else
  (void)ERKStepGetNumRhsEvals(self->memory, &value);
#endif
  s->rhs_evaluations = self->before.rhs_evaluations + (double)value;
  value = 0;
  (void)TRB_ARK(GetNumErrTestFails)(self->memory, &value);
  s->error_failures = self->before.error_failures + (double)value;
  (void)TRB_ARK(GetLastStep)(self->memory, &s->last_step);
  s->last_order = TRB_EXPLICIT_ORDER;
  s->body_steps = s->steps * trb_integrator_n_bodies(it);
  s->restarts = self->before.restarts + 1;
  s->smallest_step = self->smallest;
}

static trb_status erk_restart(trb_integrator *it, trb_message *message)
{
  erk           *self = it->self;
  trb_statistics so_far;
  read_totals(it, &so_far);
  self->before = so_far;
  CHECK(ERKStepReInit(self->memory, rates, it->time, self->y));
  return TRB_OK;
}

static trb_status erk_step(trb_integrator *it, trb_message *message)
{
  erk        *self = it->self;
  sunrealtype reached = it->time, step = 0.0;
  if (trb_integrator_is_driven(it)) CHECK(TRB_ARK(SetStopTime)(self->memory, trb_integrator_stop(it)));
  CHECK(TRB_ARK(SetMaxStep)(self->memory, trb_integrator_longest_step(it)));
  const int flag = TRB_ARK(Evolve)(self->memory, it->time + 1.0, self->y, &reached, ARK_ONE_STEP);
  if (flag < 0) return trb_fail(message, TRB_ERR_STEP, "ARKODE stopped (%d): %s", flag, self->sundials.text);
  CHECK(TRB_ARK(GetLastStep)(self->memory, &step));
  self->smallest = fmin(self->smallest, step);
  it->time = reached;
  if (step < it->settings.smallest_step) return trb_fail(message, TRB_ERR_STEP, "the step fell to %g s", step);
  return TRB_OK;
}

static trb_status erk_interpolate(trb_integrator *it, double time, double *y, trb_message *message)
{
  erk     *self = it->self;
  N_Vector out = trb_sundials_vector(&self->sundials, it->n, y);
  if (out == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for an output");
  const int flag = TRB_ARK(GetDky)(self->memory, time, 0, out);
  N_VDestroy(out);
  return flag == ARK_SUCCESS ? TRB_OK : trb_fail(message, TRB_ERR_SOLVER, "ARKODE: no dense output: %s", self->sundials.text);
}

static int erk_worst(trb_integrator *it)
{
  erk *self = it->self;
  if (TRB_ARK(GetEstLocalErrors)(self->memory, self->scratch) != ARK_SUCCESS) return -1;
  return trb_integrator_worst(it, N_VGetArrayPointer(self->scratch));
}

const trb_integrator_kind trb_integrator_erk = {
    "erk", "explicit Runge-Kutta of ARKODE", NULL, erk_create, erk_free, erk_restart, erk_step, erk_interpolate, read_totals, erk_worst};
