/* Sums over the modes of a body that deforms. */
#include <string.h>

#include "base/variant.h"
#include "contact/kernels.h"

/* Vectors of numbers in the notation of the compilers: without it they take the loop over the modes instead, and shuffle. */
typedef double lanes __attribute__((vector_size(TRB_SHAPE_ROOM * sizeof(double))));

static inline void add_times(const double *shape, double amplitude, lanes *sum)
{
  lanes own;
  memcpy(&own, shape, sizeof own);
  *sum += amplitude * own;
}

static void sum(const double *restrict shapes, int n, const double *restrict amplitude, double *restrict to)
{
  lanes even = {0}, odd = {0}; /* one sum alone would wait for each of its additions */
  int   i = 0;
  for (; i + 2 <= n; i += 2, shapes += 2 * TRB_SHAPE_ROOM) {
    add_times(shapes, amplitude[i], &even);
    add_times(shapes + TRB_SHAPE_ROOM, amplitude[i + 1], &odd);
  }
  if (i < n) add_times(shapes, amplitude[i], &even);
  even += odd;
  memcpy(to, &even, sizeof even);
}

static void push(const double *restrict shapes, int n, const double *restrict load, double *restrict force)
{
  lanes all, part;
  memcpy(&all, load, sizeof all);
  for (int i = 0; i < n; i++, shapes += TRB_SHAPE_ROOM) {
    memcpy(&part, shapes, sizeof part);
    part *= all;
    force[i] += ((part[0] + part[1]) + (part[2] + part[3])) + (part[4] + part[5]);
  }
}

const trb_modal_kernels TRB_JOIN(trb_modal_kernels_, TRB_KERNEL_VARIANT) = {.sum = sum, .push = push};
