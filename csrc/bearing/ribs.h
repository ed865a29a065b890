/* Conical ribs of the rings, and the spherical ends of rollers that meet them. A tapered roller bearing has one, at the inner ring against the
 * large ends; a cylindrical one has up to four, of both rings against both ends. */
#ifndef TRB_BEARING_RIBS_H
#define TRB_BEARING_RIBS_H

#include "bearing/surfaces.h"

/* The end of a roller that a rib meets; of a cylinder the large end is the one towards +z. */
enum { TRB_END_SMALL = 0, TRB_END_LARGE = 1, TRB_N_ENDS = 2 };

/* Where a rib is, and the shape of its contact. */
typedef struct trb_rib_place {
  double normal_angle;              /* of the face's normal, from the bearing axis outward, rad */
  double radius;                    /* of the nominal contact from the bearing axis, m */
  double along;                     /* its axial position from the roller-centre plane, m */
  double curvature_radius;          /* of the face around the ring, m; negative: convex */
  double rx, ry;                    /* equivalent radii along and across rolling, m */
  double ellipticity, stiffness;    /* of the Hertz contact: 1, N/m^1.5 */
  double semi_rolling, semi_across; /* its semi-axes, per cube root of load, m/N^(1/3) */
} trb_rib_place;

/* race: of the ring that has the rib. */
trb_status trb_place_rib(const trb_params *params, const trb_geometry *geometry, int race, int end, trb_rib_place *place,
                         trb_message *message);

/* Whether cylindrical rollers have a rib at either end. */
int trb_between_ribs(const trb_params *params);

/* The sphere of a roller's end, from mid length. */
trb_sphere trb_end_sphere(const trb_geometry *geometry, int end);

/* The face of a rib, about the axis of its ring, from the roller-centre plane. */
trb_cone trb_rib_face(const trb_rib_place *place, int end);

#endif
