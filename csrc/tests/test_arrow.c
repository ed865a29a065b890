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

/* Where the large entries stand, and what is scaled. */
enum { DIAGONAL, SHIFTED, ROW_LARGE, COLUMN_LARGE, SHIFTED_ROW_LARGE, SHIFTED_COLUMN_LARGE, N_KINDS };

/* Blocks far from singular, whose pivots stand on the diagonal or must be looked for; a row or a column may be of very different size. */
static void randomise_block(double *block, int n, int stride, int kind, int at)
{
  const int shift = kind == SHIFTED || kind >= SHIFTED_ROW_LARGE ? 1 + at % (n - 1) : 0;
  const int row = kind == ROW_LARGE || kind == SHIFTED_ROW_LARGE ? at : -1;
  const int column = kind == COLUMN_LARGE || kind == SHIFTED_COLUMN_LARGE ? at : -1;
  for (int c = 0; c < n; c++)
    for (int i = 0; i < n; i++) {
      double *entry = &block[c * stride + i];
      fill(entry, 1, 1.0);
      if (i == (c + shift) % n) *entry += *entry < 0.0 ? -4.0 : 4.0;
      if (i == row || c == column) *entry *= 1e6;
    }
}

/* The Jacobian of I - gamma J = A; rollers that are not coupled have borders that must not count. */
static void of_system(trb_arrow *a)
{
  const double per = 1.0 / a->gamma;
  for (int j = 0; j < a->n; j++)
    for (int c = 0; c < TRB_NR; c++)
      for (int i = 0; i < TRB_NR; i++) a->rollers[j].own[c][i] = per * ((double)(i == c) - a->rollers[j].own[c][i]);
  for (int i = 0; i < TRB_NC; i++)
    for (int c = 0; c < TRB_NC; c++) a->cage[c][i] = per * ((double)(i == c) - a->cage[c][i]);
}

static void randomise(trb_arrow *a, int kind)
{
  for (int j = 0; j < a->n; j++) {
    randomise_block(&a->rollers[j].own[0][0], TRB_NR, TRB_NP, (kind + j / TRB_NR) % N_KINDS, j % TRB_NR);
    fill(&a->borders[j].to_cage[0][0], TRB_NR * TRB_NC, 1.0);
    fill(&a->borders[j].from[0][0], TRB_NR * TRB_NC, 1.0);
    a->borders[j].coupled = a->with_cage && j % 3 != 1;
  }
  memset(a->cage, 0, sizeof a->cage);
  for (int i = 0; i < TRB_NC; i++) a->cage[i][i] = 1.0;
  if (a->with_cage) randomise_block(&a->cage[0][0], TRB_NC, TRB_NC, kind, kind);
  of_system(a);
}

/* I - gamma J */
static void expand(const trb_arrow *a)
{
  const int n = a->n * TRB_NR + TRB_NC, cage = a->n * TRB_NR;
  memset(dense, 0, sizeof dense);
  for (int j = 0; j < a->n; j++)
    for (int i = 0; i < TRB_NR; i++) {
      for (int c = 0; c < TRB_NR; c++) dense[j * TRB_NR + i][j * TRB_NR + c] = a->rollers[j].own[c][i];
      for (int c = 0; c < TRB_NC && a->borders[j].coupled; c++) {
        dense[j * TRB_NR + i][cage + c] = a->borders[j].to_cage[c][i];
        dense[cage + c][j * TRB_NR + i] = a->borders[j].from[i][c];
      }
    }
  for (int i = 0; i < TRB_NC; i++)
    for (int c = 0; c < TRB_NC; c++) dense[cage + i][cage + c] = a->cage[c][i];
  for (int i = 0; i < n; i++)
    for (int c = 0; c < n; c++) dense[i][c] = (double)(i == c) - a->gamma * dense[i][c];
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
  trb_arrow         *a;
  trb_arrow_factors *f;
  double             x[SIZE], b[SIZE];
  const int          n = n_rollers * TRB_NR + TRB_NC;
  if (!CHECK(trb_arrow_create(n_rollers, with_cage, &a, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(n_rollers, variant, &f, NULL) == TRB_OK)) return;
  for (int trial = 0; trial < 3 * N_KINDS; trial++) {
    a->gamma = gamma;
    randomise(a, trial % N_KINDS);
    fill(b, (size_t)n, 1.0);
    memcpy(x, b, sizeof x);
    CHECK(trb_arrow_factor(a, f) == 1);
    CHECK(f->gamma == gamma);
    trb_arrow_solve(f, x);
    /* the residual of the dense matrix, relative to what was summed */
    expand(a);
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
      double sum = 0.0, size = fabs(b[i]);
      for (int c = 0; c < n; c++) sum += dense[i][c] * x[c], size += fabs(dense[i][c] * x[c]);
      largest = fmax(largest, fabs(sum - b[i]) / size);
    }
    CHECK_NEAR(largest, 0.0, 1e-10);
    /* and the same solution as dense elimination */
    for (int i = 0; i < n; i++) dense[i][n] = b[i];
    eliminate(n);
    double norm = 0.0, off = 0.0;
    for (int i = 0; i < n; i++) norm = fmax(norm, fabs(dense[i][n])), off = fmax(off, fabs(x[i] - dense[i][n]));
    CHECK_NEAR(off / norm, 0.0, 1e-8);
  }
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
}

