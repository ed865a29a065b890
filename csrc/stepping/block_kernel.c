/* Small dense loops of fixed length over contiguous columns: what the compiler vectorises fully, without reordering any sum. */
#include <math.h>
#include <string.h>

#include "stepping/blocks.h"

#ifndef TRB_KERNEL_VARIANT
#define TRB_KERNEL_VARIANT scalar
#endif
#define TRB_JOIN_(a, b) a##b
#define TRB_JOIN(a, b) TRB_JOIN_(a, b)

/* A pivot on the diagonal is taken if it is no smaller than this share of the largest. */
#define DIAGONAL_SHARE 0.1

enum { ACCUMULATORS = 16 };

static inline double larger(double a, double b) { return a > b ? a : b; }

/* Factors that keep an entry or not; rows are read in one piece, where a single entry that was just written would hold the load up. */
#define ROW(c) {c > 0, c > 1, c > 2, c > 3, c > 4, c > 5, c > 6, c > 7, c > 8, c > 9, c > 10, 1}
static const double before[TRB_NR][TRB_NP] = {ROW(0), ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7), ROW(8), ROW(9), ROW(10)};
#undef ROW
#define ROW(c) {c == 0, c == 1, c == 2, c == 3, c == 4, c == 5, c == 6, c == 7, c == 8, c == 9, c == 10, 0}
static const double unit[TRB_NR][TRB_NP] = {ROW(0), ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7), ROW(8), ROW(9), ROW(10)};
#undef ROW

/* 1 for a roller's entries, 0 for the padding. */
static const double roller[TRB_NP] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};

/* Largest entry by magnitude of row c from column c on. */
static inline double largest_from(const double *row, int c)
{
  double size[TRB_NP], most[4];
  for (int k = 0; k < TRB_NP; k++) size[k] = (1.0 - before[c][k]) * fabs(row[k]);
  for (int k = 0; k < 4; k++) most[k] = larger(larger(size[k], size[k + 4]), size[k + 8]);
  return larger(larger(most[0], most[1]), larger(most[2], most[3]));
}

/* Column of the pivot of row c, or -1. */
static inline int pivot_of(const double *row, int c)
{
  const double largest = largest_from(row, c);
  if (!(largest > 0.0)) return -1;
  if (fabs(row[c]) >= DIAGONAL_SHARE * largest) return c;
  for (int k = c + 1; k < TRB_NR; k++)
    if (fabs(row[k]) == largest) return k;
  return -1;
}

/* Gauss-Jordan in place with pivots along rows; the padding columns are zero and stay so. */
static int invert(double (*restrict a)[TRB_NP])
{
  int    pivot[TRB_NR];
  double check[TRB_NP] = {0}, sum = 0.0;
  for (int c = 0; c < TRB_NR; c++) {
    const int best = pivot_of(a[c], c);
    if (best < 0) return 0;
    pivot[c] = best;
    if (best != c)
      for (int i = 0; i < TRB_NR; i++) {
        const double keep = a[i][c];
        a[i][c] = a[i][best];
        a[i][best] = keep;
      }
    const double per = 1.0 / a[c][c];
    double       row[TRB_NP], keep[TRB_NP];
    for (int k = 0; k < TRB_NP; k++) keep[k] = 1.0 - unit[c][k];
    for (int k = 0; k < TRB_NP; k++) row[k] = per * (keep[k] * a[c][k] + unit[c][k]);
    for (int i = 0; i < TRB_NR; i++) {
      const double m = a[i][c];
      for (int k = 0; k < TRB_NP; k++) a[i][k] = keep[k] * a[i][k] - m * row[k];
    }
    for (int k = 0; k < TRB_NP; k++) a[c][k] = row[k];
  }
  /* exchanged columns are rows of the inverse */
  for (int c = TRB_NR - 1; c >= 0; c--) {
    if (pivot[c] == c) continue;
    double keep[TRB_NP];
    memcpy(keep, a[c], sizeof keep);
    memcpy(a[c], a[pivot[c]], sizeof keep);
    memcpy(a[pivot[c]], keep, sizeof keep);
  }
  for (int i = 0; i < TRB_NR; i++)
    for (int k = 0; k < TRB_NP; k++) check[k] += 0.0 * a[i][k];
  for (int k = 0; k < TRB_NP; k++) sum += check[k];
  return sum == 0.0;
}

