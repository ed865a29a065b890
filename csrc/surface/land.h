/* A land of a ring and the guiding surface of a cage: two cylinders with nearly the same axis (docs/theory/contacts.md#cage-on-a-rings-land).
 * The guiding surface is cut into strips along its width. In each of them the cage's axis passes through one point, and what matters is how
 * that point lies from the ring's axis, across it. */
#ifndef TRB_SURFACE_LAND_H
#define TRB_SURFACE_LAND_H

#include "base/vec3.h"

/* A strip: the point on the cage's axis, and how it lies from the ring's axis. */
typedef struct trb_land_strip {
  trb_vec3 x, apart; /* m */
  double   size;     /* of apart, m */
} trb_land_strip;

/* x: the strip's point on the cage's axis; centre and axis: a point on the ring's axis, and its direction (unit vector). */
static inline trb_land_strip trb_land_strip_at(trb_vec3 x, trb_vec3 centre, trb_vec3 axis)
{
  const trb_vec3 from = trb_sub(x, centre), apart = trb_axpy(from, -trb_dot(from, axis), axis);
  return (trb_land_strip){x, apart, trb_norm(apart)};
}

/* The point of the land that is nearest to the guiding surface. normal: along apart, unit vector; radius: of the land; inside: whether the
 * cage runs inside of it. */
static inline trb_vec3 trb_land_nearest(const trb_land_strip *s, trb_vec3 normal, double radius, int inside)
{
  return trb_axpy(trb_sub(s->x, s->apart), inside ? radius : -radius, normal);
}

#endif
