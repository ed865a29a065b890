/* Kernels for a hub of any width but that of one rigid body. block_kernel.c alone includes them, once for each instruction set. */
#ifndef TRB_STEPPING_WIDE_HUB_H
#define TRB_STEPPING_WIDE_HUB_H

#include <math.h>
#include <string.h>

#include "base/variant.h"
#include "stepping/blocks.h"
#include "stepping/constants.h"

/* A part of a column as numbers side by side: where the number of columns is not known to compilers they would take the loop over the columns
 * instead, and shuffle, or take the numbers one by one. */
#if TRB_WIDE < 4
enum { QUARTET = TRB_WIDE };
#else
enum { QUARTET = 4 };
#endif
enum { QUARTETS = TRB_NP / QUARTET };
typedef double quartet __attribute__((vector_size(QUARTET * sizeof(double))));
typedef struct column_sum {
  quartet part[QUARTETS];
} column_sum;

/* One vector at a time: GCC copies several together by way of the memory, in halves, for which the next read of a whole one has to wait. */
static inline quartet load(const double *from)
{
  quartet v;
  memcpy(&v, from, sizeof v);
  return v;
}

static inline void store(quartet v, double *to) { memcpy(to, &v, sizeof v); }

_Static_assert(TRB_NP % QUARTET == 0, "a part of a column is whole vectors");

static inline void read_column(const double *from, column_sum *sum)
{
  for (int k = 0; k < QUARTETS; k++) sum->part[k] = load(from + k * QUARTET);
}

static inline void write_column(const column_sum *sum, double *to)
{
  for (int k = 0; k < QUARTETS; k++) store(sum->part[k], to + k * QUARTET);
}

/* Columns are added, or taken off; a constant where these are called. */
typedef enum column_use { ADD, TAKE } column_use;

static inline void use_column(column_use use, const double *column, double factor, column_sum *sum)
{
  for (int k = 0; k < QUARTETS; k++) {
    const quartet part = factor * load(column + k * QUARTET);
    sum->part[k] = use == ADD ? sum->part[k] + part : sum->part[k] - part;
  }
}

/* sum +- columns x, for a part of n columns, which are `stride` apart. */
static inline void use_columns(column_use use, const double *columns, int stride, int n, const double *x, column_sum *sum)
{
  column_sum odd = {0}; /* one sum alone would wait for each of its additions */
  int        c = 0;
  for (; c + 2 <= n; c += 2, columns += 2 * stride) {
    use_column(use, columns, x[c], sum);
    use_column(use, columns + stride, x[c + 1], &odd);
  }
  if (c < n) use_column(use, columns, x[c], sum);
  for (int k = 0; k < QUARTETS; k++) sum->part[k] += odd.part[k];
}

static inline void use_part(column_use use, const double *restrict columns, int stride, int n, const double *restrict x,
                            double *restrict to)
{
  column_sum sum;
  read_column(to, &sum);
  use_columns(use, columns, stride, n, x, &sum);
  write_column(&sum, to);
}

/* Inverse of a roller's block times a vector. */
static inline void own_product(const trb_arrow_factor_block *own, const double *x, double scale, double *to)
{
  column_sum sum = {0};
  for (int c = 0; c < TRB_NR; c++) use_column(ADD, own->inverse[c], x[c], &sum);
  for (int k = 0; k < QUARTETS; k++) store(scale * sum.part[k], to + k * QUARTET);
}

/* Entries of a part, which may end beyond those of the hub. */
static inline int part_size(int width, int part) { return width - part * TRB_NP < TRB_NP ? width - part * TRB_NP : TRB_NP; }

/* Parts of a hub: for (each part that some bits have). */
#define EACH_PART(part, bits) \
  for (int part = 0; (bits) >> part != 0U; part++) \
    if ((bits) >> part & 1U)

/* A part of the border of the hub's rows, whose columns are TRB_NP apart. */
static inline double *rows_of(const trb_arrow_factor_border *g, int part) { return g->from + part * TRB_NR * TRB_NP; }

static void border_wide(const trb_arrow_border *b, double gamma, const trb_arrow_factor_block *own, trb_arrow_factor_border *g,
                        const trb_hub_factor *hub)
{
  const int width = hub->width, room = hub->room;
  EACH_PART(part, b->parts)
  for (int c = 0; c < TRB_NR; c++)
    for (int i = 0; i < TRB_NP; i++) rows_of(g, part)[c * TRB_NP + i] = -gamma * b->from[c * room + part * TRB_NP + i];
  EACH_PART(part, b->parts)
  for (int c = part * TRB_NP; c < part * TRB_NP + part_size(width, part); c++) {
    own_product(own, b->to_hub + c * TRB_NR, -gamma, g->solved + c * TRB_NP);
    EACH_PART(row, b->parts)
    use_part(TAKE, rows_of(g, row), TRB_NP, TRB_NR, g->solved + c * TRB_NP, hub->schur + c * room + row * TRB_NP);
  }
}

