#include "bearing/ribs.h"

#include <math.h>

#include "laws/hertz.h"

int trb_between_ribs(const trb_params *p)
{
  return (p->back_rib > 0.0 || p->outer_rib > 0.0) && (p->front_rib > 0.0 || p->outer_front_rib > 0.0);
}

trb_sphere trb_end_sphere(const trb_geometry *g, int end)
{
  if (end == TRB_END_LARGE) return (trb_sphere){g->large_end_station - g->sphere_radius, g->sphere_radius};
  return (trb_sphere){g->small_end_station + g->sphere_radius, g->sphere_radius};
}

trb_cone trb_rib_face(const trb_rib_place *place, int end)
{
  const double outward = end == TRB_END_LARGE ? 1.0 : -1.0;
  return (trb_cone){
      .place = place->along, .radius = place->radius, .cosine = sin(place->normal_angle), .sine = -outward * cos(place->normal_angle)};
}

static void fill_contact(const trb_geometry *g, trb_rib_place *place)
{
  const trb_hertz_point hertz = trb_hertz_point_constants(place->rx, place->ry, g->effective_modulus);
  const int             rolling_is_long = place->rx > place->ry;
  place->ellipticity = hertz.ellipticity;
  place->stiffness = hertz.stiffness;
  place->semi_rolling = rolling_is_long ? hertz.semi_long : hertz.semi_short;
  place->semi_across = rolling_is_long ? hertz.semi_short : hertz.semi_long;
}

/* The end's nominal sphere just touches a cone face at the given height above the raceway (docs/theory/geometry.md#rib-of-the-inner-ring); the
 * face of a cylindrical bearing stands back from there by its clearance. */
trb_status trb_place_rib(const trb_params *p, const trb_geometry *g, int race, int end, trb_rib_place *place, trb_message *message)
{
  const int        inner = race == TRB_RACE_INNER, cylinder = p->cup_half_angle == 0.0;
  const trb_sphere sphere = trb_end_sphere(g, end);
  const double     outward = end == TRB_END_LARGE ? 1.0 : -1.0, angle = inner ? g->cone_half_angle : p->cup_half_angle;
  /* mid length is nearest to the inner raceway by the roller's radius there, and a quarter of the internal clearance */
  const double height =
      0.5 * p->roller_diameter * cos(g->roller_half_angle) + sphere.place * sin(g->roller_half_angle) + 0.25 * p->radial_clearance;
  if (!(p->rib_contact_height < g->large_end_diameter))
    return trb_fail(message, TRB_ERR_GEOMETRY, "rib_contact_height = %g m: must be below the roller's large-end diameter, %g m",
                    p->rib_contact_height, g->large_end_diameter);
  const double sine = (inner ? p->rib_contact_height - height : height - p->rib_contact_height) / g->sphere_radius;
  if (!(fabs(sine) < 1.0))
    return trb_fail(message, TRB_ERR_GEOMETRY,
                    "rib_contact_height = %g m: the sphere of the end (radius %g m) does not touch the rib there", p->rib_contact_height,
                    g->sphere_radius);
  place->normal_angle = angle + asin(sine);
  place->radius = 0.5 * p->pitch_diameter + sphere.place * sin(g->roller_axis_angle) + g->sphere_radius * sin(place->normal_angle);
  place->along =
      sphere.place * cos(g->roller_axis_angle) + outward * g->sphere_radius * cos(place->normal_angle) + outward * p->rib_clearance;
  if (!((cylinder || place->normal_angle > 0.0) && fabs(place->normal_angle) < 1.5))
    return trb_fail(message, TRB_ERR_GEOMETRY, "rib_contact_height = %g m: the rib's face would not close towards the roller",
                    p->rib_contact_height);
  place->curvature_radius = place->radius / sin(place->normal_angle);
  const double curvature = 1.0 / g->sphere_radius - 1.0 / place->curvature_radius;
  if (!(curvature > 0.0))
    return trb_fail(message, TRB_ERR_GEOMETRY, "%s = %g: the end (radius %g m) is flatter than the rib (%g m)",
                    p->end_radius > 0.0 ? "end_radius" : "sphere_ratio", p->end_radius > 0.0 ? p->end_radius : p->sphere_ratio,
                    g->sphere_radius, place->curvature_radius);
  place->rx = 1.0 / curvature;
  place->ry = g->sphere_radius;
  fill_contact(g, place);
  return TRB_OK;
}
