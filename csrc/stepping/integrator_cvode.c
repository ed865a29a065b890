/* Backward differentiation formulas of CVODE, with the structured Jacobian. Above order 2 the formulas are unstable near the imaginary
 * axis, where the lightly damped vibrations of contacts lie (35 kHz); the integrator would have to resolve them with small steps. So the
 * highest order is 2 unless a user asks for more (docs/theory/numerics.md#why-bdf-of-order-2). */
#include <math.h>
#include <stdlib.h>

#include "stepping/arrow_solver.h"
#include "stepping/constants.h"
#include "stepping/integrator.h"
#include "stepping/jacobian.h"
#include "stepping/newton.h"
#include "stepping/sundials_context.h"
#include "stepping/vectors.h"

typedef struct bdf {
  trb_sundials       sundials;
  void              *memory;
  N_Vector           y;       /* over it->y */
  N_Vector           scratch; /* of its own */
  SUNMatrix          matrix;
  SUNLinearSolver    solver;
  SUNNonlinearSolver newton;
  trb_jacobian      *jacobians[TRB_MOST_MEMBERS];
  trb_statistics     before;    /* totals up to the last restart */
  double             smallest;  /* smallest step, s */
  double            *swings;    /* bearings together: of each roller, see trb_body_entries */
  double             filled_at; /* end of the last step when the Jacobian was last evaluated, s */
} bdf;

static int rates(sunrealtype time, N_Vector y, N_Vector out, void *data)
{
  trb_integrator *it = data;
  bdf            *self = it->self;
  double         *to = N_VGetArrayPointer(out);
  if (!(it->settings.rings_share > 0.0) || trb_newton_troubled(self->newton))
    return trb_integrator_rates(it, time, N_VGetArrayPointer(y), to);
  for (int k = 0; k < it->assembly->n; k++) {
    const int                 first = trb_state_roller(&it->assembly->members[k], 0);
    const trb_arrow_factors  *factors = self->solver->content;
    const trb_tangent_measure measure = {.relative = it->relative + first,
                                         .scale = it->scale + first,
                                         .kernels = factors->kernels,
                                         .gamma = factors->gamma,
                                         .share = it->settings.rings_share,
                                         .margin_share = trb_margin_share,
                                         .slip_share = trb_slip_share};
    trb_tangents_derivative(self->jacobians[k]->tangents, it->members[k].dynamics, &measure, time, N_VGetArrayPointer(y), to);
  }
  return trb_integrator_finite(it, to) ? 0 : 1;
}

static int weights(N_Vector y, N_Vector out, void *data)
{
  trb_integrator_weights(data, N_VGetArrayPointer(y), N_VGetArrayPointer(out));
  return 0;
}

static void fill(const trb_integrator *it, double time, const double *y, trb_arrow *arrow)
{
  bdf *self = it->self;
  /* the part of the rings is computed again when it is old, when Newton's method failed twice with it within this step, and
   * always while speed or ring change or have just done so: an old slope that is too stiff makes corrections so small that they seem to
   * converge; that of single rollers where it was poor or corrected often */
  const double made = self->jacobians[0]->tangents->time;
  const int    again = (it->time == self->filled_at && made < it->time) || trb_newton_renewing(self->newton);
  const int    old = fabs(time - made) > it->settings.rings_age;
  int          changing = 0;
  for (int k = 0; k < it->assembly->n; k++) changing |= trb_motion_changes(it->members[k].motion, time - it->settings.rings_age, time);
  const int fresh = again || old || changing;
  self->filled_at = it->time;
  for (int k = 0; k < it->assembly->n; k++) {
    const trb_system *system = &it->assembly->members[k];
    for (int j = 0; j < system->model->n_rollers; j++)
      if (trb_newton_is_poor(self->newton, system->layout.leaf + j) || trb_tangents_are_worn(self->jacobians[k]->tangents, j))
        trb_jacobian_renew(self->jacobians[k], j);
    trb_jacobian_fill(self->jacobians[k], time, y, fresh, arrow);
  }
}

/* The matrix holds the Jacobian J; the solver forms I - gamma J when it reads it. usable: the Jacobian need not be computed again. Its
 * type is int, as its name in SUNDIALS differs between versions. */
static int linear_system(sunrealtype time, N_Vector y, N_Vector fy, SUNMatrix matrix, int usable, int *filled, sunrealtype gamma,
                         void *data, N_Vector a, N_Vector b, N_Vector c)
{
  trb_arrow *arrow = trb_arrow_of(matrix);
  (void)fy;
  (void)a;
  (void)b;
  (void)c;
  if (!usable) fill(data, time, N_VGetArrayPointer(y), arrow);
  *filled = !usable;
  arrow->gamma = gamma;
  return 0;
}

