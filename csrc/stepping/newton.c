/* Newton's method with a test of the equations themselves (docs/theory/numerics.md#newtons-method).
 *
 * An implicit step solves y = a + gamma f(y). The usual test looks at the size of the last correction -M^-1 F, with F = y - a - gamma f(y)
 * and M = 1 - gamma J. In a rolling contact M holds slopes of friction of 1e5 to 1e9 1/s: where the true slope is smaller than the one
 * in M (a roller that slips, oil that yields), corrections are far below every tolerance although the equations are not fulfilled at
 * all. Such a step is not a step of the method; the error test does not see it, and the forces of the next steps make energy.
 *
 * Here a step is accepted only if F itself, before the last correction, is below the tolerance of Newton's method. F is what the step
 * lacks in velocity because forces and accelerations do not balance. For forces that do not increase with speed, |error of y| <= |F|
 * holds however stiff they are (Dahlquist 1979; Hairer and Wanner, Solving ODEs II, IV.12), so nothing else has to be known about J.
 * Where friction falls with slip (boundary friction beyond 1 %) the bound is weaker by the step times that slope.
 *
 * F must also have fallen by a correction, or be negligible. Else a slope that is too large leaves nearly all of it in every step: steps
 * of nanoseconds then carry the same error on for ever, each of them within the tolerance.
 *
 * Corrections are improved by Broyden's update of M^-1 from those that went before in the same step (Kelley, Solving Nonlinear Equations
 * with Newton's Method, 2003, section 4.2): a slope that is too large or too small along the way is found after one evaluation more, and
 * two points between which the plain method would jump for ever are left.
 *
 * Where that is not enough time and again, in steps with a fresh Jacobian, the solution is searched between two of the points
 * (stepping/bracket.c). Else the step would be shortened until the equations hardly matter, and stay so. */
#include "stepping/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stepping/bracket.h"
#include "stepping/weighted.h"

/* Largest share of the last correction that the next one may repeat before it is prolonged no further: by 1/(1 - most_kept) at most. */
static const double most_kept = 0.95;
/* What the equations lack is accepted below the first share of the tolerance; else it must also have fallen to the second share by a
 * correction. */
static const double negligible = 0.1, contraction = 0.3;
/* A correction that grows beyond this multiple of the first one diverges. */
static const double divergence = 1e3;
/* Weight of the present solve in the share of solves that fail, and the share above which a solution is searched between two points. */
static const double present = 0.2, often = 0.3;
/* Evaluations of that search at most. */
enum { most_between = 12 };

typedef struct newton {
  SUNNonlinSolSysFn    residual;
  SUNNonlinSolLSetupFn setup;
  SUNNonlinSolLSolveFn solve;
  N_Vector             delta;                   /* residual, then correction */
  double              *taken;                   /* corrections taken in this step, one after the other */
  double               square[TRB_NEWTON_MOST]; /* of their weighted norms */
  int                  n, most;                 /* entries; iterations allowed */
  int                  iterations, failures;    /* of the last solve */
  int                  troubled;                /* whether the last solve failed */
  double               failing;                 /* share of solves that failed, the last ones counting most */
  trb_bracket          bracket;
} newton;

static SUNNonlinearSolver_Type type_of(SUNNonlinearSolver solver)
{
  (void)solver;
  return SUNNONLINEARSOLVER_ROOTFIND;
}

static int initialize(SUNNonlinearSolver solver)
{
  (void)solver;
  return 0;
}

/* Turns the plain correction into that of Broyden's method and stores it; m: number of corrections that were taken before. Broyden's
 * update of M^-1 is a matrix of rank one for each correction s_j, so it is applied without any matrix: with k_j = (s_j . delta)/(s_j .
 * s_j), delta is replaced by delta + k_j s_(j+1) for each earlier correction, and by delta/(1 - k_j) for the last one. The products are
 * those of the weighted entries. */
static void improve(newton *self, int m, const double *weight, double *delta)
{
  const int n = self->n;
  for (int j = 0; j < m; j++) {
    const double *s = self->taken + (size_t)j * (size_t)n, kept = trb_weighted_product(n, s, delta, weight) / self->square[j];
    if (j + 1 < m) {
      const double *next = s + n;
      for (int i = 0; i < n; i++) delta[i] += kept * next[i];
    } else {
      const double scale = 1.0 / (1.0 - fmin(kept, most_kept));
      for (int i = 0; i < n; i++) delta[i] *= scale;
    }
  }
  memcpy(self->taken + (size_t)m * (size_t)n, delta, (size_t)n * sizeof *delta);
  self->square[m] = trb_weighted_product(n, delta, delta, weight);
}

/* Whether the equations hold well enough: what they lack, and what they lacked before the last correction. */
static int holds(double off, double before, double tolerance)
{
  return off <= negligible * tolerance || (off <= tolerance && off <= contraction * before);
}

/* Searches between the two best points. What is found is taken as it is: a further correction would go too far again. */
static int search(newton *self, N_Vector correction, N_Vector weights, double tolerance, void *memory)
{
  const double *const weight = N_VGetArrayPointer(weights), *const lack = N_VGetArrayPointer(self->delta);
  if (!trb_bracket_begin(&self->bracket, weight)) return SUN_NLS_CONV_RECVR;
  const double before = sqrt(self->bracket.best.square / self->n);
  for (int m = 0; m < most_between; m++) {
    trb_bracket_next(&self->bracket, N_VGetArrayPointer(correction));
    const int flag = self->residual(correction, self->delta, memory);
    if (flag != 0) return flag;
    self->iterations++;
    if (holds(sqrt(trb_weighted_product(self->n, lack, lack, weight) / self->n), before, tolerance)) return 0;
    trb_bracket_found(&self->bracket, lack, weight);
  }
  return SUN_NLS_CONV_RECVR;
}

