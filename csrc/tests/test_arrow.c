/* The arrow matrix, with hubs of many widths, against dense elimination of the same matrix. */
#include "stepping/arrow.h"

#include <stdlib.h>

#include "check.h"
#include "contact/kernels.h"
#include "rig.h"

/* SPARE: the entry after the system that a solution reads and writes back, and some that it must not touch. */
enum { MOST = 12, WIDEST = 37, SIZE = MOST * TRB_NR + WIDEST, SPARE = 16 };

static const int          widths[] = {0, 1, 6, 12, 18, 24, WIDEST};
static unsigned long long seed = 11;
static double             matrix[SIZE][SIZE], dense[SIZE][SIZE + 1];

static void fill(double *values, size_t n, double scale)
{
  for (size_t i = 0; i < n; i++) values[i] = scale * rig_random(&seed);
}

/* Where the large entries stand, and what is scaled. */
enum { DIAGONAL, SHIFTED, ROW_LARGE, COLUMN_LARGE, SHIFTED_ROW_LARGE, SHIFTED_COLUMN_LARGE, N_KINDS };

/* Blocks far from singular, whose pivots stand on the diagonal or must be looked for; a row or a column may be of very different size. */
static void randomise_block(double *block, int n, int stride, int kind, int at)
{
  const int shift = n > 1 && (kind == SHIFTED || kind >= SHIFTED_ROW_LARGE) ? 1 + at % (n - 1) : 0;
  const int row = kind == ROW_LARGE || kind == SHIFTED_ROW_LARGE ? at : -1;
  const int column = kind == COLUMN_LARGE || kind == SHIFTED_COLUMN_LARGE ? at : -1;
  for (int c = 0; c < n; c++)
    for (int i = 0; i < n; i++) {
      double *entry = &block[c * stride + i];
      fill(entry, 1, 1.0);
      if (i == (c + shift) % n) *entry += *entry < 0.0 ? -4.0 - 0.25 * n : 4.0 + 0.25 * n;
      if (i == row || c == column) *entry *= 1e6;
    }
}

/* The Jacobian of I - gamma J = A; parts of the hub that a roller's borders do not have must not count. */
static void of_system(trb_arrow *a)
{
  const double per = 1.0 / a->gamma;
  for (int j = 0; j < a->n; j++)
    for (int c = 0; c < TRB_NR; c++)
      for (int i = 0; i < TRB_NR; i++) a->rollers[j].own[c][i] = per * ((double)(i == c) - a->rollers[j].own[c][i]);
  for (int c = 0; c < a->width; c++)
    for (int i = 0; i < a->width; i++) a->hub[c * a->room + i] = per * ((double)(i == c) - a->hub[c * a->room + i]);
}

static void randomise(trb_arrow *a, int kind)
{
  for (int j = 0; j < a->n; j++) {
    trb_arrow_border *border = &a->borders[j];
    randomise_block(&a->rollers[j].own[0][0], TRB_NR, TRB_NP, (kind + j / TRB_NR) % N_KINDS, j % TRB_NR);
    fill(border->to_hub, (size_t)(TRB_NR * a->width), 1.0);
    for (int q = 0; q < TRB_NR; q++) fill(border->from + q * a->room, (size_t)a->width, 1.0);
    border->parts = a->width > 0 && j % 3 != 1 ? trb_hub_parts(0, a->width) : 0U;
    if (j % 3 == 2) border->parts &= ~(1U << (unsigned)(j / 3 % 2));
  }
  randomise_block(a->hub, a->width, a->room, kind, a->width > 0 ? kind % a->width : 0);
  of_system(a);
}

/* I - gamma J */
static void expand(const trb_arrow *a)
{
  const int n = a->n * TRB_NR + a->width;
  rig_expand(a, SIZE, &matrix[0][0]);
  for (int i = 0; i < n; i++)
    for (int c = 0; c < n; c++) matrix[i][c] = (double)(i == c) - a->gamma * matrix[i][c];
}

/* The rest of the dense matrix from c on: its largest entry is brought to the diagonal by exchanges of rows and columns. */
static void exchange(int n, int c, int *column_of)
{
  int row = c, column = c;
  for (int i = c; i < n; i++)
    for (int k = c; k < n; k++)
      if (fabs(dense[i][k]) > fabs(dense[row][column])) row = i, column = k;
  for (int k = 0; k <= n; k++) {
    const double keep = dense[c][k];
    dense[c][k] = dense[row][k], dense[row][k] = keep;
  }
  for (int i = 0; i < n; i++) {
    const double keep = dense[i][c];
    dense[i][c] = dense[i][column], dense[i][column] = keep;
  }
  const int keep = column_of[c];
  column_of[c] = column_of[column], column_of[column] = keep;
}

