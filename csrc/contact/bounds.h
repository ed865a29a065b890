/* Arms of bounds: by how much the motion of two bodies can change a gap between them, at most (docs/theory/numerics.md#bounds-of-gaps). A
 * pair gives them; motion/bound.h says what they are used for. */
#ifndef TRB_CONTACT_BOUNDS_H
#define TRB_CONTACT_BOUNDS_H

#include <math.h>

#include "body/roller.h"
#include "surface/cone.h"

/* Coordinates that come first in the state of a roller, and of a rigid body: its place (three), then its turns. Of a ring: its reference
 * point and its axis. */
enum { TRB_PLACE_OF_ROLLER = TRB_ROLLER_tilt + 1, TRB_PLACE_OF_BODY = 6 };

/* What a unit of each coordinate changes of one gap of a pair, at most, m/m or m/rad: the longest way, along the normal, of anything that may
 * touch. */
typedef struct trb_arms {
  double roller[TRB_PLACE_OF_ROLLER];
  double body[TRB_PLACE_OF_BODY];
  /* of a pair with a ring, whose arms depend on how ring and roller stand (trb_way_on_ring, which also computes that of the
   * orbit angle) */
  double skew, tilt; /* shares of the roller's arms of skew and tilt that count where nothing is turned */
  double swing; /* by which the normal turns about the ring's axis, at most, if what touches moves across the plane of both axes, 1/m */
  double along; /* part of the normal along the roller's axis */
  double room;  /* displacements up to which that holds, m */
  double axial; /* largest distance of what touches from the ring's reference point, along the axis, m */
} trb_arms;

/* Displacements and gaps up to which arms are proven, m. */
static inline double trb_bound_play(const trb_model *m) { return 0.5 * m->params.roller.diameter; }

/* Arms between a cone of a ring and spheres of a roller, with centres between two stations of its axis, from its centre of mass. axial: distance
 * of these centres from the ring's reference point along the axis, at most, m. */
static inline trb_arms trb_arms_on_cone(const trb_model *m, const trb_cone *cone, double from, double to, double axial)
{
  const double centre = m->geometry.roller_centre_radius, arm = fmax(fabs(from), fabs(to));
  const double first = centre + from * m->axis_sine, last = centre + to * m->axis_sine;
  const double nearest = first * last > 0.0 ? fmin(fabs(first), fabs(last)) : 0.0, farthest = fmax(fabs(first), fabs(last));
  const double far = axial + trb_bound_play(m), cosine = fabs(cone->cosine), sine = fabs(cone->sine);
  const double turn = 1.01 * (cosine * far + sine * farthest); /* an axis moves on an arc, a little longer than the straight line */
  return (trb_arms){.roller = {cosine, 0.0, sine, arm, arm},
                    .body = {1.0, 1.0, 1.0, turn, turn, 0.0},
                    .tilt = fabs(cone->cosine * m->axis_cosine + cone->sine * m->axis_sine),
                    .along = fabs(cone->cosine * m->axis_sine - cone->sine * m->axis_cosine),
                    .swing = nearest > 0.0 ? 2.0 * cosine / nearest : 0.0, /* centres stay as far as half of it from the axis */
                    .room = 0.5 * nearest,
                    .axial = far};
}

#endif
