/* Cones with a radius at a reference plane: against formulas that go by the apex, brute force, and what a cylinder must give. */
#include "surface/cone.h"

#include "bearing/surfaces.h"
#include "check.h"
#include "rig.h"

static unsigned long long seed = 11;

static trb_vec3 random_vector(double size) { return trb_v(size * rig_random(&seed), size * rig_random(&seed), size * rig_random(&seed)); }

static trb_vec3 random_axis(void)
{
  const trb_vec3 v = random_vector(1.0);
  return trb_norm(v) > 0.1 ? trb_scale(1.0 / trb_norm(v), v) : trb_v(0, 0, 1);
}

/* A vector across an axis. */
static trb_vec3 across(trb_vec3 axis)
{
  const trb_vec3 other = fabs(axis.x) < 0.7 ? trb_v(1, 0, 0) : trb_v(0, 1, 0), v = trb_cross(axis, other);
  return trb_scale(1.0 / trb_norm(v), v);
}

/* A point in the axial plane: distance e from the axis, z along it. */
static trb_vec3 at(trb_vec3 axis, double e, double z) { return trb_axpy(trb_scale(z, axis), e, across(axis)); }

/* Distance of (e, z) from the line that generates the cone, by golden section along it. */
static double nearest_on_line(const trb_cone *c, double e, double z)
{
  const double golden = 0.5 * (sqrt(5.0) - 1.0);
  double       low = -1.0, high = 1.0;
  for (int i = 0; i < 100; i++) {
    const double one = high - golden * (high - low), two = low + golden * (high - low);
    const double a = hypot(trb_cone_radius(c, one) - e, one - z), b = hypot(trb_cone_radius(c, two) - e, two - z);
    if (a < b) high = two;
    else low = one;
  }
  return hypot(trb_cone_radius(c, low) - e, low - z);
}

static void check_cone(double angle, double side)
{
  const trb_cone c = trb_cone_of(0.01, 0.04, angle, side);
  const double   h = 1e-6;
  for (int i = 0; i < 300; i++) {
    const trb_vec3      axis = random_axis(), centre = random_vector(0.1);
    const trb_vec3      point = trb_axpy(centre, c.place, axis);
    const double        z = fmin(0.02, 0.02 / fabs(tan(angle))) * rig_random(&seed), e = trb_cone_radius(&c, z) + 0.01 * rig_random(&seed);
    const trb_vec3      from = at(axis, e, z);
    const trb_cone_foot foot = trb_cone_at(&c, axis, from);
    CHECK_NEAR(trb_norm(trb_sub(trb_cone_point(&c, centre, axis), point)), 0.0, 1e-17);
    CHECK_NEAR(fabs(foot.beyond), nearest_on_line(&c, e, z), 2e-9);
    CHECK(foot.beyond * side * (e - trb_cone_radius(&c, z)) >= 0.0);
    CHECK_NEAR(trb_norm(foot.normal), 1.0, 1e-14);
    /* the normal is the gradient; the foot of the perpendicular lies on the surface */
    const trb_vec3 step = random_axis();
    const double   rise = trb_cone_at(&c, axis, trb_axpy(from, h, step)).beyond - trb_cone_at(&c, axis, trb_axpy(from, -h, step)).beyond;
    CHECK_NEAR(rise / (2.0 * h), trb_dot(foot.normal, step), 1e-8);
    CHECK_NEAR(trb_cone_at(&c, axis, trb_axpy(from, -foot.beyond, foot.normal)).beyond, 0.0, 5e-17);
    /* by the apex */
    if (fabs(angle) > 1e-3) {
      const double apex = z + c.radius / tan(angle);
      CHECK_NEAR(foot.beyond, side * (e * cos(angle) - apex * sin(angle)), 3e-16 * fabs(apex) + 5e-17);
    }
    if (angle == 0.0) {
      CHECK_NEAR(foot.beyond, side * (e - 0.04), 1e-16);
      CHECK_NEAR(trb_dot(foot.normal, axis), 0.0, 1e-15);
    }
  }
}