static trb_status failed(bdf *self, const char *what, trb_message *message)
{
  return trb_fail(message, TRB_ERR_SOLVER, "CVODE: %s failed: %s", what, self->sundials.text);
}

#define CHECK(call) \
  do { \
    if ((call) != CV_SUCCESS) return failed(self, #call, message); \
  } while (0)

static trb_status configure(trb_integrator *it, trb_message *message)
{
  bdf *self = it->self;
  if (!trb_sundials_has_room_for(it->n)) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  CHECK(CVodeInit(self->memory, rates, it->time, self->y));
  CHECK(CVodeSetUserData(self->memory, it));
  CHECK(CVodeWFtolerances(self->memory, weights));
  CHECK(CVodeSetNonlinearSolver(self->memory, self->newton));
  CHECK(CVodeSetLinearSolver(self->memory, self->solver, self->matrix));
  CHECK(CVodeSetLinSysFn(self->memory, linear_system));
  CHECK(CVodeSetMaxOrd(self->memory, (int)it->settings.max_order));
  CHECK(CVodeSetMaxStep(self->memory, it->settings.max_step));
  CHECK(CVodeSetMaxErrTestFails(self->memory, TRB_MOST_ERROR_FAILURES));
  CHECK(CVodeSetMaxConvFails(self->memory, TRB_MOST_SOLVE_FAILURES));
  CHECK(CVodeSetLSetupFrequency(self->memory, TRB_SETUP_EVERY));
  CHECK(CVodeSetNonlinConvCoef(self->memory, it->settings.newton_share));
  CHECK(CVodeSetJacEvalFrequency(self->memory, TRB_JACOBIAN_EVERY));
  if (it->settings.first_step > 0.0) CHECK(CVodeSetInitStep(self->memory, it->settings.first_step));
  return TRB_OK;
}

static trb_status bdf_create(trb_integrator *it, trb_message *message)
{
  const trb_layout *layout = &it->assembly->members[0].layout;
  const int         n_rollers = layout->n_rollers, hub_width = layout->hub_width, variant = it->members[0].dynamics->work->variant;
  bdf              *self = calloc(1, sizeof *self);
  if (self == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  it->self = self;
  self->smallest = INFINITY;
  self->filled_at = -INFINITY;
  trb_status status = trb_sundials_open(&self->sundials, message);
  if (status != TRB_OK) return status;
  trb_body_entries entries = trb_body_entries_of(it->assembly);
  if (it->assembly->n > 1) {
    self->swings = trb_zeros((size_t)n_rollers, sizeof *self->swings);
    if (self->swings == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
    for (int j = 0; j < n_rollers; j++) self->swings[j] = 1.0;
    entries.swings = self->swings;
  }
  self->y = trb_vector_over(it->y, it->n, &entries, variant, self->sundials.context);
  if (self->y != NULL) self->scratch = N_VClone(self->y);
  self->matrix = trb_arrow_matrix(n_rollers, hub_width, self->sundials.context);
  self->solver = trb_arrow_linear_solver(it->assembly, variant, self->sundials.context);
  if (self->y != NULL) self->newton = trb_newton_solver(self->y, it->n_main, n_rollers, TRB_ROLLER_SIZE, self->sundials.context);
  self->memory = CVodeCreate(CV_BDF, self->sundials.context);
  if (!self->y || !self->scratch || !self->matrix || !self->solver || !self->newton || !self->memory)
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  trb_sundials_quiet_cvode(&self->sundials, self->memory);
  for (int k = 0; k < it->assembly->n && status == TRB_OK; k++)
    status = trb_jacobian_create(&it->assembly->members[k], it->members[k].motion, it->variant, &self->jacobians[k], message);
  return status == TRB_OK ? configure(it, message) : status;
}

static void bdf_free(trb_integrator *it)
{
  bdf *self = it->self;
  if (self == NULL) return;
  if (self->memory != NULL) CVodeFree(&self->memory);
  if (self->newton != NULL) (void)SUNNonlinSolFree(self->newton);
  if (self->solver != NULL) (void)SUNLinSolFree(self->solver);
  if (self->matrix != NULL) SUNMatDestroy(self->matrix);
  if (self->scratch != NULL) N_VDestroy(self->scratch);
  if (self->y != NULL) N_VDestroy(self->y);
  trb_sundials_close(&self->sundials);
  free(self->swings);
  for (int k = 0; k < TRB_MOST_MEMBERS; k++) trb_jacobian_free(self->jacobians[k]);
  free(self);
  it->self = NULL;
}

static void read_totals(const trb_integrator *it, trb_statistics *s)
{
  const bdf *self = it->self;
  long       value = 0;
  int        order = 0;
  /* these getters fail only without memory, which create has checked */
#define READ(getter, name) \
  value = 0; \
  (void)getter(self->memory, &value); \
  s->name = self->before.name + (double)value
  READ(CVodeGetNumSteps, steps);
  READ(CVodeGetNumRhsEvals, rhs_evaluations);
  READ(CVodeGetNumJacEvals, jacobian_evaluations);
  READ(CVodeGetNumLinSolvSetups, linear_setups);
  READ(CVodeGetNumNonlinSolvIters, nonlinear_iterations);
  READ(CVodeGetNumStepSolveFails, nonlinear_failures);
  READ(CVodeGetNumErrTestFails, error_failures);
#undef READ
  (void)CVodeGetLastStep(self->memory, &s->last_step);
  (void)CVodeGetLastOrder(self->memory, &order);
  s->last_order = order;
  s->body_steps = s->steps * trb_integrator_n_bodies(it);
  s->restarts = self->before.restarts + 1;
  s->smallest_step = self->smallest;
}

static trb_status bdf_restart(trb_integrator *it, trb_message *message)
{
  bdf           *self = it->self;
  trb_statistics so_far;
  read_totals(it, &so_far);
  self->before = so_far;
  /* what was learned is forgotten, so that what follows depends on time and state alone */
  self->filled_at = -INFINITY;
  for (int k = 0; k < it->assembly->n; k++) trb_tangents_forget(self->jacobians[k]->tangents);
  trb_newton_forget(self->newton);
  ((trb_arrow_factors *)self->solver->content)->gamma = 0.0;
  CHECK(CVodeReInit(self->memory, it->time, self->y));
  return TRB_OK;
}

/* Rollers that touch something or may do so soon swing as those of the cage's team do with steps of each body. */
static void let_swing(const trb_integrator *it, int member)
{
  const bdf        *self = it->self;
  const trb_system *system = &it->assembly->members[member];
  for (int j = 0; self->swings != NULL && j < system->model->n_rollers; j++)
    self->swings[system->layout.leaf + j] = isfinite(it->members[member].impacts.speed[j]) ? trb_swing_share : 1.0;
}

static trb_status bdf_step(trb_integrator *it, trb_message *message)
{
  bdf        *self = it->self;
  sunrealtype reached = it->time, step = 0.0;
  /* set at every step; the end is far away where the prescribed motion changes no more */
  if (trb_integrator_is_driven(it)) CHECK(CVodeSetStopTime(self->memory, trb_integrator_stop(it)));
  CHECK(CVodeSetMaxStep(self->memory, trb_integrator_longest_step(it)));
  CHECK(CVodeGetCurrentStep(self->memory, &step));
  for (int k = 0; k < it->assembly->n; k++) {
    const trb_dynamics *d = it->members[k].dynamics;
    trb_integrator_look(it, k, step, d->everyone, d->model->n_rollers);
    let_swing(it, k);
  }
  const int flag = CVode(self->memory, it->time + 1.0, self->y, &reached, CV_ONE_STEP);
  if (flag < 0) return trb_fail(message, TRB_ERR_STEP, "CVODE stopped (%d): %s", flag, self->sundials.text);
  CHECK(CVodeGetLastStep(self->memory, &step));
  self->smallest = fmin(self->smallest, step);
  it->time = reached;
  if (step < it->settings.smallest_step) return trb_fail(message, TRB_ERR_STEP, "the step fell to %g s", step);
  return TRB_OK;
}

static trb_status bdf_interpolate(trb_integrator *it, double time, double *y, trb_message *message)
{
  bdf     *self = it->self;
  N_Vector out = trb_sundials_vector(&self->sundials, it->n, y);
  if (out == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for an output");
  const int flag = CVodeGetDky(self->memory, time, 0, out);
  N_VDestroy(out);
  return flag == CV_SUCCESS ? TRB_OK : failed(self, "CVodeGetDky", message);
}

static int bdf_worst(trb_integrator *it)
{
  bdf *self = it->self;
  if (CVodeGetEstLocalErrors(self->memory, self->scratch) != CV_SUCCESS) return -1;
  return trb_integrator_worst(it, N_VGetArrayPointer(self->scratch));
}

const trb_integrator_kind trb_integrator_bdf = {"bdf",       "backward differentiation of CVODE with the structured Jacobian",
                                                NULL,        bdf_create,
                                                bdf_free,    bdf_restart,
                                                bdf_step,    bdf_interpolate,
                                                read_totals, bdf_worst};
