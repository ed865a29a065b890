#include "bearing/surfaces.h"

#include <math.h>

/* In the axial plane the raceway touches the flank where it is 1/2 Dwe off the roller's axis, across that axis, and goes on along the raceway
 * to the roller-centre plane: 1/2 Dpw +- 1/2 Dwe [cos(alpha_m) +- sin(alpha_m) tan(alpha)], which the difference of both angles, nu, makes
 * 1/2 Dpw +- 1/2 Dwe cos(nu)/cos(alpha). Both raceways of a cylindrical bearing stand back by a quarter of its radial internal clearance. */
trb_cone trb_raceway_cone(const trb_params *params, const trb_geometry *geometry, int race, double place)
{
  const double side = race == TRB_RACE_OUTER ? 1.0 : -1.0,
               angle = race == TRB_RACE_OUTER ? params->bearing.cup_half_angle : geometry->cone_half_angle;
  const double radius = 0.5 * params->bearing.pitch_diameter +
                        side * 0.5 * params->roller.diameter * cos(geometry->roller_half_angle) / cos(angle) +
                        side * 0.25 * params->bearing.radial_clearance;
  return trb_cone_of(place, radius, angle, side);
}

trb_cone trb_rib_face(const trb_rib_place *place, int end)
{
  const double outward = end == TRB_END_LARGE ? 1.0 : -1.0;
  return (trb_cone){
      .place = place->along, .radius = place->radius, .cosine = sin(place->normal_angle), .sine = -outward * cos(place->normal_angle)};
}

/* Edges of the front rib: circles about the inner ring's axis on the face that is parallel to the nominal roller's small end. */
static void place_front_rib(const trb_params *p, const trb_geometry *g, trb_surfaces *s)
{
  const double heights[2] = {p->rib.front_low, p->rib.front_high}, am = g->roller_axis_angle;
  const double along = g->small_end_station - p->rib.front_clearance; /* of the face, from mid length */
  for (int i = 0; i < 2; i++) {
    const double below = trb_cone_radius(&s->flank, along) - heights[i] / cos(g->roller_half_angle); /* the roller's axis */
    s->front_rib[i].radius = 0.5 * p->bearing.pitch_diameter + along * sin(am) - below * cos(am);
    s->front_rib[i].place = along * cos(am) + below * sin(am);
  }
}

void trb_surfaces_build(const trb_params *params, const trb_geometry *geometry, trb_surfaces *surfaces)
{
  const trb_geometry *g = geometry;
  surfaces->race[TRB_RACE_OUTER] = trb_raceway_cone(params, g, TRB_RACE_OUTER, g->centre_plane);
  surfaces->race[TRB_RACE_INNER] = trb_raceway_cone(params, g, TRB_RACE_INNER, 0.0);
  surfaces->flank = trb_cone_of(-g->roller_mass_offset, 0.5 * params->roller.diameter, g->roller_half_angle, -1.0);
  for (int end = 0; end < TRB_N_ENDS; end++)
    surfaces->end[end] = (trb_sphere){trb_end_sphere(g, end) - g->roller_mass_offset, g->sphere_radius};
  surfaces->small_end = g->small_end_station - g->roller_mass_offset;
  place_front_rib(params, g, surfaces);
}
