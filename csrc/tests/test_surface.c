/* Spheres, bounded faces, circles and lands: against brute force, and continuity at edges and corners. */
#include "surface/circle.h"
#include "surface/land.h"
#include "surface/sphere.h"

#include "check.h"
#include "rig.h"

static unsigned long long seed = 5;

static trb_vec3 random_vector(double size) { return trb_v(size * rig_random(&seed), size * rig_random(&seed), size * rig_random(&seed)); }

static trb_frame random_frame(void) { return trb_tilted_frame(3.0 * rig_random(&seed), 1.5 * rig_random(&seed)); }

/* A sphere that touches a flank from within lies wholly inside of it, and touches it where it should. */
static void test_inscribed(void)
{
  const double angles[] = {0.0, 1e-6, 0.03, 0.2};
  for (int i = 0; i < 4; i++) {
    const trb_cone   flank = trb_cone_of(-0.3e-3, 7e-3, angles[i], -1.0);
    const double     station = 4e-3, radius = trb_cone_radius(&flank, station);
    const trb_sphere s = trb_sphere_inscribed(&flank, station, radius);
    double           least = INFINITY, where = 0.0;
    for (int k = -4000; k <= 4000; k++) {
      const double z = station + 1e-6 * k, gap = hypot(flank.place + z - s.place, trb_cone_radius(&flank, z)) - s.radius;
      if (gap < least) least = gap, where = z;
    }
    CHECK_NEAR(least, 0.0, 1e-15);
    CHECK_NEAR(where, station, 1.1e-6);
    if (angles[i] == 0.0) CHECK(s.radius == 7e-3 && s.place == flank.place + station);
  }
}

static trb_polygon random_face(void)
{
  const trb_frame f = random_frame();
  trb_polygon     p = {.origin = random_vector(0.1), .u = f.n, .v = f.t, .normal = f.a, .n = 3 + (int)(4.5 * (1.0 + rig_random(&seed)))};
  for (int i = 0; i < p.n; i++) {
    const double angle = 2.0 * TRB_PI * (i + 0.3 * rig_random(&seed)) / p.n;
    p.outline[2 * i] = 9e-3 * cos(angle), p.outline[2 * i + 1] = 2e-3 * sin(angle);
  }
  return p;
}

/* Least distance from points of the face: a fan of triangles from its first vertex, each with a grid of its own. */
static double brute(const trb_polygon *p, trb_vec3 from)
{
  enum { GRID = 120 };
  double         best = INFINITY;
  const trb_vec3 a = trb_polygon_vertex(p, 0);
  for (int k = 1; k + 1 < p->n; k++) {
    const trb_vec3 b = trb_sub(trb_polygon_vertex(p, k), a), c = trb_sub(trb_polygon_vertex(p, k + 1), a);
    for (int i = 0; i <= GRID; i++)
      for (int j = 0; i + j <= GRID; j++)
        best = fmin(best, trb_norm(trb_sub(trb_axpy(trb_axpy(a, (double)i / GRID, b), (double)j / GRID, c), from)));
  }
  return best;
}

static void test_faces(void)
{
  int inside = 0, outside = 0;
  for (int i = 0; i < 60; i++) {
    const trb_polygon p = random_face();
    for (int k = 0; k < 6; k++) {
      const double   h = 0.5e-3 + 3e-3 * fabs(rig_random(&seed)), radius = 5e-3;
      const trb_vec3 c = trb_axpy(trb_axpy(trb_axpy(p.origin, 12e-3 * rig_random(&seed), p.u), 3e-3 * rig_random(&seed), p.v), h, p.normal);
      trb_vec3       normal, flat;
      const double   d = trb_sphere_on_polygon(&p, c, trb_polygon_height(&p, c), radius, &normal), nearest = brute(&p, c);
      CHECK_NEAR(trb_polygon_height(&p, c), h, 1e-15);
      CHECK_NEAR(trb_norm(normal), 1.0, 1e-13);
      /* a point of the grid is no nearer than the nearest, and not much further */
      CHECK(radius - d <= nearest + 1e-15 && nearest <= radius - d + 2e-4);
      CHECK_NEAR(trb_sphere_on_plane(p.normal, h, radius, &flat), radius - h, 0.0);
      CHECK(d <= radius - h + 1e-15 && trb_norm(trb_add(flat, p.normal)) == 0.0);
      *(radius - d > h + 1e-12 ? &outside : &inside) += 1;
      /* minus the normal is the gradient of the distance */
      const trb_vec3 step = random_vector(1.0);
      const double   e = 1e-8, size = trb_norm(step);
      trb_vec3       other;
      const trb_vec3 up = trb_axpy(c, e / size, step), down = trb_axpy(c, -e / size, step);
      const double   slope = (trb_sphere_on_polygon(&p, up, trb_polygon_height(&p, up), radius, &other) -
                              trb_sphere_on_polygon(&p, down, trb_polygon_height(&p, down), radius, &other)) /
                             (2.0 * e);
      CHECK_NEAR(slope, trb_dot(normal, step) / size, 1e-5);
    }
  }
  CHECK(inside > 30 && outside > 30);
}