/* The inverse is read as whole columns: what pads it must be zero, exchanges or not. */
static void test_padding(int variant)
{
  trb_arrow         *a;
  trb_arrow_factors *f;
  if (!CHECK(trb_arrow_create(MOST, 1, &a, NULL) == TRB_OK && trb_arrow_factors_create(MOST, variant, &f, NULL) == TRB_OK)) return;
  a->gamma = 1.0;
  randomise(a, SHIFTED_ROW_LARGE);
  CHECK(trb_arrow_factor(a, f) == 1);
  for (int j = 0; j < MOST; j++)
    for (int c = 0; c < TRB_NR; c++) CHECK(f->rollers[j].inverse[c][TRB_NR] == 0.0);
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
}

static void expect_singular(const trb_arrow *a, trb_arrow_factors *f)
{
  CHECK(trb_arrow_factor(a, f) == 0);
  CHECK(f->gamma == 0.0);
}

static void test_singular(int variant)
{
  enum { N = 3, LENGTH = N * TRB_NR + TRB_NC };
  trb_arrow         *a;
  trb_arrow_factors *f;
  double             x[LENGTH];
  if (!CHECK(trb_arrow_create(N, 1, &a, NULL) == TRB_OK && trb_arrow_factors_create(N, variant, &f, NULL) == TRB_OK)) return;
  a->gamma = 1.0;
  for (int kind = 0; kind < N_KINDS; kind++)
    for (int at = 0; at < TRB_NR; at++) {
      const double bad[] = {NAN, INFINITY, -INFINITY};
      randomise(a, kind);
      CHECK(trb_arrow_factor(a, f) == 1);
      /* a row of zeros, a column of zeros, entries that are no numbers */
      for (int c = 0; c < TRB_NR; c++) a->rollers[1].own[c][at] = (double)(c == at);
      expect_singular(a, f);
      randomise(a, kind);
      for (int i = 0; i < TRB_NR; i++) a->rollers[1].own[at][i] = (double)(i == at);
      expect_singular(a, f);
      for (int k = 0; k < 3 * TRB_NR; k++) {
        randomise(a, kind);
        a->rollers[2].own[k % TRB_NR][at] = bad[k / TRB_NR];
        expect_singular(a, f);
        randomise(a, kind);
        a->cage[k % TRB_NR][at] = bad[k / TRB_NR];
        expect_singular(a, f);
      }
      randomise(a, kind);
      for (int j = 0; j < N; j++) a->borders[j].coupled = 0;
      for (int c = 0; c < TRB_NC; c++) a->cage[c][at] = (double)(c == at);
      expect_singular(a, f);
      randomise(a, kind);
      a->borders[0].to_cage[3][at] = NAN;
      expect_singular(a, f);
    }
  /* a block of rank one */
  randomise(a, 0);
  for (int c = 0; c < TRB_NR; c++)
    for (int i = 0; i < TRB_NR; i++) a->rollers[0].own[c][i] = (double)(i == c) - 1.0;
  expect_singular(a, f);
  /* no Jacobian: the unit matrix, exactly */
  memset(a->rollers, 0, N * sizeof *a->rollers);
  memset(a->borders, 0, N * sizeof *a->borders);
  memset(a->cage, 0, sizeof a->cage);
  CHECK(trb_arrow_factor(a, f) == 1);
  for (int i = 0; i < LENGTH; i++) x[i] = i;
  trb_arrow_solve(f, x);
  for (int i = 0; i < LENGTH; i++) CHECK_NEAR(x[i], i, 0.0);
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
        check_solution(variant, counts[i], with_cage, 1.0);
        check_solution(variant, counts[i], with_cage, 0.7);
      }
    test_padding(variant);
    test_singular(variant);
  }
  return check_report();
}