/* Subtracts a multiple of a row from another one. */
static inline void take_row(const double *restrict row, double multiple, int room, double *restrict from)
{
  for (int part = 0; part < room; part += TRB_NP)
    for (int k = part; k < part + TRB_NP; k += QUARTET) store(load(from + k) - multiple * load(row + k), from + k);
}

/* Whether all entries are finite. */
static int all_finite(const double *x, int n)
{
  double    check[TRB_SUMS_SIDE_BY_SIDE] = {0}, sum = 0.0;
  const int whole = n - n % TRB_SUMS_SIDE_BY_SIDE;
  for (int i = 0; i < whole; i += TRB_SUMS_SIDE_BY_SIDE)
    for (int k = 0; k < TRB_SUMS_SIDE_BY_SIDE; k++) check[k] += 0.0 * x[i + k];
  for (int i = whole; i < n; i++) check[i - whole] += 0.0 * x[i];
  for (int k = 0; k < TRB_SUMS_SIDE_BY_SIDE; k++) sum += check[k];
  return sum == 0.0;
}

static inline void swap(double *a, double *b)
{
  const double keep = *a;
  *a = *b;
  *b = keep;
}

/* Inverse in place by Gauss-Jordan elimination with exchanges of columns. */
static int invert_wide(int n, int room, double *restrict a, double *restrict row, int *pivot)
{
  if (!all_finite(a, n * room)) return 0;
  for (int c = 0; c < n; c++) {
    double *const at = a + c * room;
    int           best = c;
    for (int k = c + 1; k < n; k++)
      if (fabs(at[k]) > fabs(at[best])) best = k;
    if (fabs(at[c]) >= trb_diagonal_share * fabs(at[best])) best = c;
    if (!(fabs(at[best]) > 0.0)) return 0;
    pivot[c] = best;
    for (int i = 0; best != c && i < n; i++) swap(&a[i * room + c], &a[i * room + best]);
    const double per = 1.0 / at[c];
    for (int k = 0; k < room; k++) row[k] = per * at[k];
    row[c] = per;
    for (int i = 0; i < n; i++) {
      double *const other = a + i * room;
      const double  m = other[c];
      if (i == c || m == 0.0) continue; /* bodies that do not act on each other leave many zeros */
      take_row(row, m, room, other);
      other[c] = -m * per;
    }
    memcpy(at, row, (size_t)room * sizeof *at);
  }
  for (int c = n - 1; c >= 0; c--)
    for (int k = 0; pivot[c] != c && k < room; k++) swap(&a[c * room + k], &a[pivot[c] * room + k]);
  return all_finite(a, n * room);
}

/* Loops of a known length for parts that are whole. */
static inline void take_solved(const double *solved, int n, const double *found, column_sum *sum)
{
  if (n == TRB_NP)
    for (int c = 0; c < TRB_NP; c++) use_column(TAKE, solved + c * TRB_NP, found[c], sum);
  else
    for (int c = 0; c < n; c++) use_column(TAKE, solved + c * TRB_NP, found[c], sum);
}

static inline int chosen_one(const int *chosen, int k) { return chosen == NULL ? k : chosen[k]; }

/* right: of the hub's equations; found: its solution; own: solutions of the rollers, TRB_NP entries apart. A read of numbers that were just written by two
 * writes has to wait for both, so that rollers, whose entries are not whole vectors, are taken from x one by one and put back in ascending order. */
static void solve_wide(const trb_arrow_factor_block *blocks, const trb_arrow_factor_border *border, const int *chosen, int n,
                       const trb_hub_factor *hub, double *restrict x)
{
  double *const y = x + n * TRB_NR, *const right = hub->scratch, *const found = right + hub->room, *const own = found + hub->room;
  const double covered = y[0];
  const int    width = hub->width, room = hub->room;
  memset(right, 0, 2 * (size_t)room * sizeof *right);
  memcpy(right, y, (size_t)width * sizeof *right);
  for (int k = 0; k < n; k++) own_product(&blocks[chosen_one(chosen, k)], x + k * TRB_NR, 1.0, own + k * TRB_NP);
  for (int part = 0; part * TRB_NP < room; part++) {
    column_sum sum;
    read_column(right + part * TRB_NP, &sum);
    for (int k = 0; k < n; k++) {
      const trb_arrow_factor_border *b = &border[chosen_one(chosen, k)];
      if (b->parts >> part & 1U) use_columns(TAKE, rows_of(b, part), TRB_NP, TRB_NR, own + k * TRB_NP, &sum);
    }
    write_column(&sum, right + part * TRB_NP);
  }
  for (int part = 0; part < room; part += TRB_NP) use_part(ADD, hub->inverse + part, room, width, right, found + part);
  for (int k = 0; k < n; k++) {
    const trb_arrow_factor_border *b = &border[chosen_one(chosen, k)];
    column_sum                     sum;
    read_column(own + k * TRB_NP, &sum);
    EACH_PART(part, b->parts)
    take_solved(b->solved + part * TRB_NP * TRB_NP, part_size(width, part), found + part * TRB_NP, &sum);
    write_column(&sum, x + k * TRB_NR);
  }
  y[0] = covered;
  memcpy(y, found, (size_t)width * sizeof *y);
}

#endif
