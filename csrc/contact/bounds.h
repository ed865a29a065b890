/* Bounds of how far the motion of bodies can change a contact. A pair gives the lengths and angles; motion/margin.h, motion/hold.h and
 * motion/clearance.h use them. */
#ifndef TRB_CONTACT_BOUNDS_H
#define TRB_CONTACT_BOUNDS_H

#include <math.h>

#include "body/roller.h"
#include "surface/cone.h"

/* What the motions of a roller and a ring do to their interference, at most. */
typedef struct trb_margin_arm {
  double arm;           /* largest distance of what can touch from the roller's centre of mass, m */
  double ring;          /* by which the other body's turn about its reference point moves the contact along its normal, m */
  int    on_end;        /* 1: the contact is on the roller's end, its normal nearly along the roller's axis */
  double normal_sine;   /* of an end: of the angle between the normal and the bearing axis */
  double normal_lean;   /* of an end: sine of the angle between the normal and the roller's axis */
  double sphere_offset; /* of an end: the end's sphere, its centre from the bearing axis, m */
} trb_margin_arm;

/* What the coordinates of a roller do to one kind of contact, to first order. */
typedef struct trb_hold_arms {
  double radial, axial; /* parts of the normal, 1 */
  double tilt, skew;    /* arms of tilt along the normal, and of skew across it, m */
  double reach;         /* of the surface from the roller's centre of mass, m */
  double off;           /* distance of the contact's centre of curvature from the ring's axis, m: skew moves it round the ring */
} trb_hold_arms;

/* Coordinates that come first in the state of a roller, and of a rigid body: its place (three), then its turns. */
enum { TRB_CLEARANCE_ROLLER = TRB_ROLLER_tilt + 1, TRB_CLEARANCE_BODY = 6 };

/* The longest way by which a unit of each coordinate moves what may touch, m/m or m/rad. The centre of the large end's sphere is far
 * from the roller, so ends have longer arms than the flank, whose gap is the smaller one. */
typedef struct trb_clearance_arms {
  double roller[TRB_CLEARANCE_ROLLER];
  double body[TRB_CLEARANCE_BODY];
} trb_clearance_arms;

/* By how much a turn of a cone about its body's reference point changes the interference with a sphere, over its angle, m. The interference
 * is (e - R) cos(alpha) - z sin(alpha) of the sphere's centre, at e from the axis and z along it (surface/cone.h). A turn changes e by no
 * more than its angle times z, and z by no more than its angle times e. radius, axial: the largest e and z, the latter from the reference point. A
 * tenth more, for the squares of angles. */
static inline double trb_cone_turned(const trb_cone *cone, double radius, double axial)
{
  return 1.1 * (fabs(cone->cosine) * axial + fabs(cone->sine) * radius);
}

/* Displacements and gaps up to which the arms of clearances are proven, m. */
static inline double trb_clearance_play(const trb_model *m) { return 0.5 * m->params.roller_diameter; }

#endif
