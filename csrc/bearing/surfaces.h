/* The surfaces of a bearing, each in the coordinates of the body that carries it: what contacts need of the geometry. They follow from the
 * bearing's numbers alone, without oil or effects. */
#ifndef TRB_BEARING_SURFACES_H
#define TRB_BEARING_SURFACES_H

#include "bearing/geometry.h"
#include "surface/circle.h"
#include "surface/cone.h"
#include "surface/sphere.h"

typedef struct trb_surfaces {
  /* of the rings, about their axes; places from the origin for the outer ring, from the roller-centre plane for the inner one */
  trb_cone   race[TRB_N_RACES];
  trb_circle front_rib[2]; /* edges of the plane front rib of the inner ring */
  /* of a roller, about its axis; places from its centre of mass */
  trb_cone   flank;           /* without profile and deviation; its reference plane is mid length */
  trb_sphere end[TRB_N_ENDS]; /* spheres of its ends; a tapered roller has that of the large end alone */
  double     small_end;       /* plane of the small end, m */
} trb_surfaces;

/* The cones of outer and inner raceway, with the reference plane through the rollers' mid length, at a place along their axis. */
trb_cone trb_raceway_cone(const trb_params *params, const trb_geometry *geometry, int race, double place);

/* The face of a rib, about the axis of its ring, from the roller-centre plane. */
trb_cone trb_rib_face(const trb_rib_place *place, int end);

void trb_surfaces_build(const trb_params *params, const trb_geometry *geometry, trb_surfaces *surfaces);

#endif
