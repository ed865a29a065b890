/* Contact geometry: functions of their arguments alone (docs/theory/contacts.md#chain-of-spheres).
 *
 * A roller's flank is a chain of inscribed spheres: at the station where its radius is R the sphere has its centre R tan(nu) further
 * along the axis and the radius R/cos(nu). Interference with a surface is that sphere's: it depends on one body-fixed point, so a
 * frictionless contact is the gradient of an energy. It agrees with the rims of discs within 2e-4 um at 5 mrad skew. */
#ifndef TRB_LAWS_INTERFERENCE_H
#define TRB_LAWS_INTERFERENCE_H

#include "base/vec3.h"
#include "laws/smooth.h"

/* Distance of a point from a bounded convex polygon, in the polygon's plane coordinates (u, v) and height h above it: nearest point
 * of the polygon. vertices: n pairs (u, v), counter-clockwise. Continuous with its gradient everywhere off the polygon. */
static inline void trb_nearest_in_polygon(const double *vertices, int n, double u, double v, double *nearest_u, double *nearest_v)
{
  double best = INFINITY;
  int    inside = 1;
  *nearest_u = u;
  *nearest_v = v;
  const double *p = vertices + 2 * (n - 1);
  for (int i = 0; i < n; p = vertices + 2 * i++) {
    const double *q = vertices + 2 * i;
    const double  eu = q[0] - p[0], ev = q[1] - p[1], du = u - p[0], dv = v - p[1];
    /* to the right of an edge is outside */
    if (eu * dv - ev * du >= 0.0) continue;
    inside = 0;
    const double s = trb_clamp((du * eu + dv * ev) / (eu * eu + ev * ev), 0.0, 1.0);
    const double gu = du - s * eu, gv = dv - s * ev, gap = gu * gu + gv * gv;
    if (gap < best) {
      best = gap;
      *nearest_u = p[0] + s * eu;
      *nearest_v = p[1] + s * ev;
    }
  }
  if (inside) {
    *nearest_u = u;
    *nearest_v = v;
  }
}

#endif