/* x = matrix^-1 b by Gauss elimination with full pivoting. */
static void eliminate(int n, const double *b, double *x)
{
  int column_of[SIZE];
  for (int i = 0; i < n; i++) {
    memcpy(dense[i], matrix[i], (size_t)n * sizeof(double));
    dense[i][n] = b[i];
    column_of[i] = i;
  }
  for (int c = 0; c < n; c++) {
    exchange(n, c, column_of);
    for (int i = c + 1; i < n; i++) {
      const double m = dense[i][c] / dense[c][c];
      for (int k = c; k <= n && m != 0.0; k++) dense[i][k] -= m * dense[c][k];
    }
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int c = i + 1; c < n; c++) dense[i][n] -= dense[i][c] * dense[c][n];
    dense[i][n] /= dense[i][i];
  }
  for (int i = 0; i < n; i++) x[column_of[i]] = dense[i][n];
}

static void check_trial(const trb_arrow *a, trb_arrow_factors *f)
{
  const int n = a->n * TRB_NR + a->width;
  double    x[SIZE + SPARE], b[SIZE + SPARE], exact[SIZE];
  fill(b, (size_t)(n + SPARE), 1.0);
  memcpy(x, b, sizeof x);
  CHECK(trb_arrow_factor(a, a->gamma, NULL, a->n, f) == 1);
  CHECK(f->gamma == a->gamma);
  trb_arrow_solve(f, x);
  for (int i = 0; i < SPARE; i++) CHECK(x[n + i] == b[n + i]);
  /* the residual of the dense matrix, relative to what was summed */
  expand(a);
  double largest = 0.0;
  for (int i = 0; i < n; i++) {
    double sum = 0.0, size = fabs(b[i]);
    for (int c = 0; c < n; c++) sum += matrix[i][c] * x[c], size += fabs(matrix[i][c] * x[c]);
    largest = fmax(largest, fabs(sum - b[i]) / size);
  }
  CHECK_NEAR(largest, 0.0, 1e-10);
  /* and the same solution as dense elimination */
  eliminate(n, b, exact);
  double norm = 0.0, off = 0.0;
  for (int i = 0; i < n; i++) norm = fmax(norm, fabs(exact[i])), off = fmax(off, fabs(x[i] - exact[i]));
  CHECK_NEAR(off / norm, 0.0, 1e-8);
}

/* Two cages on one shaft: the second and the third part of the hub do not act on each other, and no roller touches both. */
static void part_cages(trb_arrow *a)
{
  for (int c = TRB_NP; c < a->width; c++)
    for (int i = TRB_NP; i < a->width; i++)
      if (c / TRB_NP != i / TRB_NP) a->hub[c * a->room + i] = 0.0;
  for (int j = 0; j < a->n && a->width > 2 * TRB_NP; j++) a->borders[j].parts &= ~(2U << (unsigned)(j % 2));
}

