/* Small dense loops of fixed length over contiguous columns. The compiler can vectorise all of them without changing the order of a sum,
 * so that variants differ in rounding as little as possible. */
#include <math.h>
#include <string.h>

#include "base/variant.h"
#include "stepping/blocks.h"
#include "stepping/constants.h"
#include "stepping/ring_kernels.h"
#include "stepping/wide_hub.h"

/* Masks of 0 and 1 by which whole rows are changed with the same arithmetic for each entry. Writing single entries instead and reading
 * the whole row right after would cause a store-forwarding stall. */
#define ROWS {ROW(0), ROW(1), ROW(2), ROW(3), ROW(4), ROW(5), ROW(6), ROW(7), ROW(8), ROW(9), ROW(10), ROW(11)}
#define ROW(c) {c > 0, c > 1, c > 2, c > 3, c > 4, c > 5, c > 6, c > 7, c > 8, c > 9, c > 10, c > 11}
static const double before[TRB_NP][TRB_NP] = ROWS;
#undef ROW
#define ROW(c) {c == 0, c == 1, c == 2, c == 3, c == 4, c == 5, c == 6, c == 7, c == 8, c == 9, c == 10, c == 11}
static const double unit[TRB_NP][TRB_NP] = ROWS;
#undef ROW

/* 1 for a roller's entries, 0 for the padding. */
static const double roller[TRB_NP] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};

/* Two steps of Gauss-Jordan elimination in place, with the pivots c and c + 1 on the diagonal: two at a time, so that rows are read and
 * written half as often. Gives the largest multiplier of a row below them. */
static inline double take_two(double (*restrict a)[TRB_NP], int n, int c)
{
  const int    d = c + 1;
  const double per = 1.0 / a[c][c], beside = per * a[c][d], below = a[d][c], per2 = 1.0 / (a[d][d] - below * beside);
  double       row[TRB_NP], row2[TRB_NP], keep[TRB_NP], most = fabs(below), most2 = 0.0;
  for (int k = 0; k < TRB_NP; k++) keep[k] = 1.0 - unit[c][k] - unit[d][k];
  for (int k = 0; k < TRB_NP; k++) row[k] = per * ((1.0 - unit[c][k]) * a[c][k] + unit[c][k]);
  for (int k = 0; k < TRB_NP; k++) row2[k] = (1.0 - unit[c][k]) * a[d][k] - below * row[k];
  for (int k = 0; k < TRB_NP; k++) row2[k] = per2 * ((1.0 - unit[d][k]) * row2[k] + unit[d][k]);
  for (int k = 0; k < TRB_NP; k++) row[k] = (1.0 - unit[d][k]) * row[k] - beside * row2[k];
  for (int i = 0; i < n; i++) {
    const double m = a[i][c], m2 = a[i][d];
    if (i > d) most = trb_max(most, fabs(m)), most2 = trb_max(most2, fabs(m2 - m * beside));
    for (int k = 0; k < TRB_NP; k++) a[i][k] = keep[k] * a[i][k] - m * row[k] - m2 * row2[k];
  }
  for (int k = 0; k < TRB_NP; k++) a[c][k] = row[k];
  for (int k = 0; k < TRB_NP; k++) a[d][k] = row2[k];
  return trb_max(most * fabs(per), most2 * fabs(per2));
}

static inline void take(double (*restrict a)[TRB_NP], int n, int c)
{
  const double per = 1.0 / a[c][c];
  double       row[TRB_NP], keep[TRB_NP];
  for (int k = 0; k < TRB_NP; k++) keep[k] = 1.0 - unit[c][k];
  for (int k = 0; k < TRB_NP; k++) row[k] = per * (keep[k] * a[c][k] + unit[c][k]);
  for (int i = 0; i < n; i++) {
    const double m = a[i][c];
    for (int k = 0; k < TRB_NP; k++) a[i][k] = keep[k] * a[i][k] - m * row[k];
  }
  for (int k = 0; k < TRB_NP; k++) a[c][k] = row[k];
}

/* Inverse in place by Gauss-Jordan elimination without exchanges; 0: a multiplier was too large, or the result is not finite. */
static inline int invert_as_is(double (*restrict a)[TRB_NP], int n)
{
  double most = 0.0;
  int    c = 0;
  for (; c + 1 < n; c += 2) most = trb_max(take_two(a, n, c), most);
  if (c < n) take(a, n, c);
  return most * trb_diagonal_share <= 1.0 && all_finite(&a[0][0], n * TRB_NP);
}

