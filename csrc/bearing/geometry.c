#include "bearing/geometry.h"

#include <math.h>

#include "base/vec3.h"
#include "laws/hertz.h"

const trb_geometry_info trb_geometry_table[TRB_N_GEOMETRY] = {
#define TRB_GEOMETRY_INFO(name, unit, text) {#name, unit, text},
    TRB_GEOMETRY(TRB_GEOMETRY_INFO)
#undef TRB_GEOMETRY_INFO
};

/* Cones (docs/theory/geometry.md#cones-and-rollers): with the apex distance Rc, tan(nu) = (Dwe/2)/Rc and sin(alpha_o - nu) = (Dpw/2)/Rc.
 * Their ratio gives nu, by Newton's method. Everything but the distances from the apex is written with radii at mid length, which a cylinder
 * (alpha_o = 0) has too. Where there is no apex, all is counted from the middle of the bearing. */
static void derive_cones(const trb_params *p, trb_geometry *g)
{
  const double ratio = p->roller.diameter / p->bearing.pitch_diameter;
  double       nu = 0.0;
  for (int i = 0; i < 50; i++) {
    const double cosine = cos(nu), left = p->bearing.cup_half_angle - nu;
    const double change = (ratio * sin(left) - tan(nu)) / (1.0 / (cosine * cosine) + ratio * cos(left));
    nu += change;
    if (fabs(change) < 1e-16) break;
  }
  g->roller_half_angle = nu;
  g->roller_axis_angle = p->bearing.cup_half_angle - nu;
  g->cone_half_angle = p->bearing.cup_half_angle - 2.0 * nu;
  g->apex_to_mid = p->bearing.cup_half_angle > 0.0 ? 0.5 * p->bearing.pitch_diameter / sin(g->roller_axis_angle) : 0.0;
  g->apex_to_large_end = g->apex_to_mid + 0.5 * p->roller.effective_length;
  g->centre_plane = g->apex_to_mid * cos(g->roller_axis_angle);
}

static void derive_radii(const trb_params *p, trb_geometry *g)
{
  const double across = 0.5 * p->roller.diameter * cos(g->roller_axis_angle); /* mid length to mid contact, across the bearing axis */
  const double roller = 0.5 * p->roller.diameter / cos(g->roller_half_angle);
  g->outer_race_radius = 0.5 * p->bearing.pitch_diameter + across;
  g->inner_race_radius = 0.5 * p->bearing.pitch_diameter - across;
  g->outer_equivalent_radius = 1.0 / (1.0 / roller - cos(p->bearing.cup_half_angle) / g->outer_race_radius);
  g->inner_equivalent_radius = 1.0 / (1.0 / roller + cos(g->cone_half_angle) / g->inner_race_radius);
  const double slope = 2.0 * tan(g->roller_half_angle);
  g->large_end_diameter = p->roller.diameter + 0.5 * slope * p->roller.effective_length;
  g->small_end_diameter = p->roller.diameter - 0.5 * slope * p->roller.effective_length;
  g->large_end_station = 0.5 * p->roller.total_length;
  g->small_end_station = -0.5 * p->roller.total_length;
  g->small_end_radius = 0.5 * (p->roller.diameter + slope * g->small_end_station);
}

/* Frustum of a cone between its ends, by Gauss nodes exact for the polynomials R^2, s R^2, s^2 R^2, R^4. */
static void derive_mass(const trb_params *p, trb_geometry *g)
{
  static const double node[3] = {-0.774596669241483377, 0.0, 0.774596669241483377}, weight[3] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  const double        half = 0.5 * p->roller.total_length, slope = tan(g->roller_half_angle);
  double              m0 = 0.0, m1 = 0.0, m2 = 0.0, axial = 0.0;
  for (int i = 0; i < 3; i++) {
    const double s = half * node[i], r2 = pow(0.5 * p->roller.diameter + slope * s, 2.0),
                 slab = p->roller.density * TRB_PI * r2 * half * weight[i];
    m0 += slab;
    m1 += slab * s;
    m2 += slab * s * s;
    axial += 0.5 * slab * r2;
  }
  g->roller_mass = m0;
  g->roller_mass_offset = m1 / m0;
  g->roller_inertia_axial = axial;
  g->roller_inertia_transverse = 0.5 * axial + m2 - m1 * m1 / m0;
  g->roller_centre_radius = 0.5 * p->bearing.pitch_diameter + g->roller_mass_offset * sin(g->roller_axis_angle);
  g->roller_centre_height = g->centre_plane + g->roller_mass_offset * cos(g->roller_axis_angle);
}

