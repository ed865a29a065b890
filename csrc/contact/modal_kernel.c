/* Sums over the modes of a body that deforms. */
#include <string.h>

#include "base/variant.h"
#include "contact/kernels.h"

/* The sums are in the vectors of numbers of the compilers: without them they take the loop over the modes instead, and shuffle. */
enum { PARTS = TRB_SHAPE_ROOM / TRB_WIDE };

static inline void add_times(const double *shape, double amplitude, trb_wide *sum)
{
  for (int k = 0; k < PARTS; k++) {
    trb_wide own;
    memcpy(&own, shape + k * TRB_WIDE, sizeof own);
    sum[k] += amplitude * own;
  }
}

static void sum(const double *restrict shapes, int n, const double *restrict amplitude, double *restrict to)
{
  trb_wide even[PARTS] = {{0}}, odd[PARTS] = {{0}}; /* one sum alone would wait for each of its additions */
  int      i = 0;
  for (; i + 2 <= n; i += 2, shapes += 2 * TRB_SHAPE_ROOM) {
    add_times(shapes, amplitude[i], even);
    add_times(shapes + TRB_SHAPE_ROOM, amplitude[i + 1], odd);
  }
  if (i < n) add_times(shapes, amplitude[i], even);
  for (int k = 0; k < PARTS; k++) {
    even[k] += odd[k];
    memcpy(to + k * TRB_WIDE, &even[k], sizeof even[k]);
  }
}

static void push(const double *restrict shapes, int n, const double *restrict load, double *restrict force)
{
  trb_wide all[PARTS];
  for (int k = 0; k < PARTS; k++) memcpy(&all[k], load + k * TRB_WIDE, sizeof all[k]);
  for (int i = 0; i < n; i++, shapes += TRB_SHAPE_ROOM) {
    double part[TRB_SHAPE_ROOM];
    for (int k = 0; k < PARTS; k++) {
      trb_wide own;
      memcpy(&own, shapes + k * TRB_WIDE, sizeof own);
      own *= all[k];
      memcpy(part + k * TRB_WIDE, &own, sizeof own);
    }
    force[i] += ((part[0] + part[1]) + (part[2] + part[3])) + (part[4] + part[5]);
  }
}

const trb_modal_kernels TRB_JOIN(trb_modal_kernels_, TRB_KERNEL_VARIANT) = {.sum = sum, .push = push};
