/* A cone about the axis of its body: raceways, the flank of a roller, the face of a rib; a cylinder is the one with the half angle zero. It is
 * given by its radius R at a reference plane, and not by its apex, which a cylinder has not: e = R + z tan(alpha) with z along the axis from
 * that plane and e the distance from the axis. A point is (e - R) cos(alpha) - z sin(alpha) beyond the surface, whose gradient is the normal
 * cos(alpha) e^ - sin(alpha) k^, k^ the axis. Nothing is divided by a sine.
 *
 * Of both sides the normal out of that where the bodies are, into the material, is kept: cosine and sine are those of alpha where bodies are
 * inside (outer raceway), both with the other sign where they are outside (inner raceway, flank). A rib whose face has its normal at the angle
 * beta to the axis has the cosine sin(beta) and the sine -cos(beta): alpha = beta - 90 degrees. */
#ifndef TRB_SURFACE_CONE_H
#define TRB_SURFACE_CONE_H

#include "base/vec3.h"

/* Keeps the direction from the axis finite for a point on it, m: such as the centre of a large end's sphere, whose rib is far away. */
#define TRB_AXIS_GUARD 1e-9

typedef struct trb_cone {
  double place;        /* of the reference plane along the axis, from the body's reference point, m */
  double radius;       /* there, m */
  double cosine, sine; /* the normal into the material is cosine e^ - sine k^ */
} trb_cone;

/* How a point lies to a cone. */
typedef struct trb_cone_foot {
  double   beyond; /* distance beyond the surface, in the material, m; negative: the gap */
  trb_vec3 normal; /* into the material: gradient of beyond */
} trb_cone_foot;

/* side: 1 where the bodies are inside of the cone, -1 where they are outside. */
static inline trb_cone trb_cone_of(double place, double radius, double half_angle, double side)
{
  return (trb_cone){place, radius, side * cos(half_angle), side * sin(half_angle)};
}

/* The point on the axis at the reference plane. centre: the body's reference point, on the axis; axis: unit vector. */
static inline trb_vec3 trb_cone_point(const trb_cone *c, trb_vec3 centre, trb_vec3 axis) { return trb_axpy(centre, c->place, axis); }

/* Radius at a station along the axis from the reference plane. */
static inline double trb_cone_radius(const trb_cone *c, double station) { return c->radius + station * (c->sine / c->cosine); }

/* from: the point, from the one on the axis at the reference plane. */
static inline trb_cone_foot trb_cone_at(const trb_cone *c, trb_vec3 axis, trb_vec3 from)
{
  const double   along = trb_dot(from, axis);
  const trb_vec3 across = trb_axpy(from, -along, axis);
  const double   off = sqrt(trb_dot(across, across) + TRB_AXIS_GUARD * TRB_AXIS_GUARD);
  return (trb_cone_foot){(off - c->radius) * c->cosine - along * c->sine, trb_axpy(trb_scale(c->cosine / off, across), -c->sine, axis)};
}

#endif
