/* Surfaces of several facets: gaps of a flank to a facet, and the nearest of the facets of a surface
 * (docs/theory/contacts.md#bounded-faces-of-pockets). Inlined into pocket.c. */
#ifndef TRB_CONTACT_FACETS_H
#define TRB_CONTACT_FACETS_H

#include <math.h>

#include "contact/pocket_view.h"
#include "surface/sphere.h"

enum { TRB_MOST_NEAR = 64, TRB_ALL_FACETS = -1 };

/* The facets of a surface that may be near. */
typedef struct trb_facets {
  const trb_pocket_face *first;
  int                    n_facets;            /* of the surface */
  int                    n;                   /* numbers that follow, or TRB_ALL_FACETS */
  int                    near[TRB_MOST_NEAR]; /* numbers of facets, rising */
} trb_facets;

/* Lower bound of the gap between the flank and a face, less that in which a film acts. A bounded face is no nearer than its plane. For a cone without profile the height
 * over the plane less the sphere's radius is linear along the axis, so its least value is at one of the ends; a profile only takes
 * material away. Where this bound is not positive, the least value over the nodes is taken. */
static inline double trb_flank_gap(const trb_model *m, const trb_pocket_face *f, const trb_pocket_view *p, int roller)
{
  const double *centre = m->centre + (size_t)roller * (size_t)m->n_lanes, *sphere = m->sphere + (size_t)roller * (size_t)m->n_lanes;
  const double  middle = trb_polygon_height(&f->surface, p->x), along = trb_dot(p->a, f->surface.normal);
  double        gap = INFINITY, least[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
  for (int end = 0; end < 2; end++) {
    const trb_sphere *last = &m->end_spheres[2 * roller + end];
    gap = trb_min(gap, middle + last->place * along - last->radius - m->pocket_film);
  }
  if (gap > 0.0) return gap;
  /* side by side: one least value alone would wait for each comparison */
  int k = 0;
  for (; k + 4 <= m->n_nodes; k += 4)
    for (int i = 0; i < 4; i++) least[i] = trb_min(least[i], middle + centre[k + i] * along - sphere[k + i] - m->pocket_film);
  for (; k < m->n_nodes; k++) least[0] = trb_min(least[0], middle + centre[k] * along - sphere[k] - m->pocket_film);
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
  return hypot(r, s - place) - (end[0].radius + slope * (place - end[0].place)) - f->extent - m->pocket_film;
}

/* The facets that a flank may touch. */
static inline trb_facets trb_facets_near_flank(const trb_model *m, const trb_pocket_face *first, const trb_pocket_view *p, int roller,
                                               int exact)
{
  trb_facets found = {.first = first, .n_facets = first->n_facets, .n = 0};
  if (exact) found.n = TRB_ALL_FACETS;
  for (int j = 0; j < first->n_facets && found.n != TRB_ALL_FACETS; j++) {
    const trb_pocket_face *f = first + j;
    if (trb_flank_gap(m, f, p, roller) > 0.0 || trb_flank_to_ball(m, f, p, roller) > 0.0) continue;
    if (found.n == TRB_MOST_NEAR) found.n = TRB_ALL_FACETS;
    else found.near[found.n++] = j;
  }
  return found;
}

/* Interference of a sphere with the nearest facet, and the normal from its centre to the nearest point; minus infinity if none is near. */
static inline double trb_facets_nearest(const trb_facets *s, trb_vec3 centre, double radius, const trb_pocket_face **nearest,
                                        trb_vec3 *normal)
{
  const int count = s->n == TRB_ALL_FACETS ? s->n_facets : s->n;
  double    best = -INFINITY;
  for (int i = 0; i < count; i++) {
    const trb_pocket_face *f = s->first + (s->n == TRB_ALL_FACETS ? i : s->near[i]);
    const double           h = trb_polygon_height(&f->surface, centre);
    trb_vec3               way;
    if (radius - h <= best) continue;
    if (radius + f->extent - trb_norm(trb_sub(f->middle, centre)) <= best) continue;
    const double d = trb_sphere_on_polygon(&f->surface, centre, h, radius, &way);
    if (d <= best) continue;
    best = d;
    *nearest = f;
    *normal = way;
  }
  return best;
}

#endif
