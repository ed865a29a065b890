/* Newton's method with a test of the equations themselves (docs/theory/numerics.md#newtons-method, which says why).
 *
 * An implicit step solves F = y - a - gamma f(y) = 0 with corrections -M^-1 F, M = 1 - gamma J. Where slopes in M are too large, corrections are
 * small although F is not: so a step is accepted only if F itself, before the last correction, is below the tolerance and has fallen by a
 * correction. What a first correction leaves says which bodies' slopes are taken again. Corrections are improved by Broyden's update from those
 * that went before in the same step. Where solves fail time and again each body has an update of its own, and keeps the point at which its
 * equations lacked least; if the iterations end without a solution, slopes are taken again there. The integrals of losses, works and spin, which
 * no force reads, keep the plain correction. */
#include "stepping/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stepping/constants.h"
#include "stepping/newton_rules.h"
#include "stepping/sundials_context.h"

typedef struct newton {
  SUNNonlinSolSysFn    residual;
  SUNNonlinSolLSetupFn setup;
  SUNNonlinSolLSolveFn solve;
  N_Vector             delta;      /* residual, then correction */
  double              *taken;      /* corrections taken in this step, one after the other */
  double              *square;     /* body by body: of their weighted norms */
  double    *best, *best_square;   /* body by body: the point at which its equations lacked least, and their weighted square there */
  int        n, n_main;            /* entries; those before the integrals that no force reads */
  int        n_bodies, size;       /* bodies but the last one, and their entries; what is left before the integrals is the last one */
  double     off;                  /* what the equations lacked before the last correction */
  int        iterations, failures; /* of the last solve */
  int        troubled;             /* whether the last solve failed */
  int        renewing;             /* slopes are taken again within a solve */
  int        has_best;             /* whether the last iterations came to a point after their first correction */
  int        pause, paused;        /* failed solves for which that is left out, and those that went by */
  double     failing;              /* share of solves that failed, the last ones counting most */
  double    *left;    /* body by body: weighted squares of what its equations lacked after the last correction that left too much */
  int        is_poor; /* whether a correction left too much */
  int       *poor;    /* body by body: whether its slopes are to be taken again for that */
  long      *renewed; /* body by body: the solve at which they last were */
  long       solves;  /* so far */
  trb_memory memory;  /* of all arrays */
} newton;

/* Entries of a body. */
typedef struct part {
  int from, n;
} part;

static SUNNonlinearSolver_Type type_of(SUNNonlinearSolver solver)
{
  (void)solver;
  return SUNNONLINEARSOLVER_ROOTFIND;
}

static part part_of(const newton *self, int body)
{
  const int from = body * self->size;
  return (part){.from = from, .n = body < self->n_bodies ? self->size : self->n_main - from};
}

/* Improves the correction, of all bodies together or one by one; gives its weighted square. */
static double improve_all(newton *self, int m, int one_by_one, const double *weight, double *delta)
{
  if (!one_by_one) {
    trb_newton_improve(m, self->n, weight, delta, self->taken, (size_t)self->n, self->square);
    return self->square[m];
  }
  double sum = 0.0;
  for (int body = 0; body <= self->n_bodies; body++) {
    double *const square = self->square + (size_t)body * TRB_NEWTON_ITERATIONS;
    const part    of = part_of(self, body);
    trb_newton_improve(m, of.n, weight + of.from, delta + of.from, self->taken + of.from, (size_t)self->n, square);
    sum += square[m];
  }
  return sum;
}

/* Keep the point of each body whose equations lack less than at those before. */
static void remember(newton *self, const double *at, const double *lack, const double *weight)
{
  self->has_best = 1;
  for (int body = 0; body <= self->n_bodies; body++) {
    const part   of = part_of(self, body);
    const double square = trb_weighted_product(of.n, lack + of.from, lack + of.from, weight + of.from);
    if (!(square < self->best_square[body])) continue;
    self->best_square[body] = square;
    memcpy(self->best + of.from, at + of.from, (size_t)of.n * sizeof *at);
  }
}

/* What the equations of each body lack. */
static void measure(newton *self, const double *lack, const double *weight)
{
  for (int body = 0; body <= self->n_bodies; body++) {
    const part of = part_of(self, body);
    self->left[body] = trb_weighted_product(of.n, lack + of.from, lack + of.from, weight + of.from);
  }
}

