/* Newton's method of a step: what it accepts fulfils the equations, also where the slopes it was given are wrong. */
#include "stepping/newton.h"

#include "check.h"
#include "stepping/sundials_context.h"

enum { N = 3 };

/* y = a + gamma f(y), entry by entry, and slopes taken at `guess`: friction that saturates, or that of an oil that yields. */
typedef struct problem {
  double a[N], gamma, strength, width, guess[N], jump;
  int    oil, n_main; /* friction of an oil; entries before the integral of the first one, N if there is none */
  double refused;     /* value of the first entry above which there is no evaluation; 0: none */
  double at[N];       /* of the last evaluation */
  int    evaluations, setups;

  SUNNonlinearSolver newton;  /* or NULL */
  int                poor[N]; /* bodies that it found so at the last setup */
} problem;

static double friction(const problem *p, double y)
{
  if (p->oil) return -p->strength * asinh(y / p->width);
  return -p->strength * tanh(y / p->width) - (y > p->jump ? p->strength : 0.0);
}

static double slope(const problem *p, double y)
{
  const double c = p->oil ? hypot(1.0, y / p->width) : cosh(y / p->width) * cosh(y / p->width);
  return p->strength / (p->width * c);
}

static int residual(N_Vector y, N_Vector out, void *memory)
{
  problem *p = memory;
  double  *to = N_VGetArrayPointer(out), *from = N_VGetArrayPointer(y);
  p->evaluations++;
  if (p->refused > 0.0 && from[0] > p->refused) return 1;
  memcpy(p->at, from, sizeof p->at);
  for (int i = 0; i < N; i++) to[i] = from[i] - p->a[i] - p->gamma * friction(p, from[i]);
  if (p->n_main < N) to[N - 1] = from[N - 1] - p->a[N - 1] - p->gamma * from[0] * from[0];
  return 0;
}

static int setup(int bad, int *current, void *memory)
{
  problem *p = memory;
  (void)bad;
  for (int i = 0; i < N && p->newton != NULL; i++) p->poor[i] = trb_newton_is_poor(p->newton, i);
  if (p->setups++ > 0) memcpy(p->guess, p->at, sizeof p->guess);
  *current = 1;
  return 0;
}

static int solve(N_Vector b, void *memory)
{
  const problem *p = memory;
  double        *x = N_VGetArrayPointer(b);
  for (int i = 0; i < N; i++) x[i] /= 1.0 + (i < p->n_main ? p->gamma * slope(p, p->guess[i]) : 0.0);
  return 0;
}

/* Where first corrections leave much of what equations lack, slopes are taken again, of the bodies whose equations these are. */
static void test_poor_slopes(trb_sundials *s)
{
  double             y[N], zero[N] = {0};
  problem            p = {.a = {1e-5, 2e-5, -1e-5}, .gamma = 1.0, .n_main = N, .strength = 2e-4, .width = 1e-4, .oil = 1};
  N_Vector           found = trb_sundials_vector(s, N, y), start = trb_sundials_vector(s, N, zero), weights = N_VClone(found);
  SUNNonlinearSolver newton = trb_newton_solver(found, N, N - 1, 1, s->context);
  int                last = 0;
  N_VConst(1.0, weights);
  CHECK(SUNNonlinSolSetSysFn(newton, residual) == 0 && SUNNonlinSolSetLSetupFn(newton, setup) == 0 &&
        SUNNonlinSolSetLSolveFn(newton, solve) == 0);
  for (int i = 0; i < 60; i++) {
    N_VConst(0.0, found);
    CHECK(SUNNonlinSolSolve(newton, start, found, weights, 1e-6, i == 0, &p) == 0);
    CHECK_NEAR(y[1] - p.a[1] - friction(&p, y[1]), 0.0, 1e-6);
  }
  CHECK(p.setups == 1);

  /* slopes that are far too small from now on: right all the same, and soon taken again */
  for (int i = 0; i < N; i++) p.guess[i] = 1e-2;
  for (int i = 0; i < 40; i++) {
    N_VConst(0.0, found);
    p.evaluations = 0;
    CHECK(SUNNonlinSolSolve(newton, start, found, weights, 1e-6, 0, &p) == 0);
    CHECK_NEAR(y[1] - p.a[1] - friction(&p, y[1]), 0.0, 1e-6);
    last = p.evaluations;
  }
  CHECK(p.setups == 2 && last <= 3);

  /* of one body alone */
  p.newton = newton, p.guess[1] = 1e-2;
  for (int i = 0; i < 40; i++) {
    N_VConst(0.0, found);
    CHECK(SUNNonlinSolSolve(newton, start, found, weights, 1e-6, 0, &p) == 0);
  }
  CHECK(p.setups == 3 && !p.poor[0] && p.poor[1] && !p.poor[2]);
  (void)SUNNonlinSolFree(newton);
  N_VDestroy(found);
  N_VDestroy(start);
  N_VDestroy(weights);
}

/* Solves from zero a number of times; gives the largest residual of what was accepted in the last solve, or -1. Each entry is a body, but the
 * integral. */