/* What a small angle does to a cylinder is the angle times the distance from the reference plane, to first order. */
static void test_small_angles(void)
{
  const trb_cone cylinder = trb_cone_of(0.0, 0.04, 0.0, 1.0);
  const trb_vec3 axis = trb_v(0, 0, 1);
  for (double angle = 1e-2; angle > 1e-13; angle *= 0.1) {
    const trb_cone      cone = trb_cone_of(0.0, 0.04, angle, 1.0);
    const trb_vec3      from = at(axis, 0.0401, 0.009);
    const trb_cone_foot one = trb_cone_at(&cylinder, axis, from), other = trb_cone_at(&cone, axis, from);
    CHECK_NEAR(other.beyond - one.beyond, -0.009 * angle, 1e-4 * angle * angle + 2e-17);
    CHECK_NEAR(trb_norm(trb_sub(other.normal, one.normal)), angle, angle * angle + 1e-15);
  }
}

/* On the axis the direction is undefined, but everything stays finite. */
static void test_axis(void)
{
  const trb_cone      c = trb_cone_of(0.0, 0.04, 0.2, 1.0);
  const trb_cone_foot foot = trb_cone_at(&c, trb_v(0, 0, 1), trb_v(0, 0, 0.01));
  CHECK_NEAR(foot.beyond, -0.04 * cos(0.2) - 0.01 * sin(0.2), 2e-9);
  CHECK(isfinite(foot.normal.x) && isfinite(foot.normal.y) && isfinite(foot.normal.z));
}

/* The surfaces of the rig's bearing meet where its geometry says: the nominal roller touches both raceways all along its flank, its large end
 * the rib at the nominal contact. */
static void test_of_a_bearing(void)
{
  const trb_params p = rig_params();
  trb_geometry     g;
  trb_surfaces     s;
  const trb_vec3   k = trb_v(0, 0, 1), none = trb_v(0, 0, 0);
  CHECK(trb_geometry_derive(&p, &g, NULL) == TRB_OK);
  trb_surfaces_build(&p, &g, &s);
  const trb_vec3 axis = trb_v(sin(g.roller_axis_angle), 0, cos(g.roller_axis_angle));
  const trb_vec3 x = trb_axpy(trb_v(0.5 * p.bearing.pitch_diameter, 0, g.centre_plane), g.roller_mass_offset, axis);
  const trb_vec3 inner = trb_v(0, 0, g.centre_plane), ring[TRB_N_RACES] = {none, inner};
  for (int i = -10; i <= 10; i++) {
    const double     station = 0.05 * i * p.roller.effective_length;
    const trb_sphere node = trb_sphere_inscribed(&s.flank, station, trb_cone_radius(&s.flank, station));
    const trb_vec3   centre = trb_axpy(x, node.place, axis);
    CHECK_RELATIVE(trb_cone_radius(&s.flank, station), (g.apex_to_mid + station) * tan(g.roller_half_angle), 1e-13);
    for (int race = 0; race < TRB_N_RACES; race++)
      CHECK_NEAR(trb_cone_at(&s.race[race], k, trb_sub(centre, trb_cone_point(&s.race[race], ring[race], k))).beyond, -node.radius, 1e-16);
  }
  /* raceways through the apex */
  CHECK_RELATIVE(s.race[TRB_RACE_OUTER].radius, g.centre_plane * tan(p.bearing.cup_half_angle), 1e-13);
  CHECK_RELATIVE(s.race[TRB_RACE_INNER].radius, g.centre_plane * tan(g.cone_half_angle), 1e-13);
  trb_rib_place rib;
  CHECK(trb_place_rib(&p, &g, TRB_RACE_INNER, TRB_END_LARGE, &rib, NULL) == TRB_OK);
  const trb_cone      face = trb_rib_face(&rib, TRB_END_LARGE);
  const trb_vec3      end = trb_axpy(x, s.end[TRB_END_LARGE].place, axis), from = trb_sub(end, trb_cone_point(&face, inner, k));
  const trb_cone_foot foot = trb_cone_at(&face, k, from);
  const trb_vec3      contact = trb_axpy(end, s.end[TRB_END_LARGE].radius, foot.normal);
  CHECK_NEAR(foot.beyond, -s.end[TRB_END_LARGE].radius, 1e-16);
  CHECK_NEAR(contact.x, g.rib_contact_radius, 1e-15);
  CHECK_NEAR(contact.z, g.rib_contact_z, 1e-15);
  CHECK_NEAR(-trb_cone_at(&s.race[TRB_RACE_INNER], k, trb_sub(contact, inner)).beyond, p.rib.contact_height, 2e-15);
  /* the front rib's edges lie on a plane across the nominal roller's axis, at their heights above the raceway */
  for (int i = 0; i < 2; i++) {
    const trb_vec3 edge = trb_add(inner, trb_v(s.front_rib[i].radius, 0, s.front_rib[i].place));
    CHECK_NEAR(trb_dot(trb_sub(edge, trb_axpy(x, s.small_end, axis)), axis), -p.rib.front_clearance, 1e-16);
    CHECK_NEAR(-trb_cone_at(&s.race[TRB_RACE_INNER], k, trb_sub(edge, inner)).beyond, i == 0 ? p.rib.front_low : p.rib.front_high, 1e-16);
  }
}

