#include "laws/table.h"

#include <math.h>

#include "laws/drag.h"
#include "laws/film.h"
#include "laws/hertz.h"
#include "laws/journal.h"
#include "laws/line_contact.h"
#include "laws/profile.h"
#include "laws/rolling_resistance.h"
#include "laws/squeeze.h"
#include "laws/traction.h"
#include "laws/viscosity.h"

#define ROLLING(law) trb_rolling_line(TRB_ROLLING_##law, log(x[0]), log(x[1]), log(x[2]))

/* X(name, number of arguments, their names, text, expression in x[]) */
#define TRB_LAWS(X) \
  X(line_load, 3, "interference effective_modulus length", "Palmgren (1): load per length of a line contact, N/m", \
    x[0] > 0.0 ? exp(trb_line_log_load(log(x[0]), x[1], x[2])) : 0.0) \
  X(line_half_width, 3, "load_per_length radius effective_modulus", "Hertz: half width of a line contact, m", trb_line_half_width(x[0], x[1], x[2])) \
  X(line_pressure, 3, "load_per_length radius effective_modulus", "Hertz: largest pressure of a line contact, Pa", trb_line_pressure(x[0], x[1], x[2])) \
  X(elliptic_first, 1, "m", "complete elliptic integral of the first kind, parameter m", elliptic(x[0], 0)) \
  X(elliptic_second, 1, "m", "complete elliptic integral of the second kind, parameter m", elliptic(x[0], 1)) \
  X(point_ellipticity, 2, "radius_one radius_two", "Hertz: axis ratio of a point contact", trb_hertz_point_constants(x[0], x[1], 1.0).ellipticity) \
  X(point_stiffness, 3, "radius_one radius_two effective_modulus", "Hertz: K of load = K interference^1.5, N/m^1.5", \
    trb_hertz_point_constants(x[0], x[1], x[2]).stiffness) \
  X(point_semi_axis_long, 4, "load radius_one radius_two effective_modulus", "Hertz: semi-axis along the larger radius, m", \
    cbrt(x[0]) * trb_hertz_point_constants(x[1], x[2], x[3]).semi_long) \
  X(point_semi_axis_short, 4, "load radius_one radius_two effective_modulus", "Hertz: semi-axis along the smaller radius, m", \
    cbrt(x[0]) * trb_hertz_point_constants(x[1], x[2], x[3]).semi_short) \
  X(film_line_elastic, 3, "W U G", "(4) Pan & Hamrock 1989: hc/Re, piezoviscous-elastic line", trb_film_line_elastic(log(x[0]), log(x[1]), log(x[2]))) \
  X(film_line_rigid, 2, "W U", "(5) Martin: hc/Re, isoviscous-rigid line", trb_film_line_rigid(x[1] / x[0])) \
  X(film_point_elastic, 4, "W U G radius_ratio", "(12) Chittenden et al. 1985: hc/Rx, piezoviscous-elastic ellipse, radius_ratio = Ry/Rx", \
    trb_film_point_elastic(log(x[0]), log(x[1]), log(x[2]), trb_film_point_shape(x[3]))) \
  X(film_point_rigid, 3, "W U radius_ratio", "(13) Brewe et al. 1979: hc/Rx, isoviscous-rigid ellipse", \
    trb_film_point_rigid_factor(x[2]) * (x[1] / x[0]) * (x[1] / x[0])) \
  X(film_thermal, 4, "pressure_over_modulus thermal_loading slide_roll floor", "Gupta et al. 1991: thermal film factor, with a smooth floor", \
    trb_film_thermal(x[0], log(x[1]), log(x[2]), x[3])) \
  X(film_point_needle, 4, "W U G radius_ratio", "Aihara 1987: hc/Rx, piezoviscous-elastic ellipse along rolling, radius_ratio = Ry/Rx", \
    trb_film_point_elastic(log(x[0]), log(x[1]), log(x[2]), trb_film_needle_shape(x[3]))) \
  X(film_thermal_aihara, 1, "thermal_loading", "Aihara 1987: thermal film factor", trb_film_thermal_aihara(log(x[0]))) \
  X(asperity_share, 3, "film_parameter factor exponent", "exp(-B Lambda^C): share of the load on asperities", trb_asperity_share(x[0], x[1], x[2])) \
  X(disc_torque, 4, "density kinematic_viscosity radius speed", "Schlichting: torque of a disc that turns in a fluid, both sides, N m", \
    x[3] * trb_disc_over_speed(x[0], x[1], x[2], fabs(x[3]))) \
  X(viscosity_dicke, 6, "pressure temperature a b c d", "Dicke: ln(eta/eta0), pressure in Pa, temperature in C, p in bar inside", \
    trb_viscosity_dicke(x[0], x[2] + x[3] * x[1], x[4] + x[5] * x[1])) \
  X(viscosity_roelands, 4, "pressure pressure_coefficient viscosity cap", "Roelands: ln(eta/eta0), capped", \
    trb_viscosity_roelands(x[0], x[1], log(x[2]), x[3])) \
  X(viscosity_barus, 3, "pressure pressure_coefficient cap", "Barus: ln(eta/eta0), capped", trb_viscosity_barus(x[0], x[1], x[2])) \
  X(shear_modulus, 3, "mean_pressure temperature floor", "Dyson: limiting shear modulus, Pa, with a smooth floor", trb_shear_modulus(x[0], x[1], x[2])) \
  X(friction_boundary, 4, "slide_roll limit slope decay", "(6) boundary friction coefficient", trb_friction_boundary(x[0], x[1], x[2], x[3])) \
  X(traction_muraki_kimura, 2, "sigma d", "(7)-(8) Muraki & Kimura: S of mu = tau0 S/pmean", trb_traction_muraki_kimura(x[0], x[1])) \
  X(boundary_share, 3, "film_parameter lambda_boundary lambda_full", "(2) share of boundary friction", trb_boundary_share(x[0], x[1], x[2])) \
  X(slide_roll_cage, 2, "sliding_speed entrainment_speed", "slide-roll ratio of surfaces that do not roll", trb_slide_roll_cage(x[0], x[1])) \
  X(rolling_line, 3, "W U G", "(10) Zhou & Hoeprich 1991: alpha0 F/(Re l phi_T)", ROLLING(ZHOU_HOEPRICH)) \
  X(rolling_goksem_hargreaves, 3, "W U G", "Goksem & Hargreaves 1978: alpha0 F/(Re l phi_T)", ROLLING(GOKSEM_HARGREAVES)) \
  X(rolling_aihara, 3, "W U G", "Aihara 1987: alpha0 F/(Re l phi_T)", ROLLING(AIHARA)) \
  X(rolling_matsuyama, 3, "W U G", "Matsuyama 2004: alpha0 F/(Re l phi_T)", ROLLING(MATSUYAMA)) \
  X(rolling_biboulet_houpert, 3, "W U G", "Biboulet & Houpert 2010: alpha0 F/(Re l phi_T)", ROLLING(BIBOULET_HOUPERT)) \
  X(rolling_line_solution, 3, "W U G", "Numerical solutions of the line contact: alpha0 F/(Re l phi_T)", ROLLING(LINE_SOLUTION)) \
  X(rolling_share, 2, "elastic_over_rigid half_width", "share of rolling resistance about the change of regime", trb_rolling_share(x[0], x[1])) \
  X(profile_crowned, 2, "station radius", "drop of an arc, m", trb_profile_crowned(x[0], x[1])) \
  X(profile_logarithmic, 7, "station length k1 k2 zm load effective_modulus", "logarithmic drop, m", \
    trb_profile_logarithmic(x[0], x[1], x[2], x[3], x[4], x[5], x[6])) \
  X(rolling_meniscus, 1, "height_over_film", "share of rolling resistance that a meniscus leaves", trb_rolling_meniscus(x[0])) \
  X(rolling_supplied, 2, "supply thermal_factor", "rolling resistance with a supply of oil and heat together, over that with heat", \
    trb_rolling_supplied(x[0], x[1])) \
  X(rolling_gap, 1, "radius_over_gap", "Biboulet & Houpert 2010: F/(eta0 u l) of a rigid cylinder at a gap", trb_rolling_gap(x[0])) \
  X(rolling_hysteresis, 3, "loss_factor width radius", "Johnson: elastic hysteresis of a line contact, as a force over the load", \
    trb_rolling_hysteresis(x[0], x[1], x[2])) \
  X(film_line_smallest, 3, "W U G", "Pan & Hamrock 1989: smallest film of a line contact over Re", trb_film_line_smallest(log(x[0]), log(x[1]), log(x[2]))) \
  X(profile_iso, 5, "station scale length straight exponent", "drop of the general form of ISO/TS 16281, m", \
    trb_profile_iso(x[0], x[1], x[2], x[3], x[4])) \
  X(journal_along, 2, "eccentricity_along eccentricity_across", "Short journal bearing with half of its film: force along the velocity over (viscosity radius width^3/clearance^3) and the velocity", \
    trb_journal_short(x[0], x[1]).along) \
  X(journal_across, 2, "eccentricity_along eccentricity_across", "Short journal bearing with half of its film: force across the velocity over (viscosity radius width^3/clearance^3) and the velocity", \
    trb_journal_short(x[0], x[1]).across) \
  X(journal_shear, 5, "viscosity radius width clearance eccentricity", "Petroff: friction torque of a journal's film over the difference of the angular velocities, N m s", \
    trb_journal_shear(x[0], x[1], x[2], x[3], x[4])) \
  X(squeeze_load, 1, "approach", "Film of a cylinder near a plane: load a length over 24 eta u R/h, approach = (V/u) sqrt(2 R/h)", trb_squeeze_film(x[0]).load) \
  X(squeeze_loss, 1, "approach", "Film of a cylinder near a plane: power lost a length by the flow of pressure over 12 eta u^2 sqrt(2 R/h)", \
    trb_squeeze_film(x[0]).loss) \
  X(squeeze_shear, 1, "approach", "Film of a cylinder near a plane: force of sliding a length over eta sqrt(2 R/h) and the sliding speed", \
    trb_squeeze_film(x[0]).shear) \
  X(smooth_max, 3, "value low half_width", "largest of value and low, once differentiable", trb_smooth_max(x[0], x[1], x[2]))

static double elliptic(double m, int second)
{
  double k, e;
  trb_elliptic(m, &k, &e);
  return second ? e : k;
}

#define TRB_LAW_FUNCTION(name, n, arguments, text, expression) \
  static double law_##name(const double *x) { return expression; }
TRB_LAWS(TRB_LAW_FUNCTION)
#undef TRB_LAW_FUNCTION

const trb_law trb_law_table[] = {
#define TRB_LAW_ENTRY(name, n, arguments, text, expression) {#name, n, arguments, text, law_##name},
    TRB_LAWS(TRB_LAW_ENTRY)
#undef TRB_LAW_ENTRY
};
const int trb_n_laws = (int)(sizeof trb_law_table / sizeof trb_law_table[0]);