double trb_end_sphere(const trb_geometry *g, int end)
{
  return end == TRB_END_LARGE ? g->large_end_station - g->sphere_radius : g->small_end_station + g->sphere_radius;
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
  const int    inner = race == TRB_RACE_INNER, cylinder = p->bearing.cup_half_angle == 0.0;
  const double outward = end == TRB_END_LARGE ? 1.0 : -1.0, angle = inner ? g->cone_half_angle : p->bearing.cup_half_angle;
  const double sphere = trb_end_sphere(g, end);
  /* mid length is nearest to the inner raceway by the roller's radius there, and a quarter of the internal clearance */
  const double height =
      0.5 * p->roller.diameter * cos(g->roller_half_angle) + sphere * sin(g->roller_half_angle) + 0.25 * p->bearing.radial_clearance;
  if (!(p->rib.contact_height < g->large_end_diameter))
    return trb_fail(message, TRB_ERR_GEOMETRY, "rib_contact_height = %g m: must be below the roller's large-end diameter, %g m",
                    p->rib.contact_height, g->large_end_diameter);
  const double sine = (inner ? p->rib.contact_height - height : height - p->rib.contact_height) / g->sphere_radius;
  if (!(fabs(sine) < 1.0))
    return trb_fail(message, TRB_ERR_GEOMETRY,
                    "rib_contact_height = %g m: the sphere of the end (radius %g m) does not touch the rib there", p->rib.contact_height,
                    g->sphere_radius);
  place->normal_angle = angle + asin(sine);
  place->radius = 0.5 * p->bearing.pitch_diameter + sphere * sin(g->roller_axis_angle) + g->sphere_radius * sin(place->normal_angle);
  place->along = sphere * cos(g->roller_axis_angle) + outward * g->sphere_radius * cos(place->normal_angle) + outward * p->rib.clearance;
  if (!((cylinder || place->normal_angle > 0.0) && fabs(place->normal_angle) < 1.5))
    return trb_fail(message, TRB_ERR_GEOMETRY, "rib_contact_height = %g m: the rib's face would not close towards the roller",
                    p->rib.contact_height);
  place->curvature_radius = place->radius / sin(place->normal_angle);
  const double curvature = 1.0 / g->sphere_radius - 1.0 / place->curvature_radius;
  if (!(curvature > 0.0))
    return trb_fail(message, TRB_ERR_GEOMETRY, "%s = %g: the end (radius %g m) is flatter than the rib (%g m)",
                    p->roller.end_radius > 0.0 ? "end_radius" : "sphere_ratio",
                    p->roller.end_radius > 0.0 ? p->roller.end_radius : p->roller.sphere_ratio, g->sphere_radius, place->curvature_radius);
  place->rx = 1.0 / curvature;
  place->ry = g->sphere_radius;
  fill_contact(g, place);
  return TRB_OK;
}

/* The rib of the inner ring against the large ends. */
static trb_status derive_rib(const trb_params *p, trb_geometry *g, trb_message *message)
{
  trb_rib_place    rib = {0};
  const trb_status status = trb_place_rib(p, g, TRB_RACE_INNER, TRB_END_LARGE, &rib, message);
  if (status != TRB_OK) return status;
  g->rib_normal_angle = rib.normal_angle;
  g->rib_contact_radius = rib.radius;
  g->rib_contact_z = g->centre_plane + rib.along;
  g->rib_curvature_radius = rib.curvature_radius;
  g->rib_rx = rib.rx;
  g->rib_ry = rib.ry;
  g->rib_ellipticity = rib.ellipticity;
  g->rib_stiffness = rib.stiffness;
  g->rib_semi_axis_rolling = rib.semi_rolling;
  g->rib_semi_axis_across = rib.semi_across;
  return TRB_OK;
}