/* Slopes are to be taken again of the bodies with the largest parts of what a correction left, if it is so long since they last were. The
 * others together leave less than half of what is too much. */
static void choose_poor(newton *self, double too_much, int solves)
{
  const double limit = trb_poor_body_share * too_much;
  self->is_poor = 0;
  for (int body = 0; body <= self->n_bodies; body++) {
    self->poor[body] = self->left[body] * (self->n_bodies + 1) > limit * limit * self->n && self->solves - self->renewed[body] >= solves;
    self->is_poor |= self->poor[body];
  }
}

/* Slopes have been taken again of the bodies that were poor. */
static void note_renewal(newton *self)
{
  for (int body = 0; body <= self->n_bodies; body++)
    if (self->poor[body]) self->renewed[body] = self->solves;
  self->is_poor = 0;
}

/* one_by_one: the bodies, and the best points after the first correction are kept. */
static int iterate(newton *self, N_Vector correction, N_Vector weights, double tolerance, int one_by_one, void *memory)
{
  double first = INFINITY, before = 0.0;
  self->has_best = 0;
  memset(self->left, 0, (size_t)(self->n_bodies + 1) * sizeof *self->left);
  if (one_by_one) {
    for (int body = 0; body <= self->n_bodies; body++) self->best_square[body] = (double)INFINITY;
    memcpy(self->best, N_VGetArrayPointer(correction), (size_t)self->n * sizeof *self->best);
  }
  for (int m = 0; m < TRB_NEWTON_ITERATIONS; m++) {
    if (m > 0) {
      const int flag = self->residual(correction, self->delta, memory);
      if (flag != 0) return flag;
    }
    double *const       delta = N_VGetArrayPointer(self->delta);
    const double *const weight = N_VGetArrayPointer(weights);
    /* what the equations lack, in the mean over all entries */
    const double off = sqrt(trb_weighted_product(self->n, delta, delta, weight) / self->n);
    if (m > 1 || (m == 1 && off > trb_poor_share * before)) measure(self, delta, weight);
    if (m == 1 && off > trb_poor_share * before) choose_poor(self, trb_poor_share * before, TRB_SOLVES_BETWEEN_RENEWALS);
    if (one_by_one && m > 0) remember(self, N_VGetArrayPointer(correction), delta, weight);
    for (int i = 0; i < self->n; i++) delta[i] = -delta[i];
    const int flag = self->solve(self->delta, memory);
    if (flag != 0) return flag;
    self->iterations++;
    const double square = improve_all(self, m, one_by_one, weight, delta), change = sqrt(square / self->n);
    N_VLinearSum(1.0, correction, 1.0, self->delta, correction);
    if (change <= tolerance && trb_newton_holds(self->failing, off, before, tolerance)) return 0;
    self->off = before = off;
    if (m == 0) first = change;
    if (!(change <= trb_newton_divergence * first) || !(square > 0.0)) return SUN_NLS_CONV_RECVR;
  }
  return SUN_NLS_CONV_RECVR;
}

/* Takes slopes at the best points and iterates from there, until that succeeds, was done often enough, or comes to no new point. */
static int renew(newton *self, N_Vector correction, N_Vector weights, double tolerance, void *memory)
{
  int current = 0, flag = SUN_NLS_CONV_RECVR;
  self->renewing = 1;
  for (int i = 0, going = 1; i < TRB_MOST_RENEWALS && going; i++) {
    memcpy(N_VGetArrayPointer(correction), self->best, (size_t)self->n * sizeof *self->best);
    flag = self->residual(correction, self->delta, memory);
    if (flag == 0) flag = self->setup(1, &current, memory);
    going = flag == 0;
    if (going) flag = iterate(self, correction, weights, tolerance, 1, memory);
    going = going && flag > 0 && self->has_best;
  }
  self->renewing = 0;
  return flag;
}

