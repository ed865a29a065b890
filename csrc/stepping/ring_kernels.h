/* Kernels of the parts that belong to rings with coordinates (stepping/ring_tangent.h). block_kernel.c alone includes them, once for each instruction set. */
#ifndef TRB_STEPPING_RING_KERNELS_H
#define TRB_STEPPING_RING_KERNELS_H

#include <string.h>

#include "stepping/wide_hub.h"

enum { FLOW_PARTS = TRB_TANGENT_OUT / TRB_WIDE, REACTION_PARTS = TRB_RING_OUT / TRB_WIDE };
_Static_assert(TRB_TANGENT_OUT % TRB_WIDE == 0 && TRB_RING_OUT % TRB_WIDE == 0, "flows and reactions are whole vectors");

static inline trb_wide load_wide(const double *from)
{
  trb_wide v;
  memcpy(&v, from, sizeof v);
  return v;
}

static inline void add_wide(const double *column, double factor, int n, trb_wide *sum)
{
  for (int k = 0; k < n; k++) sum[k] += factor * load_wide(column + k * TRB_WIDE);
}

static void follow_ring(const trb_ring_slopes *restrict slopes, const double *restrict value, const double *restrict step,
                        const double *restrict of_ring, const double *restrict least, double *restrict flow, double *restrict reaction)
{
  trb_wide sum[FLOW_PARTS], even[REACTION_PARTS], odd[REACTION_PARTS] = {{0}};
  double   changed[TRB_TANGENT_OUT];
  for (int k = 0; k < FLOW_PARTS; k++) sum[k] = load_wide(flow + k * TRB_WIDE);
  for (int c = 0; c < TRB_RING_IN; c++) add_wide(slopes->flow[c], of_ring[c], FLOW_PARTS, sum);
  for (int k = 0; k < REACTION_PARTS; k++) even[k] = load_wide(value + k * TRB_WIDE);
  for (int c = 0; c < TRB_TANGENT_IN; c++) add_wide(slopes->reaction[c], step[c], REACTION_PARTS, c % 2 == 0 ? even : odd);
  for (int c = 0; c < TRB_RING_IN; c++) add_wide(slopes->reaction[TRB_TANGENT_IN + c], of_ring[c], REACTION_PARTS, c % 2 == 0 ? even : odd);
  for (int k = 0; k < FLOW_PARTS; k++) memcpy(changed + k * TRB_WIDE, &sum[k], sizeof sum[k]);
  for (int i = 0; i < TRB_TANGENT_OUT; i++) flow[i] = trb_max(changed[i], least[i]);
  for (int k = 0; k < REACTION_PARTS; k++) {
    even[k] += odd[k];
    memcpy(reaction + k * TRB_WIDE, &even[k], sizeof even[k]);
  }
}

/* What a roller and a ring do to each other's rates. */
static void border_ring(const trb_ring_slopes *restrict slopes, const double (*restrict response)[TRB_NP],
                        const double (*restrict with)[TRB_RING_IN], int n, int room, double *restrict from, double *restrict to_hub,
                        double (*restrict reactions)[TRB_RING_OUT])
{
  double change[TRB_NP];
  for (int c = 0; c < TRB_NR; c++) {
    column_sum sum = {0};
    for (int q = 0; q < TRB_WRENCH; q++) use_column(ADD, response[q], slopes->reaction[c][q], &sum);
    write_column(&sum, change);
    for (int i = 0; i < n; i++) from[c * room + i] += change[i];
  }
  for (int c = 0; c < n; c++) {
    column_sum sum = {0};
    trb_wide   reaction[REACTION_PARTS];
    for (int k = 0; k < REACTION_PARTS; k++) reaction[k] = load_wide(reactions[c] + k * TRB_WIDE);
    for (int q = 0; q < TRB_RING_IN; q++) {
      if (with[c][q] == 0.0) continue; /* most are */
      use_column(ADD, slopes->flow[q], with[c][q], &sum);
      add_wide(slopes->reaction[TRB_TANGENT_IN + q], with[c][q], REACTION_PARTS, reaction);
    }
    write_column(&sum, change);
    for (int i = 0; i < TRB_NR; i++) to_hub[c * TRB_NR + i] += change[i];
    for (int k = 0; k < REACTION_PARTS; k++) memcpy(reactions[c] + k * TRB_WIDE, &reaction[k], sizeof reaction[k]);
  }
}

#endif
