/* Surfaces of several facets: gaps of a roller to facets, and the nearest of the facets of a surface
 * (docs/theory/contacts.md#bounded-faces-of-pockets). Inlined into pocket.c. */
#ifndef TRB_CONTACT_FACETS_H
#define TRB_CONTACT_FACETS_H

#include <math.h>

#include "contact/pocket_view.h"
#include "surface/sphere.h"

enum { TRB_MOST_NEAR = 64, TRB_ALL_FACETS = -1 };

/* Of ways along a plane, m. */
#define TRB_WAY_ROUNDING 1e-9

/* Numbers of facets within their surfaces, of all surfaces of a pocket. */
typedef struct trb_near_facets {
  int number[TRB_MOST_NEAR];
  int n;
} trb_near_facets;

/* The facets of a surface that a roller may touch. */
typedef struct trb_facets {
  const trb_pocket_face *first;
  const int             *near;     /* their numbers, rising */
  int                    n;        /* how many, or TRB_ALL_FACETS */
  int                    n_facets; /* of the surface */
} trb_facets;

/* All facets, where there are more than the list has room for. */
static inline void trb_add_near(trb_near_facets *list, trb_facets *near, int number)
{
  if (list->n == TRB_MOST_NEAR) near->n = TRB_ALL_FACETS;
  if (near->n == TRB_ALL_FACETS) return;
  list->number[list->n++] = number;
  near->n++;
}

/* Lower bound of the gap between the flank and a face, less that in which a film acts. A bounded face is no nearer than its plane. For a cone without
 * profile the height over the plane less the sphere's radius is linear along the axis, so its least value is at one of the ends; the cone of the
 * end spheres is around the profile. Where this bound is not positive, the least value over the nodes is taken. */
static inline double trb_flank_gap(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, int roller)
{
  const double *centre = m->centre + (size_t)roller * (size_t)m->n_lanes, *sphere = m->sphere + (size_t)roller * (size_t)m->n_lanes;
  const double  middle = trb_polygon_height(&f->surface, p->x), along = trb_dot(p->a, f->surface.normal);
  double        gap = INFINITY, least[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
  for (int end = 0; end < 2; end++) {
    const trb_sphere *last = &m->end_spheres[2 * roller + end];
    gap = trb_min(gap, middle + last->place * along - last->radius - p->pockets->film);
  }
  if (gap > 0.0) return gap;
  /* side by side: one least value alone would wait for each comparison */
  int k = 0;
  for (; k + 4 <= m->n_nodes; k += 4)
    for (int i = 0; i < 4; i++) least[i] = trb_min(least[i], middle + centre[k + i] * along - sphere[k + i] - p->pockets->film);
  for (; k < m->n_nodes; k++) least[0] = trb_min(least[0], middle + centre[k] * along - sphere[k] - p->pockets->film);
  return trb_min(trb_min(least[0], least[1]), trb_min(least[2], least[3]));
}

/* Lower bound of the gap between a flank without profile and the ball around a facet, less the film's. The place and the radius of the spheres
 * change linearly along the axis: the gap to a point at s along the axis and r from it is least where the sphere's place is
 * s + r k/sqrt(1 - k^2), k the slope of the radius, or at an end. */
static inline double trb_flank_to_ball(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, int roller)
{
  const trb_sphere *end = &m->end_spheres[2 * roller];
  const trb_vec3    to = trb_sub(f->middle, p->x);
  const double      slope = (end[1].radius - end[0].radius) / (end[1].place - end[0].place), s = trb_dot(to, p->a);
  const double      r = sqrt(trb_max(trb_dot(to, to) - s * s, 0.0)), low = trb_min(end[0].place, end[1].place);
  const double      place = trb_clamp(s + r * slope / sqrt(1.0 - slope * slope), low, trb_max(end[0].place, end[1].place));
  return hypot(r, s - place) - (end[0].radius + slope * (place - end[0].place)) - f->extent - p->pockets->film;
}

/* The least gap between planes and two spheres with centres on an axis through a point, less a film's. */
static inline double trb_spheres_to_planes(const trb_planes *planes, trb_vec3 point, trb_vec3 axis, const trb_sphere spheres[2],
                                           double film)
{
  double gap[TRB_PLANES_TOGETHER];
  for (int i = 0; i < TRB_PLANES_TOGETHER; i++) {
    const trb_vec3 normal = {planes->normal[0][i], planes->normal[1][i], planes->normal[2][i]};
    const trb_vec3 origin = {planes->origin[0][i], planes->origin[1][i], planes->origin[2][i]};
    const double   middle = trb_dot(trb_sub(point, origin), normal), along = trb_dot(axis, normal);
    const double   first = middle + spheres[0].place * along - spheres[0].radius - film;
    const double   second = middle + spheres[1].place * along - spheres[1].radius - film;
    gap[i] = trb_min(first, second);
  }
  for (int half = TRB_PLANES_TOGETHER / 2; half > 0; half /= 2)
    for (int i = 0; i < half; i++) gap[i] = trb_min(gap[i], gap[i + half]);
  return gap[0];
}

/* Lower bound of the distance of a point, h above the plane of a face, from it: that from the disc around it. The disc is wider by more than
 * what rounding makes of a way along the plane, so that no facet is left out that is as near as another one. */
static inline double trb_distance_from_disc(const trb_pocket_face *f, trb_vec3 point, double h)
{
  const trb_vec3 to = trb_sub(f->middle, point);
  const double   along = sqrt(trb_max(trb_dot(to, to) - h * h, 0.0)) - f->extent - TRB_WAY_ROUNDING;
  return along > 0.0 ? sqrt(h * h + along * along) : fabs(h);
}

/* Interference of a sphere with the nearest facet, and the normal from its centre to the nearest point. An interference that is not above the least
 * one that counts is not looked for: that one is given back. */
static inline double trb_facets_nearest(const trb_facets *s, trb_vec3 centre, double radius, double least, const trb_pocket_face **nearest,
                                        trb_vec3 *normal)
{
  const int count = s->n == TRB_ALL_FACETS ? s->n_facets : s->n;
  double    best = least;
  for (int i = 0; i < count; i++) {
    const trb_pocket_face *f = s->first + (s->n == TRB_ALL_FACETS ? i : s->near[i]);
    const double           h = trb_polygon_height(&f->surface, centre);
    trb_vec3               way;
    if (radius - h <= best) continue;
    if (radius - trb_distance_from_disc(f, centre, h) <= best) continue;
    const double d = trb_sphere_on_polygon(&f->surface, centre, h, radius, &way);
    if (d <= best) continue;
    best = d;
    *nearest = f;
    *normal = way;
  }
  return best;
}

#endif
