/* A bounded flat face: a convex polygon in a plane, such as a face of a pocket (docs/theory/contacts.md#bounded-faces-of-pockets). A point
 * above it is nearest to a point inside of the outline (the foot on the plane), to an edge, or to a corner. */
#ifndef TRB_SURFACE_POLYGON_H
#define TRB_SURFACE_POLYGON_H

#include <float.h>

#include "base/vec3.h"
#include "laws/smooth.h"

/* Most vertices of an outline. */
#define TRB_MAX_VERTICES 12

typedef struct trb_polygon {
  trb_vec3 origin;                        /* a point of the plane, m */
  trb_vec3 u, v;                          /* unit vectors in the plane, at right angles */
  trb_vec3 normal;                        /* u x v */
  double   outline[2 * TRB_MAX_VERTICES]; /* vertices (u, v) from the origin in turn, convex and counter-clockwise, m */
  int      n;                             /* how many vertices */
} trb_polygon;

/* Nearest point of a convex polygon to a point (u, v) of its plane. vertices: n pairs (u, v), counter-clockwise. */
static inline void trb_nearest_in_polygon(const double *vertices, int n, double u, double v, double *nearest_u, double *nearest_v)
{
  double best = DBL_MAX;
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

/* Height of a point above the plane, m. */
static inline double trb_polygon_height(const trb_polygon *p, trb_vec3 point) { return trb_dot(trb_sub(point, p->origin), p->normal); }

static inline trb_vec3 trb_polygon_vertex(const trb_polygon *p, int i)
{
  const double *vertex = p->outline + 2 * i;
  return trb_axpy(trb_axpy(p->origin, vertex[0], p->u), vertex[1], p->v);
}

/* Mean of the vertices. */
static inline trb_vec3 trb_polygon_middle(const trb_polygon *p)
{
  trb_vec3 sum = {0, 0, 0};
  for (int i = 0; i < p->n; i++) sum = trb_add(sum, trb_polygon_vertex(p, i));
  return trb_scale(1.0 / p->n, sum);
}

/* From a point at a height above the plane to the nearest point of the polygon. Its length, the distance, is continuous with its gradient
 * everywhere off the polygon, as the polygon is convex. */
static inline trb_vec3 trb_polygon_way(const trb_polygon *p, trb_vec3 point, double height)
{
  const trb_vec3 from = trb_sub(point, p->origin);
  const double   cu = trb_dot(from, p->u), cv = trb_dot(from, p->v);
  double         nu, nv;
  trb_nearest_in_polygon(p->outline, p->n, cu, cv, &nu, &nv);
  return trb_axpy(trb_axpy(trb_scale(-height, p->normal), nu - cu, p->u), nv - cv, p->v);
}

#endif
