/* EHL rolling resistance of a line contact (docs/theory/lubrication.md#rolling-resistance).
 *
 * (10) F/l = 29.2 Re (G U)^0.648 W^0.246 phi_T/alpha0 (Zhou & Hoeprich 1991), each surface dragged by F against rolling. It holds in
 * the piezoviscous-elastic regime; the paper lets it vanish at h_PE = h_IR, here it sets in over a band of h_PE/h_IR. */
#ifndef TRB_LAWS_ROLLING_RESISTANCE_H
#define TRB_LAWS_ROLLING_RESISTANCE_H

#include "laws/smooth.h"

/* alpha0 F/(Re l phi_T) */
static inline double trb_rolling_line(double log_w, double log_u, double log_g)
{
  return 29.2 * exp(0.648 * (log_g + log_u) + 0.246 * log_w);
}

static inline double trb_rolling_share(double elastic_over_rigid, double half_width)
{
  return trb_smooth_step(elastic_over_rigid, 1.0 - half_width, 1.0 + half_width);
}

#endif