static double run_again(problem *p, trb_sundials *s, double *found, int times)
{
  double             zero[N] = {0}, off[N];
  N_Vector           y = trb_sundials_vector(s, N, found), start = trb_sundials_vector(s, N, zero), weights = N_VClone(y),
                     out = trb_sundials_vector(s, N, off);
  SUNNonlinearSolver newton = trb_newton_solver(y, p->n_main, p->n_main - 1, 1, s->context);
  double             largest = -1.0;
  N_VConst(1.0, weights);
  if (p->n_main < N) N_VGetArrayPointer(weights)[N - 1] = 1e-30;
  CHECK(SUNNonlinSolSetSysFn(newton, residual) == 0 && SUNNonlinSolSetLSetupFn(newton, setup) == 0 &&
        SUNNonlinSolSetLSolveFn(newton, solve) == 0);
  int flag = 0;
  for (int i = 0; i < times; i++) {
    N_VConst(0.0, y);
    p->evaluations = p->setups = 0;
    flag = SUNNonlinSolSolve(newton, start, y, weights, 1e-6, 1, p);
    CHECK(trb_newton_troubled(newton) || flag == 0);
    CHECK(!trb_newton_troubled(newton) || flag != 0 || i > 3);
    CHECK(!trb_newton_renewing(newton));
  }
  if (flag == 0) {
    residual(y, out, p);
    largest = N_VMaxNorm(out);
  }
  trb_newton_forget(newton);
  CHECK(!trb_newton_troubled(newton));
  (void)SUNNonlinSolFree(newton);
  N_VDestroy(y);
  N_VDestroy(start);
  N_VDestroy(weights);
  N_VDestroy(out);
  return largest;
}

static double run(problem *p, trb_sundials *s, double *found) { return run_again(p, s, found, 1); }

/* An oil between three bodies that yields at a ten-thousandth of the way, with slopes taken far beside the solution: Newton's method jumps to
 * and fro. It says so at first; where that happens again and again, slopes are taken at the best points. */
static void test_renewal(trb_sundials *s)
{
  double  y[N];
  problem yielding = {.a = {0.5, -0.3, 0.7}, .gamma = 1.0, .n_main = N, .strength = 0.1, .width = 1e-4, .guess = {0.1, 0.1, 0.1}, .oil = 1};
  CHECK(run(&yielding, s, y) < 0.0);
  CHECK(yielding.setups == 1);
  const double off = run_again(&yielding, s, y, 16);
  CHECK(off >= 0.0 && off <= 1e-6);
  for (int i = 0; i < N; i++) CHECK_NEAR(y[i] + 0.1 * asinh(y[i] / 1e-4), yielding.a[i], 1e-6);

  /* a place between two branches is no solution, however often it is tried */
  problem none = {.a = {0.5, 0.5, 0.5}, .gamma = 1.0, .n_main = N, .strength = 0.3, .width = 1e3, .jump = 0.4};
  CHECK(run_again(&none, s, y, 13) < 0.0);
  CHECK(none.setups == 1 + 8);
  /* what was in vain is not done again at once */
  CHECK(run_again(&none, s, y, 14) < 0.0);
  CHECK(none.setups == 1);

  /* where the first correction leads to a place that cannot be evaluated there is no better point to take slopes at */
  none.refused = 0.1;
  CHECK(run_again(&none, s, y, 13) < 0.0);
  CHECK(none.setups == 1 + 1);
}

/* An integral beside the bodies, with a weight that leaves it out of all tests: bodies that are taken one by one solve its equation to what
 * their last correction changes, as it has no part in the update of a body that goes to and fro. */
static void test_integral(trb_sundials *s)
{
  int solved = 0;
  for (int i = 0; i < 40; i++) {
    double  y[N];
    problem yielding = {
        .a = {0.5, 0.02 * (i - 20), 0.25}, .gamma = 1.0, .n_main = N - 1, .strength = 0.1, .width = 1e-4, .guess = {0.1, 0.1}, .oil = 1};
    if (run_again(&yielding, s, y, 16) < 0.0) continue;
    solved++;
    CHECK_NEAR(y[0] + 0.1 * asinh(y[0] / 1e-4), yielding.a[0], 1e-6);
    CHECK_NEAR(y[2], 0.25 + y[0] * y[0], 1e-10);
  }
  CHECK(solved >= 20);
}

int main(void)
{
  trb_sundials s;
  double       y[N];
  if (!CHECK(trb_sundials_open(&s, NULL) == TRB_OK)) return check_report();

  /* linear: two evaluations, one to solve and one to see that it is solved */
  problem      linear = {.a = {1e-4, 2e-4, -1e-4}, .gamma = 1.0, .n_main = N, .strength = 10.0, .width = 1e3, .jump = INFINITY};
  const double off = run(&linear, &s, y);
  CHECK(off >= 0.0 && off < 1e-9);
  CHECK(linear.evaluations <= 3);

  /* friction that has yielded, slopes of friction that has not: corrections are a thousandth of the tolerance from the first on, and the
   * solution is 1e3 tolerances away */
  problem      yielded = {.a = {1.0, 0.9, 0.8}, .gamma = 1.0, .n_main = N, .strength = 0.5, .width = 1e-10, .jump = INFINITY};
  const double found = run(&yielded, &s, y);
  CHECK(found < 0.0 || found < 1e-5);

  /* moderately wrong slopes: found, not given up */
  problem      wrong = {.a = {1e-2, 2e-2, 3e-2}, .gamma = 1.0, .n_main = N, .strength = 2e-2, .width = 2e-2, .jump = INFINITY};
  const double near = run(&wrong, &s, y);
  CHECK(near >= 0.0 && near < 1e-5);
  for (int i = 0; i < N; i++) CHECK_NEAR(y[i], wrong.a[i] + friction(&wrong, y[i]), 1e-5);

  /* between two branches there is nothing: it says so */
  problem none = {.a = {0.5, 0.5, 0.5}, .gamma = 1.0, .n_main = N, .strength = 0.3, .width = 1e3, .jump = 0.4};
  CHECK(run(&none, &s, y) < 0.0);
  test_renewal(&s);
  test_poor_slopes(&s);
  test_integral(&s);
  trb_sundials_close(&s);
  return check_report();
}