/* Largest entry by magnitude of row c from column c on. */
static inline double largest_from(const double *row, int c)
{
  double size[TRB_NP], most[4];
  for (int k = 0; k < TRB_NP; k++) size[k] = (1.0 - before[c][k]) * fabs(row[k]);
  for (int k = 0; k < 4; k++) most[k] = trb_max(trb_max(size[k], size[k + 4]), size[k + 8]);
  return trb_max(trb_max(most[0], most[1]), trb_max(most[2], most[3]));
}

/* Column of the pivot of row c, or -1. */
static inline int pivot_of(const double *row, int n, int c)
{
  const double largest = largest_from(row, c);
  if (!(largest > 0.0)) return -1;
  if (fabs(row[c]) >= trb_diagonal_share * largest) return c;
  for (int k = c + 1; k < n; k++)
    if (fabs(row[k]) == largest) return k;
  return -1;
}

/* Inverse in place by Gauss-Jordan elimination with exchanges of columns; padding columns are zero and stay so. */
static int invert_with_exchanges(double (*restrict a)[TRB_NP], int n)
{
  int pivot[TRB_NP];
  for (int c = 0; c < n; c++) {
    const int best = pivot_of(a[c], n, c);
    if (best < 0) return 0;
    pivot[c] = best;
    for (int i = 0; best != c && i < n; i++) swap(&a[i][c], &a[i][best]);
    take(a, n, c);
  }
  /* columns that were exchanged are rows of the inverse: put them back in reverse order */
  for (int c = n - 1; c >= 0; c--) {
    if (pivot[c] == c) continue;
    double keep[TRB_NP];
    memcpy(keep, a[c], sizeof keep);
    memcpy(a[c], a[pivot[c]], sizeof keep);
    memcpy(a[pivot[c]], keep, sizeof keep);
  }
  return all_finite(&a[0][0], n * TRB_NP);
}

static inline void combine(double one, double scale, const double (*from)[TRB_NP], double (*restrict to)[TRB_NP], int n)
{
  for (int c = 0; c < n; c++)
    for (int i = 0; i < TRB_NP; i++) to[c][i] = one * unit[c][i] + scale * from[c][i];
}

/* Inverse of one I + scale A. A is stored column by column, and so is the inverse: the inverse of the transpose is the transpose of the
 * inverse. In the systems of the integrator the diagonal is the largest entry of nearly every row, so exchanges are rare. */
static inline int invert(double one, double scale, const double (*from)[TRB_NP], double (*restrict to)[TRB_NP], int n)
{
  combine(one, scale, from, to, n);
  if (invert_as_is(to, n)) return 1;
  combine(one, scale, from, to, n);
  return invert_with_exchanges(to, n);
}

static int factor(const trb_arrow_block *b, double gamma, trb_arrow_factor_block *g)
{
  return invert(1.0, -gamma, b->own, g->inverse, TRB_NR);
}

/* to = scale columns x. The whole padded column is written. Starting the sum by memset lets the compiler keep it in vector registers. */
static inline void set_product(const double (*columns)[TRB_NP], int n, const double *x, double scale, double *to)
{
  double sum[TRB_NP];
  memset(sum, 0, sizeof sum);
  for (int c = 0; c < n; c++)
    for (int i = 0; i < TRB_NP; i++) sum[i] += x[c] * columns[c][i];
  for (int i = 0; i < TRB_NP; i++) to[i] = scale * sum[i];
}

/* to += scale columns x */
static inline void add_product(const double (*columns)[TRB_NP], int n, const double *x, double scale, double *to)
{
  double sum[TRB_NP];
  for (int i = 0; i < TRB_NP; i++) sum[i] = to[i];
  for (int c = 0; c < n; c++)
    for (int i = 0; i < TRB_NP; i++) sum[i] += scale * x[c] * columns[c][i];
  for (int i = 0; i < TRB_NP; i++) to[i] = sum[i];
}

/* Columns of a hub of one rigid body. */
typedef const double (*one_body_columns)[TRB_HUB_ONE_BODY];

