/* The arrow matrix against dense elimination of the same matrix. */
#include "stepping/arrow.h"

#include <stdlib.h>

#include "check.h"
#include "contact/kernels.h"
#include "rig.h"

enum { MOST = 20, SIZE = MOST * TRB_NR + TRB_NC };

static unsigned long long seed = 11;
static double             dense[SIZE][SIZE + 1];

static void fill(double *values, size_t n, double scale)
{
  for (size_t i = 0; i < n; i++) values[i] = scale * rig_random(&seed);
}

/* Rollers marked as coupled have borders; rows of very different size, no dominance. */
static void randomise(trb_arrow *a, double scale)
{
  trb_arrow_zero(a);
  for (int j = 0; j < a->n; j++) {
    trb_arrow_block *b = &a->rollers[j];
    for (int c = 0; c < TRB_NR; c++) {
      fill(b->own[c], TRB_NR, scale);
      b->own[c][j % TRB_NR] *= 1e6;
    }
    b->coupled = a->with_cage && j % 3 != 1;
    if (!b->coupled) continue;
    fill(&b->to_cage[0][0], TRB_NR * TRB_NC, scale);
    fill(&b->from[0][0], TRB_NC * TRB_NR, scale);
  }
  if (a->with_cage) fill(&a->cage[0][0], TRB_NC * TRB_NC, scale);
}

static void expand(const trb_arrow *a)
{
  const int cage = a->n * TRB_NR;
  memset(dense, 0, sizeof dense);
  for (int j = 0; j < a->n; j++)
    for (int i = 0; i < TRB_NR; i++) {
      for (int c = 0; c < TRB_NR; c++) dense[j * TRB_NR + i][j * TRB_NR + c] = a->rollers[j].own[c][i];
      for (int c = 0; c < TRB_NC; c++) {
        dense[j * TRB_NR + i][cage + c] = a->rollers[j].to_cage[i][c];
        dense[cage + c][j * TRB_NR + i] = a->rollers[j].from[c][i];
      }
    }
  for (int i = 0; i < TRB_NC; i++)
    for (int c = 0; c < TRB_NC; c++) dense[cage + i][cage + c] = a->cage[i][c];
}

/* Gauss with row pivoting on the dense matrix; the right-hand side stands in column n. */
static void eliminate(int n)
{
  for (int c = 0; c < n; c++) {
    int best = c;
    for (int i = c + 1; i < n; i++)
      if (fabs(dense[i][c]) > fabs(dense[best][c])) best = i;
    for (int k = 0; k <= n; k++) {
      const double keep = dense[c][k];
      dense[c][k] = dense[best][k], dense[best][k] = keep;
    }
    for (int i = c + 1; i < n; i++) {
      const double m = dense[i][c] / dense[c][c];
      for (int k = c; k <= n && m != 0.0; k++) dense[i][k] -= m * dense[c][k];
    }
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int c = i + 1; c < n; c++) dense[i][n] -= dense[i][c] * dense[c][n];
    dense[i][n] /= dense[i][i];
  }
}

static void check_solution(int variant, int n_rollers, int with_cage, double gamma)
{
  trb_arrow         *a, *copy;
  trb_arrow_factors *f;
  double             x[SIZE], b[SIZE];
  const int          n = n_rollers * TRB_NR + TRB_NC;
  if (!CHECK(trb_arrow_create(n_rollers, with_cage, &a, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_create(n_rollers, with_cage, &copy, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(n_rollers, variant, &f, NULL) == TRB_OK)) return;
  for (int trial = 0; trial < 10; trial++) {
    randomise(copy, gamma == 0.0 ? 1.0 : 30.0);
    if (!with_cage && gamma == 0.0)
      for (int i = 0; i < TRB_NC; i++) copy->cage[i][i] = 1.0;
    trb_arrow_copy(copy, a);
    if (gamma != 0.0) trb_arrow_scale_add_identity(a, -gamma);
    fill(b, (size_t)n, 1.0);
    memcpy(x, b, sizeof x);
    CHECK(trb_arrow_factor(a, f) == 1);
    trb_arrow_solve(f, x);
    /* the residual of the dense matrix, relative to what was summed */
    expand(copy);
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
      double sum = gamma == 0.0 ? 0.0 : x[i], size = fabs(sum) + fabs(b[i]);
      for (int c = 0; c < n; c++) {
        const double term = (gamma == 0.0 ? 1.0 : -gamma) * dense[i][c] * x[c];
        sum += term, size += fabs(term);
      }
      largest = fmax(largest, fabs(sum - b[i]) / size);
    }
    CHECK_NEAR(largest, 0.0, 1e-10);
    /* and the same solution as dense elimination */
    for (int i = 0; i < n; i++) {
      for (int c = 0; c < n; c++) dense[i][c] = (gamma == 0.0 ? dense[i][c] : (double)(i == c) - gamma * dense[i][c]);
      dense[i][n] = b[i];
    }
    eliminate(n);
    double norm = 0.0, off = 0.0;
    for (int i = 0; i < n; i++) norm = fmax(norm, fabs(dense[i][n])), off = fmax(off, fabs(x[i] - dense[i][n]));
    CHECK_NEAR(off / norm, 0.0, 1e-8);
  }
  trb_arrow_free(a);
  trb_arrow_free(copy);
  trb_arrow_factors_free(f);
}

static void test_singular(int variant)
{
  trb_arrow         *a;
  trb_arrow_factors *f;
  if (!CHECK(trb_arrow_create(3, 1, &a, NULL) == TRB_OK && trb_arrow_factors_create(3, variant, &f, NULL) == TRB_OK)) return;
  randomise(a, 1.0);
  CHECK(trb_arrow_factor(a, f) == 1);
  for (int c = 0; c < TRB_NR; c++) a->rollers[1].own[c][4] = 0.0;
  CHECK(trb_arrow_factor(a, f) == 0);
  randomise(a, 1.0);
  a->rollers[2].own[3][7] = NAN;
  CHECK(trb_arrow_factor(a, f) == 0);
  randomise(a, 1.0);
  trb_arrow_zero(a);
  CHECK(trb_arrow_factor(a, f) == 0);
  trb_arrow_scale_add_identity(a, 5.0);
  CHECK(trb_arrow_factor(a, f) == 1);
  double x[3 * TRB_NR + TRB_NC];
  for (int i = 0; i < 3 * TRB_NR + TRB_NC; i++) x[i] = i;
  trb_arrow_solve(f, x);
  for (int i = 0; i < 3 * TRB_NR + TRB_NC; i++) CHECK_NEAR(x[i], i, 0.0);
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
  trb_arrow_free(NULL);
  trb_arrow_factors_free(NULL);
}

int main(void)
{
  const int counts[] = {3, 12, MOST};
  for (int variant = 0; variant < trb_n_kernel_variants; variant++) {
    if (!trb_kernel_runs(variant)) continue;
    for (int i = 0; i < 3; i++)
      for (int with_cage = 0; with_cage < 2; with_cage++) {
        check_solution(variant, counts[i], with_cage, 0.0);
        check_solution(variant, counts[i], with_cage, 0.7);
      }
    test_singular(variant);
  }
  return check_report();
}