/* searching: whether to search between two points in the end. The first point is none of them: there all equations lack something. */
static int iterate(newton *self, N_Vector correction, N_Vector weights, double tolerance, int searching, void *memory)
{
  double first = INFINITY, before = 0.0;
  trb_bracket_clear(&self->bracket);
  for (int m = 0; m < self->most; m++) {
    if (m > 0) {
      const int flag = self->residual(correction, self->delta, memory);
      if (flag != 0) return flag;
    }
    double *const       delta = N_VGetArrayPointer(self->delta);
    const double *const weight = N_VGetArrayPointer(weights);
    /* what the equations lack, in the mean over all entries */
    const double off = sqrt(trb_weighted_product(self->n, delta, delta, weight) / self->n);
    if (searching && m > 0) trb_bracket_add(&self->bracket, N_VGetArrayPointer(correction), delta, weight);
    for (int i = 0; i < self->n; i++) delta[i] = -delta[i];
    const int flag = self->solve(self->delta, memory);
    if (flag != 0) return flag;
    self->iterations++;
    improve(self, m, weight, delta);
    const double change = sqrt(self->square[m] / self->n);
    N_VLinearSum(1.0, correction, 1.0, self->delta, correction);
    if (change <= tolerance && holds(off, before, tolerance)) return 0;
    before = off;
    if (m == 0) first = change;
    if (!(change <= divergence * first) || !(self->square[m] > 0.0)) break;
  }
  return searching ? search(self, correction, weights, tolerance, memory) : SUN_NLS_CONV_RECVR;
}

static int solve(SUNNonlinearSolver solver, N_Vector start, N_Vector correction, N_Vector weights, sunrealtype tolerance, int setup,
                 void *memory)
{
  newton *self = solver->content;
  int     bad = 0, current = 0;
  (void)start;
  self->iterations = self->failures = 0;
  for (;;) {
    int flag = self->residual(correction, self->delta, memory);
    if (flag != 0) return flag;
    if (setup || bad) {
      flag = self->setup(bad, &current, memory);
      if (flag != 0) return flag;
    }
    flag = iterate(self, correction, weights, tolerance, current && self->failing > often, memory);
    if (flag >= 0) self->failing += present * ((flag > 0) - self->failing);
    if (flag == 0) self->troubled = 0;
    if (flag <= 0) return flag;
    self->failures++;
    self->troubled = 1;
    if (current) return flag;
    bad = 1;
    N_VConst(0.0, correction);
  }
}

static int free_solver(SUNNonlinearSolver solver)
{
  if (solver == NULL) return 0;
  newton *self = solver->content;
  if (self != NULL) {
    if (self->delta != NULL) N_VDestroy(self->delta);
    free(self->taken);
    trb_bracket_free(&self->bracket);
    free(self);
  }
  solver->content = NULL;
  SUNNonlinSolFreeEmpty(solver);
  return 0;
}

static int set_residual(SUNNonlinearSolver solver, SUNNonlinSolSysFn function)
{
  ((newton *)solver->content)->residual = function;
  return 0;
}

static int set_setup(SUNNonlinearSolver solver, SUNNonlinSolLSetupFn function)
{
  ((newton *)solver->content)->setup = function;
  return 0;
}

static int set_solve(SUNNonlinearSolver solver, SUNNonlinSolLSolveFn function)
{
  ((newton *)solver->content)->solve = function;
  return 0;
}

static int set_test(SUNNonlinearSolver solver, SUNNonlinSolConvTestFn function, void *data)
{
  (void)solver;
  (void)function;
  (void)data;
  return 0;
}

static int set_iterations(SUNNonlinearSolver solver, int n)
{
  (void)solver;
  (void)n;
  return 0;
}

static int get_iterations(SUNNonlinearSolver solver, long *n)
{
  *n = ((newton *)solver->content)->iterations;
  return 0;
}

static int get_failures(SUNNonlinearSolver solver, long *n)
{
  *n = ((newton *)solver->content)->failures;
  return 0;
}

int trb_newton_troubled(SUNNonlinearSolver solver) { return ((newton *)solver->content)->troubled; }

void trb_newton_forget(SUNNonlinearSolver solver)
{
  newton *self = solver->content;
  self->troubled = 0;
  self->failing = 0.0;
}

SUNNonlinearSolver trb_newton_solver(int max_iterations, N_Vector like, SUNContext context)
{
  SUNNonlinearSolver solver = SUNNonlinSolNewEmpty(context);
  if (solver == NULL) return NULL;
  newton *self = calloc(1, sizeof *self);
  solver->content = self;
  if (self != NULL) {
    self->n = (int)N_VGetLength(like);
    self->most = max_iterations < TRB_NEWTON_MOST ? max_iterations : TRB_NEWTON_MOST;
    self->delta = N_VClone(like);
    self->taken = calloc((size_t)self->n * (size_t)self->most, sizeof(double));
  }
  if (self == NULL || self->delta == NULL || self->taken == NULL || trb_bracket_create(&self->bracket, self->n) != 0) {
    (void)free_solver(solver);
    return NULL;
  }
  solver->ops->gettype = type_of;
  solver->ops->initialize = initialize;
  solver->ops->solve = solve;
  solver->ops->free = free_solver;
  solver->ops->setsysfn = set_residual;
  solver->ops->setlsetupfn = set_setup;
  solver->ops->setlsolvefn = set_solve;
  solver->ops->setctestfn = set_test;
  solver->ops->setmaxiters = set_iterations;
  solver->ops->getnumiters = get_iterations;
  solver->ops->getnumconvfails = get_failures;
  return solver;
}