static void border(const trb_arrow_border *b, double gamma, const trb_arrow_factor_block *own, trb_arrow_factor_border *g,
                   const trb_hub_factor *hub)
{
  g->parts = b->parts;
  if (hub->width != TRB_HUB_ONE_BODY) {
    border_wide(b, gamma, own, g, hub);
    return;
  }
  for (int i = 0; i < TRB_NR * TRB_HUB_ONE_BODY; i++) g->from[i] = -gamma * b->from[i];
  for (int c = 0; c < TRB_HUB_ONE_BODY; c++) set_product(own->inverse, TRB_NR, b->to_hub + c * TRB_NR, -gamma, g->solved + c * TRB_NP);
  for (int c = 0; c < TRB_HUB_ONE_BODY; c++)
    add_product((one_body_columns)g->from, TRB_NR, g->solved + c * TRB_NP, -1.0, hub->schur + c * TRB_HUB_ONE_BODY);
}

static int invert_one_body(const double (*schur)[TRB_NP], double (*inverse)[TRB_NP])
{
  return invert(0.0, 1.0, schur, inverse, TRB_HUB_ONE_BODY);
}

static int invert_hub(const trb_hub_factor *hub)
{
  if (hub->width == TRB_HUB_ONE_BODY) return invert_one_body((const double (*)[TRB_NP])hub->schur, (double (*)[TRB_NP])hub->inverse);
  memcpy(hub->inverse, hub->schur, (size_t)(hub->width * hub->room) * sizeof *hub->inverse);
  return invert_wide(hub->width, hub->room, hub->inverse, hub->scratch, hub->pivot);
}

/* The solution of a roller is written with its padding, which covers the first entry of the next one; that entry is put back. */
static inline void solve_roller(const trb_arrow_factor_block *own, double *z)
{
  const double covered = z[TRB_NR];
  set_product(own->inverse, TRB_NR, z, 1.0, z);
  z[TRB_NR] = covered;
}

static void solve_one_body(const trb_arrow_factor_block *own, const trb_arrow_factor_border *border, const int *chosen, int n,
                           one_body_columns inverse, double *restrict x)
{
  double *const y = x + n * TRB_NR;
  double        right[TRB_HUB_ONE_BODY];
  memcpy(right, y, sizeof right);
  for (int k = 0; k < n; k++) {
    const int     j = chosen_one(chosen, k);
    double *const z = x + k * TRB_NR;
    solve_roller(&own[j], z);
    if (border[j].parts != 0U) add_product((one_body_columns)border[j].from, TRB_NR, z, -1.0, right);
  }
  set_product(inverse, TRB_HUB_ONE_BODY, right, 1.0, y);
  memcpy(right, y, sizeof right);
  for (int k = 0; k < n; k++) {
    const int j = chosen_one(chosen, k);
    if (border[j].parts != 0U) add_product((one_body_columns)border[j].solved, TRB_HUB_ONE_BODY, right, -1.0, x + k * TRB_NR);
  }
}

static void solve(const trb_arrow_factor_block *own, const trb_arrow_factor_border *border, const int *chosen, int n,
                  const trb_hub_factor *hub, double *x)
{
  if (hub->width == TRB_HUB_ONE_BODY) solve_one_body(own, border, chosen, n, (one_body_columns)hub->inverse, x);
  else solve_wide(own, border, chosen, n, hub, x);
}

static void add(const double *columns, int stride, int n, const double *x, double *to) { use_part(ADD, columns, stride, n, x, to); }

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
                   const double *restrict curve, double bend, const double *restrict least, double *restrict flow)
{
  double sum[TRB_TANGENT_OUT];
  for (int i = 0; i < TRB_TANGENT_OUT; i++) sum[i] = value[i] + bend * curve[i];
  for (int c = 0; c < TRB_TANGENT_IN; c++)
    for (int i = 0; i < TRB_TANGENT_OUT; i++) sum[i] += step[c] * slope[c][i];
  for (int i = 0; i < TRB_TANGENT_OUT; i++) sum[i] = trb_max(sum[i], least[i]);
  memcpy(flow, sum, sizeof sum);
}

static void weigh(const double *restrict relative, const double *restrict scale, const double *restrict y, int n, double *restrict weights)
{
  for (int i = 0; i < n; i++) weights[i] = 1.0 / (relative[i] * fabs(y[i]) + scale[i]);
}

const trb_block_kernels TRB_JOIN(trb_block_kernels_, TRB_KERNEL_VARIANT) = {.factor = factor,
                                                                            .border = border,
                                                                            .invert_hub = invert_hub,
                                                                            .solve = solve,
                                                                            .add = add,
                                                                            .step_from = step_from,
                                                                            .follow = follow,
                                                                            .follow_ring = follow_ring,
                                                                            .border_ring = border_ring,
                                                                            .weigh = weigh,
                                                                            .finite = all_finite};