/* Of the large end; a cylinder has no apex, and gives the radius itself. */
static void derive_sphere(const trb_params *p, trb_geometry *g)
{
  const double pole = g->apex_to_mid + g->large_end_station;
  g->sphere_radius = p->roller.end_radius > 0.0 ? p->roller.end_radius : p->roller.sphere_ratio * pole;
  g->sphere_centre = pole - g->sphere_radius;
}

/* What only cones have, and what only cylinders have. */
static trb_status check_kind(const trb_params *p, const trb_geometry *g, trb_message *message)
{
  const int cylinder = p->bearing.cup_half_angle == 0.0;
  if (cylinder && !(p->roller.end_radius > 0.0))
    return trb_fail(message, TRB_ERR_GEOMETRY, "end_radius = %g m: must be above 0 for cylindrical rollers", p->roller.end_radius);
  if (cylinder) return TRB_OK;
  const struct {
    const char *name;
    double      value;
  } none[] = {{"radial_clearance", p->bearing.radial_clearance},
              {"rib_clearance", p->rib.clearance},
              {"outer_rib", p->rib.outer},
              {"outer_front_rib", p->rib.outer_front}};
  for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
    if (fabs(none[i].value) > 0.0)
      return trb_fail(message, TRB_ERR_GEOMETRY, "%s = %g: must be 0 for tapered rollers", none[i].name, none[i].value);
  if (!(g->cone_half_angle > 0.0))
    return trb_fail(message, TRB_ERR_GEOMETRY, "cup_half_angle = %g rad: too small for rollers of diameter %g m on pitch diameter %g m",
                    p->bearing.cup_half_angle, p->roller.diameter, p->bearing.pitch_diameter);
  return TRB_OK;
}

double trb_composite_modulus(double e1, double v1, double e2, double v2)
{
  const double first = e1 / (1.0 - v1 * v1), second = e2 / (1.0 - v2 * v2);
  return first == second ? first : 2.0 / (1.0 / first + 1.0 / second);
}

trb_status trb_geometry_derive(const trb_params *params, trb_geometry *geometry, trb_message *message)
{
  trb_geometry *g = geometry;
  *g = (trb_geometry){0};
  derive_cones(params, g);
  const trb_status status = check_kind(params, g, message);
  if (status != TRB_OK) return status;
  if (params->roller.total_length < params->roller.effective_length)
    return trb_fail(message, TRB_ERR_GEOMETRY, "total_length = %g m: must be at least the effective length, %g m",
                    params->roller.total_length, params->roller.effective_length);
  derive_radii(params, g);
  if (!(g->small_end_radius > 0.0))
    return trb_fail(message, TRB_ERR_GEOMETRY, "total_length = %g m: the roller would extend beyond the apex", params->roller.total_length);
  derive_sphere(params, g);
  derive_mass(params, g);
  g->effective_modulus = trb_composite_modulus(params->roller.youngs_modulus, params->roller.poisson_ratio, params->bearing.youngs_modulus,
                                               params->bearing.poisson_ratio);
  g->pocket_modulus = trb_composite_modulus(params->roller.youngs_modulus, params->roller.poisson_ratio, params->cage.youngs_modulus,
                                            params->cage.poisson_ratio);
  /* of cones with one apex and of cylinders: radii at one place of the contact are in the ratio of radii at any other */
  g->cage_speed_ratio = g->inner_race_radius / (g->inner_race_radius + g->outer_race_radius);
  g->roller_spin_ratio = g->cage_speed_ratio * g->outer_race_radius / (0.5 * params->roller.diameter);
  /* neighbours touch where the chord between two axes is shorter than a diameter across it */
  const double chord = params->bearing.pitch_diameter * sin(TRB_PI / params->bearing.n_rollers);
  if (!(chord > params->roller.diameter))
    return trb_fail(message, TRB_ERR_GEOMETRY, "n_rollers = %g: rollers of %g m overlap on pitch diameter %g m (%g m between centres)",
                    params->bearing.n_rollers, params->roller.diameter, params->bearing.pitch_diameter, chord);
  return derive_rib(params, g, message);
}