static int solve(SUNNonlinearSolver solver, N_Vector start, N_Vector correction, N_Vector weights, sunrealtype tolerance, int setup,
                 void *memory)
{
  newton *self = solver->content;
  int     bad = 0, current = 0;
  (void)start;
  self->iterations = self->failures = 0;
  self->solves++;
  for (;;) {
    const int one_by_one = self->failing > trb_failing_often;
    int       flag = self->residual(correction, self->delta, memory);
    if (flag != 0) return flag;
    if (setup || bad || self->is_poor) {
      flag = self->setup(bad || self->is_poor, &current, memory);
      if (flag != 0) return flag;
    }
    if (self->is_poor) note_renewal(self);
    flag = iterate(self, correction, weights, tolerance, one_by_one && current, memory);
    if (flag > 0 && one_by_one && current && self->paused++ >= self->pause) {
      flag = renew(self, correction, weights, tolerance, memory);
      self->paused = 0;
      self->pause = flag == 0 ? 0 : self->pause == 0 ? 1 : 2 * self->pause < TRB_LONGEST_PAUSE ? 2 * self->pause : TRB_LONGEST_PAUSE;
    }
    if (flag >= 0) self->failing += trb_newest_solve_weight * ((flag > 0) - self->failing);
    if (flag == 0) self->troubled = 0;
    if (flag <= 0) return flag;
    self->failures++;
    self->troubled = 1;
    if (current) return flag;
    bad = 1;
    choose_poor(self, self->off, 0);
    N_VConst(0.0, correction);
  }
}

static int free_solver(SUNNonlinearSolver solver)
{
  if (solver == NULL) return 0;
  newton *self = solver->content;
  if (self != NULL) {
    if (self->delta != NULL) N_VDestroy(self->delta);
    trb_memory_free(&self->memory);
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

int trb_newton_troubled(SUNNonlinearSolver solver)
{
  const newton *self = solver->content;
  return self->troubled || self->failing > trb_failing_sometimes;
}

int trb_newton_renewing(SUNNonlinearSolver solver)
{
  const newton *self = solver->content;
  return self->renewing;
}

int trb_newton_is_poor(SUNNonlinearSolver solver, int body)
{
  const newton *self = solver->content;
  return self->is_poor && self->poor[body];
}

void trb_newton_forget(SUNNonlinearSolver solver)
{
  newton *self = solver->content;
  self->troubled = 0;
  self->failing = 0.0;
  self->pause = self->paused = 0;
  self->is_poor = 0;
  self->solves = 0;
  memset(self->renewed, 0, (size_t)(self->n_bodies + 1) * sizeof *self->renewed);
}

SUNNonlinearSolver trb_newton_solver(N_Vector like, int n_main, int n_bodies, int size, SUNContext context)
{
  SUNNonlinearSolver solver = trb_sundials_has_room(1) ? SUNNonlinSolNewEmpty(context) : NULL;
  if (solver == NULL) return NULL;
  newton *self = calloc(1, sizeof *self);
  solver->content = self;
  if (self != NULL) {
    self->n = (int)N_VGetLength(like);
    self->delta = N_VClone(like);
    self->n_main = n_main;
    self->n_bodies = n_bodies;
    self->size = size;
    const size_t n = (size_t)self->n, bodies = (size_t)n_bodies + 1;
    self->taken = trb_memory_zeros(&self->memory, n * TRB_NEWTON_ITERATIONS, sizeof(double));
    self->square = trb_memory_zeros(&self->memory, bodies * TRB_NEWTON_ITERATIONS, sizeof(double));
    self->best = trb_memory_zeros(&self->memory, n, sizeof(double));
    self->best_square = trb_memory_zeros(&self->memory, bodies, sizeof(double));
    self->left = trb_memory_zeros(&self->memory, bodies, sizeof *self->left);
    self->poor = trb_memory_zeros(&self->memory, bodies, sizeof *self->poor);
    self->renewed = trb_memory_zeros(&self->memory, bodies, sizeof *self->renewed);
  }
  if (self == NULL || self->delta == NULL || self->memory.lacks) {
    (void)free_solver(solver);
    return NULL;
  }
  solver->ops->gettype = type_of;
  solver->ops->solve = solve;
  solver->ops->free = free_solver;
  solver->ops->setsysfn = set_residual;
  solver->ops->setlsetupfn = set_setup;
  solver->ops->setlsolvefn = set_solve;
  solver->ops->getnumiters = get_iterations;
  solver->ops->getnumconvfails = get_failures;
  return solver;
}
