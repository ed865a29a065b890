/* A circle about the axis of its body, such as the edge of a rib, and a plane, such as the end of a roller
 * (docs/theory/contacts.md#small-end-on-the-front-rib). The depth of c + r e beyond a plane through E with the normal a is largest where e points
 * along the part of a across the axis, a_perp: (c - E).a + r |a_perp|. The deepest point moves smoothly as long as a_perp is not zero. */
#ifndef TRB_SURFACE_CIRCLE_H
#define TRB_SURFACE_CIRCLE_H

#include "base/vec3.h"

typedef struct trb_circle {
  double place;  /* of its plane along the axis, m */
  double radius; /* m */
} trb_circle;

/* How a circle meets a plane. */
typedef struct trb_circle_meeting {
  trb_vec3 centre; /* of the circle, m */
  trb_vec3 across; /* part of the plane's normal across the circle's axis */
  double   lean;   /* its length: sine of the angle between the normal and the axis */
  double   depth;  /* of the deepest point beyond the plane, m; negative: the gap */
} trb_circle_meeting;

/* centre: of the circle; axis: unit vector; beyond: a point of the plane; normal: unit vector, towards the side where depth counts. */
static inline trb_circle_meeting trb_circle_on_plane(trb_vec3 centre, trb_vec3 axis, double radius, trb_vec3 beyond, trb_vec3 normal)
{
  const trb_vec3 across = trb_axpy(normal, -trb_dot(normal, axis), axis);
  const double   lean = trb_norm(across);
  return (trb_circle_meeting){centre, across, lean, trb_dot(trb_sub(centre, beyond), normal) + radius * lean};
}

/* The deepest point of a circle of a radius; lean must not be zero. */
static inline trb_vec3 trb_circle_deepest(const trb_circle_meeting *c, double radius)
{
  return trb_axpy(c->centre, radius / c->lean, c->across);
}

#endif
