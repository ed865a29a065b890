#include "motion/clearance.h"

#include <math.h>
#include <string.h>

void trb_clearance_set(const trb_model *m, trb_clearance *c, const trb_gaps *gaps, const double *y_roller, const double *y_cage)
{
  const double far = fabs(y_roller[TRB_ROLLER_r]) + fabs(y_roller[TRB_ROLLER_z]) + fabs(y_cage[TRB_CAGE_x]) + fabs(y_cage[TRB_CAGE_y]) +
                     fabs(y_cage[TRB_CAGE_z]);
  /* a gap that is not a number (NaN) proves nothing */
  for (int i = 0; i < TRB_N_GAPS; i++)
    c->gaps.of[i] = far < trb_clearance_play(m) && gaps->of[i] > 0.0 ? trb_min(gaps->of[i], trb_clearance_play(m)) : 0.0;
  memcpy(c->roller, y_roller, sizeof c->roller);
  memcpy(c->cage, y_cage, sizeof c->cage);
}

double trb_clearance_left(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage)
{
  double left[TRB_N_GAPS];
  for (int g = 0; g < TRB_N_GAPS; g++) {
    left[g] = c->gaps.of[g];
    for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) left[g] -= arms[g].roller[i] * fabs(y_roller[i] - c->roller[i]);
    for (int i = 0; i < TRB_CLEARANCE_CAGE; i++) left[g] -= arms[g].cage[i] * fabs(y_cage[i] - c->cage[i]);
  }
  return fmin(left[TRB_GAP_FLANK], left[TRB_GAP_ENDS]);
}

int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage)
{
  double moved[TRB_N_GAPS] = {0};
  if (!trb_gaps_clear(&c->gaps)) return 0;
  for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) {
    const double way = fabs(y_roller[i] - c->roller[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) moved[g] += arms[g].roller[i] * way;
  }
  for (int i = 0; i < TRB_CLEARANCE_CAGE; i++) {
    const double way = fabs(y_cage[i] - c->cage[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) moved[g] += arms[g].cage[i] * way;
  }
  /* where a coordinate is not a number (NaN) both comparisons are false: nothing is proven */
  return moved[TRB_GAP_FLANK] < c->gaps.of[TRB_GAP_FLANK] && moved[TRB_GAP_ENDS] < c->gaps.of[TRB_GAP_ENDS];
}
