#include "motion/clearance.h"

#include <math.h>
#include <string.h>

void trb_clearance_set(const trb_model *m, trb_clearance *c, const trb_gaps *gaps, const double *y_roller, const double *y_body)
{
  const double far = fabs(y_roller[TRB_ROLLER_r]) + fabs(y_roller[TRB_ROLLER_z]) + fabs(y_body[0]) + fabs(y_body[1]) + fabs(y_body[2]);
  /* a gap that is not a number (NaN) proves nothing */
  for (int i = 0; i < TRB_N_GAPS; i++)
    c->gaps.of[i] = far < trb_clearance_play(m) && gaps->of[i] > 0.0 ? trb_min(gaps->of[i], trb_clearance_play(m)) : 0.0;
  memcpy(c->roller, y_roller, sizeof c->roller);
  memcpy(c->body, y_body, sizeof c->body);
}

double trb_clearance_left(const trb_clearance *c, const trb_clearance_arms *arms, const double *deformed, const double *y_roller,
                          const double *y_body)
{
  double left[TRB_N_GAPS];
  for (int g = 0; g < TRB_N_GAPS; g++) {
    left[g] = deformed == NULL ? c->gaps.of[g] : c->gaps.of[g] - deformed[g];
    for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) left[g] -= arms[g].roller[i] * fabs(y_roller[i] - c->roller[i]);
    for (int i = 0; i < TRB_CLEARANCE_BODY; i++) left[g] -= arms[g].body[i] * fabs(y_body[i] - c->body[i]);
  }
  return fmin(left[TRB_GAP_FLANK], left[TRB_GAP_ENDS]);
}

int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *deformed, const double *y_roller,
                        const double *y_body)
{
  double moved[TRB_N_GAPS] = {0};
  if (!trb_gaps_clear(&c->gaps)) return 0;
  if (deformed != NULL) memcpy(moved, deformed, sizeof moved);
  for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) {
    const double way = fabs(y_roller[i] - c->roller[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) moved[g] += arms[g].roller[i] * way;
  }
  for (int i = 0; i < TRB_CLEARANCE_BODY; i++) {
    const double way = fabs(y_body[i] - c->body[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) moved[g] += arms[g].body[i] * way;
  }
  /* where a coordinate is not a number (NaN) both comparisons are false: nothing is proven */
  return moved[TRB_GAP_FLANK] < c->gaps.of[TRB_GAP_FLANK] && moved[TRB_GAP_ENDS] < c->gaps.of[TRB_GAP_ENDS];
}