static void check_solution(int variant, int n_rollers, int width, double gamma)
{
  trb_arrow         *a;
  trb_arrow_factors *f;
  if (!CHECK(trb_arrow_create(n_rollers, width, &a, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(n_rollers, width, variant, &f, NULL) == TRB_OK)) return;
  a->gamma = gamma;
  for (int kind = 0; kind < N_KINDS; kind++) {
    randomise(a, kind);
    check_trial(a, f);
    if (kind != DIAGONAL) continue;
    part_cages(a);
    check_trial(a, f);
  }
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
}

/* The rate of an entry is another one times a number: rows of the Jacobian with one entry. */
static void make_follow(trb_arrow *a, const int entries[2])
{
  for (int c = 0; c < a->width; c++) a->hub[c * a->room + entries[0]] = c == entries[1] ? 3.0 * rig_random(&seed) : 0.0;
  for (int j = 0; j < a->n; j++)
    for (int c = 0; c < TRB_NR; c++) a->borders[j].from[c * a->room + entries[0]] = 0.0;
}

/* Entries that follow others are eliminated first, and the solution is the same. */
static void test_followers(int variant, int n_rollers, double gamma)
{
  static const int entries[][2] = {{12, 13}, {14, 15}, {17, 16}, {23, 24}, {35, 11}};
  enum { FOLLOWERS = sizeof entries / sizeof *entries };
  trb_arrow         *a;
  trb_arrow_factors *f;
  if (!CHECK(trb_arrow_create(n_rollers, WIDEST, &a, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(n_rollers, WIDEST, variant, &f, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_follow(f, FOLLOWERS, entries, NULL) == TRB_OK)) return;
  CHECK(f->hub.width == WIDEST - FOLLOWERS);
  a->gamma = gamma;
  for (int kind = 0; kind < N_KINDS; kind++) {
    randomise(a, kind);
    for (int k = 0; k < FOLLOWERS; k++) make_follow(a, entries[k]);
    check_trial(a, f);
  }
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
}

/* The inverses are read as whole columns: what pads them must be zero, exchanges or not. */
static void test_padding(int variant, int width)
{
  trb_arrow         *a;
  trb_arrow_factors *f;
  if (!CHECK(trb_arrow_create(MOST, width, &a, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(MOST, width, variant, &f, NULL) == TRB_OK)) return;
  a->gamma = 1.0;
  randomise(a, SHIFTED_ROW_LARGE);
  CHECK(trb_arrow_factor(a, a->gamma, NULL, a->n, f) == 1);
  for (int j = 0; j < MOST; j++)
    for (int c = 0; c < TRB_NR; c++) CHECK(f->rollers[j].inverse[c][TRB_NR] == 0.0);
  for (int c = 0; c < width; c++)
    for (int i = width; i < a->room; i++) CHECK(f->hub.inverse[c * a->room + i] == 0.0);
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
}

/* Fewer chosen rollers, as where one has left: their inverses are used again, and the solution is that of a system which is factored anew. */
static void test_chosen(int variant, int width)
{
  const int          all[] = {0, 1, 2, 3}, fewer[] = {0, 2, 3};
  trb_arrow         *a;
  trb_arrow_factors *f, *anew;
  double             x[2][MOST * TRB_NR + 64];
  if (!CHECK(trb_arrow_create(4, width, &a, NULL) == TRB_OK)) return;
  CHECK(trb_arrow_factors_create(4, width, variant, &f, NULL) == TRB_OK &&
        trb_arrow_factors_create(4, width, variant, &anew, NULL) == TRB_OK);
  a->gamma = 0.5;
  randomise(a, SHIFTED_ROW_LARGE);
  CHECK(trb_arrow_factor(a, a->gamma, all, 4, f) == 1);
  for (int again = 0; again < 2; again++) {
    CHECK(trb_arrow_factor_again(a, a->gamma, fewer, 3, f) == 1);
    CHECK(trb_arrow_factor(a, a->gamma, fewer, 3, anew) == 1);
    for (int i = 0; i < 3 * TRB_NR + width; i++) x[0][i] = x[1][i] = sin(i + 1.0);
    f->kernels->solve(f->rollers, f->borders, fewer, 3, &f->hub, x[0]);
    anew->kernels->solve(anew->rollers, anew->borders, fewer, 3, &anew->hub, x[1]);
    CHECK(memcmp(x[0], x[1], (size_t)(3 * TRB_NR + width) * sizeof(double)) == 0);
    a->gamma = 0.3; /* held inverses are those of another gamma */
  }
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
  trb_arrow_factors_free(anew);
}

static void expect_singular(const trb_arrow *a, trb_arrow_factors *f)
{
  CHECK(trb_arrow_factor(a, a->gamma, NULL, a->n, f) == 0);
  CHECK(f->gamma == 0.0);
}

/* Rows and columns of zeros, and entries that are no numbers, in a roller's block. */
static void test_singular_roller(trb_arrow *a, trb_arrow_factors *f, int kind, int at)
{
  const double bad[] = {NAN, INFINITY, -INFINITY};
  randomise(a, kind);
  CHECK(trb_arrow_factor(a, a->gamma, NULL, a->n, f) == 1);
  for (int c = 0; c < TRB_NR; c++) a->rollers[1].own[c][at] = (double)(c == at);
  expect_singular(a, f);
  randomise(a, kind);
  for (int i = 0; i < TRB_NR; i++) a->rollers[1].own[at][i] = (double)(i == at);
  expect_singular(a, f);
  for (int k = 0; k < 3 * TRB_NR; k++) {
    randomise(a, kind);
    a->rollers[2].own[k % TRB_NR][at] = bad[k / TRB_NR];
    expect_singular(a, f);
  }
}

/* The same in the block of the hub, which has no borders then, and an entry of a border. */
static void test_singular_hub(trb_arrow *a, trb_arrow_factors *f, int kind, int at)
{
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 3 * a->width; k += 1 + a->width / 16) {
    randomise(a, kind);
    a->hub[k % a->width * a->room + at] = bad[k / a->width];
    expect_singular(a, f);
  }
  for (int by_row = 0; by_row < 2; by_row++) {
    randomise(a, kind);
    for (int j = 0; j < a->n; j++) a->borders[j].parts = 0U;
    for (int c = 0; c < a->width; c++) a->hub[by_row ? c * a->room + at : at * a->room + c] = (double)(c == at) / a->gamma;
    expect_singular(a, f);
  }
  randomise(a, kind);
  a->borders[0].to_hub[at * TRB_NR + at % TRB_NR] = NAN;
  expect_singular(a, f);
  randomise(a, kind);
  a->borders[0].from[at % TRB_NR * a->room + at] = NAN;
  expect_singular(a, f);
}

/* No Jacobian: the unit matrix, exactly. */
static void test_unit(trb_arrow *a, trb_arrow_factors *f)
{
  const int n = a->n * TRB_NR + a->width;
  double    x[SIZE + SPARE];
  memset(a->rollers, 0, (size_t)a->n * sizeof *a->rollers);
  memset(a->hub, 0, (size_t)(a->width * a->room) * sizeof *a->hub);
  for (int j = 0; j < a->n; j++) {
    a->borders[j].parts = 0U;
    if (a->width > 0) trb_arrow_add_parts(a, j, trb_hub_parts(0, a->width));
  }
  CHECK(trb_arrow_factor(a, a->gamma, NULL, a->n, f) == 1);
  for (int i = 0; i < n + SPARE; i++) x[i] = i;
  trb_arrow_solve(f, x);
  for (int i = 0; i < n + SPARE; i++) CHECK_NEAR(x[i], i, 0.0);
}

/* A system that has no pivot on the diagonal but after exchanges: each block only moves entries on by one place. */
static void test_exchanges(trb_arrow *a, trb_arrow_factors *f)
{
  const int hub = a->n * TRB_NR, n = hub + a->width;
  double    x[SIZE + SPARE];
  for (int j = 0; j < a->n; j++) {
    a->borders[j].parts = 0U;
    for (int c = 0; c < TRB_NR; c++)
      for (int i = 0; i < TRB_NR; i++) a->rollers[j].own[c][i] = (i == (c + 1) % TRB_NR);
  }
  for (int c = 0; c < a->width; c++)
    for (int i = 0; i < a->width; i++) a->hub[c * a->room + i] = (i == (c + 1) % a->width);
  of_system(a);
  CHECK(trb_arrow_factor(a, a->gamma, NULL, a->n, f) == 1);
  for (int i = 0; i < n; i++) x[i] = i;
  trb_arrow_solve(f, x);
  for (int j = 0; j < a->n; j++)
    for (int c = 0; c < TRB_NR; c++) CHECK(x[j * TRB_NR + c] == j * TRB_NR + (c + 1) % TRB_NR);
  for (int c = 0; c < a->width; c++) CHECK(x[hub + c] == hub + (c + 1) % a->width);
}

static void test_singular(int variant, int width)
{
  trb_arrow         *a;
  trb_arrow_factors *f;
  if (!CHECK(trb_arrow_create(3, width, &a, NULL) == TRB_OK)) return;
  if (!CHECK(trb_arrow_factors_create(3, width, variant, &f, NULL) == TRB_OK)) return;
  a->gamma = 1.0;
  for (int kind = 0; kind < N_KINDS; kind++) {
    for (int at = 0; at < TRB_NR; at++) test_singular_roller(a, f, kind, at);
    for (int at = 0; at < width; at += 1 + width / 8) test_singular_hub(a, f, kind, at);
  }
  /* a block of rank one */
  randomise(a, 0);
  for (int c = 0; c < TRB_NR; c++)
    for (int i = 0; i < TRB_NR; i++) a->rollers[0].own[c][i] = (double)(i == c) - 1.0;
  expect_singular(a, f);
  test_exchanges(a, f);
  test_unit(a, f);
  trb_arrow_free(a);
  trb_arrow_factors_free(f);
}

int main(void)
{
  const int counts[] = {1, 3, MOST};
  for (int variant = 0; variant < trb_n_kernel_variants; variant++) {
    if (!trb_kernel_runs(variant)) continue;
    for (int i = 0; i < 3; i++) test_followers(variant, counts[i], i == 1 ? 0.7 : 1.0);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
      for (int i = 0; i < 3; i++) check_solution(variant, counts[i], widths[w], i == 1 ? 0.7 : 1.0);
      test_padding(variant, widths[w]);
      test_chosen(variant, widths[w]);
      test_singular(variant, widths[w]);
    }
  }
  trb_arrow_free(NULL);
  trb_arrow_factors_free(NULL);
  return check_report();
}