/* Along a way from the inside over an edge, and over a corner, distance and normal change by no more than the way allows. */
static void test_edges(void)
{
  const trb_polygon p = {
      .origin = {0, 0, 0}, .u = {1, 0, 0}, .v = {0, 1, 0}, .normal = {0, 0, 1}, .n = 4, .outline = {-2, -1, 2, -1, 2, 1, -2, 1}};
  const trb_vec3 starts[] = {{1, 0.3, 0.5}, {1, 0.5, 0.5}, {3, 0.3, 0.5}}, ways[] = {{2, 0, 0}, {2, 1, 0}, {0, 1.4, 0}};
  for (int w = 0; w < 3; w++) {
    trb_vec3 before = {0, 0, 0}, normal;
    double   last = 0.0;
    for (int i = 0; i <= 4000; i++) {
      const trb_vec3 c = trb_axpy(starts[w], i / 4000.0, ways[w]);
      const double   d = trb_sphere_on_polygon(&p, c, c.z, 1.0, &normal), step = trb_norm(ways[w]) / 4000.0;
      if (i > 0) CHECK(fabs(d - last) <= step * (1.0 + 1e-9) && trb_norm(trb_sub(normal, before)) <= 2.0 * step / 0.5);
      before = normal, last = d;
    }
  }
  trb_vec3     normal;
  const double d = trb_sphere_on_polygon(&p, trb_v(5, 5, 0), 0.0, 1.0, &normal);
  CHECK_NEAR(d, 1.0 - 5.0, 1e-15);
  CHECK_NEAR(trb_norm(trb_sub(normal, trb_v(-0.6, -0.8, 0))), 0.0, 1e-15);
  /* in the face itself there is no direction, but nothing is infinite */
  CHECK(trb_sphere_on_polygon(&p, trb_v(0, 0, 0), 0.0, 1.0, &normal) == 1.0 && trb_norm(normal) == 0.0);
}

/* The deepest of many points of a circle. */
static void test_circle(void)
{
  for (int i = 0; i < 200; i++) {
    const trb_frame          f = random_frame(), g = random_frame();
    const trb_vec3           centre = random_vector(0.1), beyond = random_vector(0.1);
    const double             radius = 0.04;
    const trb_circle_meeting c = trb_circle_on_plane(centre, f.a, radius, beyond, g.a);
    double                   deepest = -INFINITY;
    for (int k = 0; k < 3600; k++) {
      const double   angle = TRB_PI * k / 1800.0;
      const trb_vec3 point = trb_axpy(trb_axpy(centre, radius * cos(angle), f.n), radius * sin(angle), f.t);
      deepest = fmax(deepest, trb_dot(trb_sub(point, beyond), g.a));
    }
    const trb_vec3 point = trb_circle_deepest(&c, radius);
    CHECK_NEAR(c.depth, deepest, 1e-7);
    CHECK(c.depth >= deepest - 1e-16);
    CHECK_NEAR(c.lean, trb_norm(trb_cross(f.a, g.a)), 1e-15);
    CHECK_NEAR(trb_dot(trb_sub(point, beyond), g.a), c.depth, 1e-15);
    CHECK_NEAR(trb_norm(trb_sub(point, centre)), radius, 1e-15);
    CHECK_NEAR(trb_dot(trb_sub(point, centre), f.a), 0.0, 1e-15);
  }
}

/* The nearest point of a land is where the line from its axis through the strip's point, or away from it, meets it. */
static void test_land(void)
{
  for (int i = 0; i < 200; i++) {
    const trb_frame      f = random_frame();
    const trb_vec3       centre = random_vector(0.1);
    const double         u = 1e-4 * rig_random(&seed), v = 1e-4 * rig_random(&seed), along = 0.01 * rig_random(&seed), radius = 0.03;
    const trb_vec3       axis = trb_axpy(centre, along, f.a), x = trb_axpy(trb_axpy(axis, u, f.n), v, f.t);
    const trb_land_strip s = trb_land_strip_at(x, centre, f.a);
    const trb_vec3       normal = trb_scale(1.0 / s.size, s.apart);
    CHECK_NEAR(s.size, hypot(u, v), 1e-16);
    CHECK_NEAR(trb_dot(s.apart, f.a), 0.0, 1e-16);
    for (int inside = 0; inside < 2; inside++) {
      /* of a guiding surface with the clearance c: its point there comes nearest to the land */
      const double   c = 2e-4, own = inside ? radius - c : radius + c;
      const trb_vec3 point = trb_land_nearest(&s, normal, radius, inside);
      double         least = INFINITY;
      CHECK_NEAR(trb_norm(trb_sub(point, axis)), radius, 1e-15);
      for (int k = 0; k < 3600; k++) {
        const double   angle = TRB_PI * k / 1800.0;
        const trb_vec3 surface = trb_axpy(trb_axpy(x, own * cos(angle), f.n), own * sin(angle), f.t);
        const double   off = trb_norm(trb_sub(surface, axis));
        least = fmin(least, inside ? radius - off : off - radius);
      }
      const double gap = c - s.size, guide = trb_norm(trb_sub(point, x));
      CHECK_NEAR(least, gap, 1e-9);
      CHECK_NEAR(inside ? guide - own : own - guide, gap, 1e-15);
    }
  }
}

int main(void)
{
  test_inscribed();
  test_faces();
  test_edges();
  test_circle();
  test_land();
  return check_report();
}
