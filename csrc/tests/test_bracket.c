/* The search between two points: it keeps the best point of each side, encloses the solution and comes nearer to it. */
#include "stepping/bracket.h"

#include "check.h"

enum { N = 3 };

static const double weight[N] = {1.0, 10.0, 0.1};

/* What is lacking along x[1]: a step with a steep middle, which is zero at 0.3. */
static void lack_at(const double *x, double *out)
{
  for (int i = 0; i < N; i++) out[i] = 0.0;
  out[1] = tanh(1e3 * (x[1] - 0.3)) + 0.1 * (x[1] - 0.3);
}

static void add(trb_bracket *bracket, double place)
{
  const double x[N] = {1.0, place, -2.0};
  double       out[N];
  lack_at(x, out);
  trb_bracket_add(bracket, x, out, weight);
}

static void test_points(trb_bracket *bracket)
{
  trb_bracket_clear(bracket);
  CHECK(!trb_bracket_begin(bracket, weight));
  add(bracket, 0.9);
  add(bracket, 0.6);
  add(bracket, 0.7); /* further than the one before: not kept */
  CHECK(!trb_bracket_begin(bracket, weight));
  CHECK_NEAR(bracket->best.at[1], 0.6, 0.0);
  add(bracket, -0.4);
  CHECK(trb_bracket_begin(bracket, weight));
  CHECK_NEAR(bracket->other.at[1], -0.4, 0.0);
  add(bracket, 0.1); /* better than all: the sides change their roles */
  CHECK(trb_bracket_begin(bracket, weight));
  CHECK_NEAR(bracket->best.at[1], 0.1, 0.0);
  CHECK_NEAR(bracket->other.at[1], 0.6, 0.0);
  const double nowhere[N] = {0.0, INFINITY, 0.0};
  trb_bracket_add(bracket, nowhere, nowhere, weight);
  CHECK_NEAR(bracket->best.at[1], 0.1, 0.0);
  trb_bracket_clear(bracket);
  CHECK(!trb_bracket_begin(bracket, weight));
}

static void test_search(trb_bracket *bracket)
{
  double x[N], out[N], low = -0.4, high = 0.9;
  trb_bracket_clear(bracket);
  add(bracket, low);
  add(bracket, high);
  CHECK(trb_bracket_begin(bracket, weight));
  for (int i = 0; i < 30; i++) {
    trb_bracket_next(bracket, x);
    CHECK(low <= x[1] && x[1] <= high); /* never outside of what is known to enclose it */
    CHECK_NEAR(x[0], 1.0, 0.0);
    CHECK_NEAR(x[2], -2.0, 1e-15);
    lack_at(x, out);
    *(out[1] < 0.0 ? &low : &high) = x[1];
    if (fabs(out[1]) < 1e-12) break;
    trb_bracket_found(bracket, out, weight);
  }
  CHECK_NEAR(x[1], 0.3, 1e-12);
}

int main(void)
{
  trb_bracket bracket;
  if (!CHECK(trb_bracket_create(&bracket, N) == 0)) return check_report();
  test_points(&bracket);
  test_search(&bracket);
  trb_bracket_free(&bracket);
  return check_report();
}
