/* Derived geometry of the rig; what does not fit together. */
#include "bearing/geometry.h"

#include "bearing/surfaces.h"

#include "check.h"
#include "rig.h"

static void test_rig(void)
{
  const trb_params p = rig_params();
  trb_geometry     g;
  const double     degree = TRB_PI / 180.0;
  CHECK(trb_geometry_derive(&p, &g, NULL) == TRB_OK);
  CHECK_NEAR(g.roller_half_angle / degree, 1.8707, 0.5e-4);
  CHECK_NEAR(g.roller_axis_angle / degree, 11.0820, 0.5e-4);
  CHECK_NEAR(g.cone_half_angle / degree, 9.2113, 0.5e-4);
  CHECK_NEAR(g.apex_to_mid, 214.315e-3, 0.5e-6);
  CHECK_NEAR(g.outer_race_radius, 48.064e-3, 0.5e-6);
  CHECK_NEAR(g.inner_race_radius, 34.325e-3, 0.5e-6);
  CHECK_NEAR(g.outer_equivalent_radius, 8.163e-3, 0.5e-6);
  CHECK_NEAR(g.inner_equivalent_radius, 5.830e-3, 0.5e-6);
  CHECK_NEAR(g.roller_mass, 25.0e-3, 0.5e-4);
  CHECK_NEAR(g.roller_mass_offset, 0.336e-3, 0.5e-6);
  CHECK_NEAR(g.rib_rx, 1.761, 0.5e-3);
  CHECK_NEAR(g.cage_speed_ratio, 0.41662, 0.5e-5);
  CHECK_NEAR(g.roller_spin_ratio, 2.8606, 0.5e-4);
  /* the frustum: exact formulas */
  const double a = 0.5 * p.roller.total_length, r1 = tan(g.roller_half_angle) * (g.apex_to_mid - a),
               r2 = tan(g.roller_half_angle) * (g.apex_to_mid + a);
  CHECK_RELATIVE(g.roller_mass, p.roller.density * TRB_PI / 3.0 * p.roller.total_length * (r1 * r1 + r1 * r2 + r2 * r2), 1e-13);
  CHECK_RELATIVE(g.roller_inertia_axial, 0.3 * g.roller_mass * (pow(r2, 5) - pow(r1, 5)) / (pow(r2, 3) - pow(r1, 3)), 1e-12);
  CHECK_RELATIVE(g.small_end_radius, r1, 1e-14);
}

/* Two raceway points where roller and races touch roll without sliding at the derived speeds. */
static void test_rolling(void)
{
  const trb_params p = rig_params();
  trb_geometry     g;
  CHECK(trb_geometry_derive(&p, &g, NULL) == TRB_OK);
  const double orbit = g.cage_speed_ratio, spin = g.roller_spin_ratio, radius = 0.5 * p.roller.diameter;
  /* in the cage's frame the races turn by -orbit and 1 - orbit, the roller by spin */
  CHECK_RELATIVE(spin * radius * cos(g.roller_half_angle) / cos(g.roller_half_angle), orbit * g.outer_race_radius, 1e-12);
  CHECK_RELATIVE(spin * radius, (1.0 - orbit) * g.inner_race_radius, 1e-12);
}

static void fails(trb_params p, const char *says)
{
  trb_geometry g;
  trb_message  message = {TRB_OK, ""};
  CHECK(trb_geometry_derive(&p, &g, &message) == TRB_ERR_GEOMETRY);
  CHECK(message.status == TRB_ERR_GEOMETRY);
  CHECK_SAYS(message.text, says);
  CHECK(trb_geometry_derive(&p, &g, NULL) == TRB_ERR_GEOMETRY);
}

static void test_what_does_not_fit(void)
{
  trb_params p = rig_params();
  p.roller.diameter = 0.09, p.bearing.pitch_diameter = 0.08;
  fails(p, "cup_half_angle");
  p = rig_params();
  p.roller.total_length = 19e-3;
  fails(p, "total_length");
  p = rig_params();
  p.roller.total_length = 0.5;
  fails(p, "beyond the apex");
  p = rig_params();
  p.bearing.n_rollers = 19;
  fails(p, "n_rollers = 19: rollers of 0.014 m overlap");
  p = rig_params();
  p.bearing.cup_half_angle = 0.5, p.rib.contact_height = 0.0149, p.roller.sphere_ratio = 0.05;
  fails(p, "does not touch the rib there");
  p = rig_params();
  p.roller.sphere_ratio = 0.05;
  fails(p, "rib_contact_height");
}

/* Geometry and surfaces do not read what is not the bearing's own: oil and effects are not even numbers here. */
static void test_without_oil(void)
{
  const trb_params given = rig_params();
  trb_params       p = given;
  trb_geometry     g, bare;
  trb_surfaces     s, of_bare;
  for (double *value = &p.oil.viscosity; value < (double *)(&p + 1); value++) *value = NAN;
  CHECK(isfinite(p.cage.mass) && isnan(p.effects.oil_fill) && isnan(p.effects.front_rib) && isnan(p.oil.temperature));
  memset(&s, 0, sizeof s), memset(&of_bare, 0, sizeof of_bare);
  CHECK(trb_geometry_derive(&given, &g, NULL) == TRB_OK && trb_geometry_derive(&p, &bare, NULL) == TRB_OK);
  trb_surfaces_build(&given, &g, &s);
  trb_surfaces_build(&p, &bare, &of_bare);
  CHECK(memcmp(&g, &bare, sizeof g) == 0 && memcmp(&s, &of_bare, sizeof s) == 0);
}

static void test_table(void)
{
  CHECK(TRB_N_GEOMETRY == (int)(sizeof trb_geometry_table / sizeof trb_geometry_table[0]));
  for (int i = 0; i < TRB_N_GEOMETRY; i++) CHECK(trb_geometry_table[i].name[0] != '\0' && trb_geometry_table[i].text[0] != '\0');
}

int main(void)
{
  test_rig();
  test_rolling();
  test_what_does_not_fit();
  test_without_oil();
  test_table();
  return check_report();
}