/* As the cup's angle goes to zero, the raceways go over into those of a cylindrical roller bearing. */
static void test_towards_a_cylinder(void)
{
  trb_params   p = rig_params();
  trb_geometry g;
  const double outer = 0.5 * (p.bearing.pitch_diameter + p.roller.diameter), inner = 0.5 * (p.bearing.pitch_diameter - p.roller.diameter);
  for (double angle = 1e-2; angle > 1e-10; angle *= 0.1) {
    p.bearing.cup_half_angle = angle;
    CHECK(trb_geometry_derive(&p, &g, NULL) == TRB_OK);
    const trb_cone cup = trb_raceway_cone(&p, &g, TRB_RACE_OUTER, 0.0), cone = trb_raceway_cone(&p, &g, TRB_RACE_INNER, 0.0);
    const double   bound = 2.0 * angle * angle + 1e-15;
    CHECK_RELATIVE(cup.radius, outer, bound);
    CHECK_RELATIVE(cone.radius, inner, bound);
    CHECK_RELATIVE(g.large_end_diameter, p.roller.diameter, 2.0 * angle);
    CHECK_RELATIVE(g.outer_equivalent_radius, 1.0 / (2.0 / p.roller.diameter - 1.0 / outer), bound);
    CHECK_RELATIVE(g.inner_equivalent_radius, 1.0 / (2.0 / p.roller.diameter + 1.0 / inner), bound);
    CHECK_RELATIVE(g.cage_speed_ratio, inner / p.bearing.pitch_diameter, bound);
    CHECK_RELATIVE(g.roller_spin_ratio, 2.0 * inner * outer / (p.bearing.pitch_diameter * p.roller.diameter), bound);
    CHECK_RELATIVE(g.roller_mass, p.roller.density * 0.25 * TRB_PI * p.roller.diameter * p.roller.diameter * p.roller.total_length, bound);
    CHECK_NEAR(g.roller_mass_offset, 0.0, angle * p.roller.total_length);
  }
}

int main(void)
{
  const double angles[] = {0.0, 1e-9, 1e-3, 0.03, 0.2, 0.8, -0.3, -1.2};
  for (int i = 0; i < (int)(sizeof angles / sizeof angles[0]); i++) {
    check_cone(angles[i], 1.0);
    check_cone(angles[i], -1.0);
  }
  test_small_angles();
  test_axis();
  test_of_a_bearing();
  test_towards_a_cylinder();
  return check_report();
}