static int factor(const trb_arrow_block *b, trb_arrow_factor_block *g, double (*schur)[TRB_NC])
{
  /* the columns are the rows of the transpose, and so are those of the inverse */
  memcpy(g->inverse, b->own, sizeof g->inverse);
  if (!invert(g->inverse)) return 0;
  g->coupled = b->coupled;
  if (!b->coupled) return 1;
  memset(g->solved, 0, sizeof g->solved);
  for (int c = 0; c < TRB_NC; c++)
    for (int q = 0; q < TRB_NR; q++) {
      const double m = b->to_cage[q][c];
      for (int i = 0; i < TRB_NP; i++) g->solved[c][i] += m * g->inverse[q][i];
    }
  for (int i = 0; i < TRB_NC; i++)
    for (int q = 0; q < TRB_NR; q++) g->from[q][i] = b->from[i][q];
  for (int c = 0; c < TRB_NC; c++)
    for (int q = 0; q < TRB_NR; q++) {
      const double m = g->solved[c][q];
      for (int i = 0; i < TRB_NC; i++) schur[c][i] -= m * g->from[q][i];
    }
  return 1;
}

static void eliminate(const trb_arrow_factor_block *g, int n, double *restrict rollers, double *restrict cage)
{
  for (int j = 0; j < n; j++) {
    double *x = rollers + j * TRB_NR, sum[TRB_NP] = {0};
    for (int c = 0; c < TRB_NR; c++)
      for (int i = 0; i < TRB_NP; i++) sum[i] += x[c] * g[j].inverse[c][i];
    memcpy(x, sum, TRB_NR * sizeof *x);
    if (!g[j].coupled) continue;
    for (int c = 0; c < TRB_NR; c++)
      for (int i = 0; i < TRB_NC; i++) cage[i] -= x[c] * g[j].from[c][i];
  }
}

static void substitute(const trb_arrow_factor_block *g, int n, double *restrict rollers, const double *restrict cage)
{
  for (int j = 0; j < n; j++) {
    if (!g[j].coupled) continue;
    double *x = rollers + j * TRB_NR, sum[TRB_NP] = {0};
    for (int c = 0; c < TRB_NC; c++)
      for (int i = 0; i < TRB_NP; i++) sum[i] += cage[c] * g[j].solved[c][i];
    for (int i = 0; i < TRB_NR; i++) x[i] -= sum[i];
  }
}

static double step_from(const double *restrict origin, const double *restrict per, const double *restrict y, double turn,
                        double *restrict step)
{
  double to[TRB_TANGENT_IN], square[TRB_TANGENT_IN], sum = 0.0;
  for (int i = 0; i < TRB_TANGENT_IN; i++) to[i] = (roller[i] != 0.0 ? y[i] : turn) - origin[i];
  for (int i = 0; i < TRB_TANGENT_IN; i++) square[i] = to[i] * per[i] * (to[i] * per[i]);
  for (int i = 0; i < TRB_TANGENT_IN / 2; i++) square[i] += square[i + TRB_TANGENT_IN / 2];
  for (int i = 0; i < TRB_TANGENT_IN / 2; i++) sum += square[i];
  memcpy(step, to, sizeof to);
  return sum;
}

static void follow(const double *restrict value, const double (*restrict slope)[TRB_TANGENT_OUT], const double *restrict step,
                   double *restrict flow)
{
  double sum[TRB_TANGENT_OUT];
  memcpy(sum, value, sizeof sum);
  for (int c = 0; c < TRB_TANGENT_IN; c++)
    for (int i = 0; i < TRB_TANGENT_OUT; i++) sum[i] += step[c] * slope[c][i];
  memcpy(flow, sum, sizeof sum);
}

static int all_finite(const double *x, int n)
{
  double    check[ACCUMULATORS] = {0}, sum = 0.0;
  const int whole = n - n % ACCUMULATORS;
  for (int i = 0; i < whole; i += ACCUMULATORS)
    for (int k = 0; k < ACCUMULATORS; k++) check[k] += 0.0 * x[i + k];
  for (int i = whole; i < n; i++) check[i - whole] += 0.0 * x[i];
  for (int k = 0; k < ACCUMULATORS; k++) sum += check[k];
  return sum == 0.0;
}

const trb_block_kernels TRB_JOIN(trb_block_kernels_, TRB_KERNEL_VARIANT) = {factor, eliminate, substitute, step_from, follow, all_finite};
