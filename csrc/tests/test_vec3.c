/* Vectors and frames. */
#include "base/vec3.h"

#include "check.h"
#include "rig.h"

static unsigned long long seed = 1;

static trb_vec3 any(void) { return trb_v(rig_random(&seed), rig_random(&seed), rig_random(&seed)); }

static void check_same(trb_vec3 a, trb_vec3 b, double tolerance)
{
  CHECK_NEAR(a.x, b.x, tolerance);
  CHECK_NEAR(a.y, b.y, tolerance);
  CHECK_NEAR(a.z, b.z, tolerance);
}

static void check_frame(const trb_frame *f)
{
  CHECK_NEAR(trb_norm(f->n), 1.0, 1e-15);
  CHECK_NEAR(trb_norm(f->t), 1.0, 1e-15);
  CHECK_NEAR(trb_norm(f->a), 1.0, 1e-15);
  CHECK_NEAR(trb_dot(f->n, f->t), 0.0, 1e-15);
  CHECK_NEAR(trb_dot(f->t, f->a), 0.0, 1e-15);
  CHECK_NEAR(trb_dot(f->a, f->n), 0.0, 1e-15);
  check_same(trb_cross(f->n, f->t), f->a, 1e-15);
}

static void test_vectors(void)
{
  for (int i = 0; i < 100; i++) {
    const trb_vec3 u = any(), v = any(), w = any();
    const double   s = rig_random(&seed), angle = 4.0 * rig_random(&seed);
    check_same(trb_add(trb_sub(u, v), v), u, 1e-15);
    check_same(trb_axpy(u, s, v), trb_add(u, trb_scale(s, v)), 1e-15);
    CHECK_NEAR(trb_dot(trb_cross(u, v), u), 0.0, 1e-15);
    /* Lagrange's identity and the triple product */
    CHECK_NEAR(trb_dot(trb_cross(u, v), trb_cross(u, v)), trb_dot(u, u) * trb_dot(v, v) - trb_dot(u, v) * trb_dot(u, v), 1e-14);
    check_same(trb_cross(u, trb_cross(v, w)), trb_sub(trb_scale(trb_dot(u, w), v), trb_scale(trb_dot(u, v), w)), 1e-14);
    const trb_vec3 turned = trb_turn_z(u, cos(angle), sin(angle));
    CHECK_NEAR(trb_norm(turned), trb_norm(u), 1e-15);
    CHECK_NEAR(turned.z, u.z, 0.0);
    check_same(trb_turn_z(turned, cos(angle), -sin(angle)), u, 1e-15);
  }
  check_same(trb_cross(trb_v(1, 0, 0), trb_v(0, 1, 0)), trb_v(0, 0, 1), 0.0);
  check_same(trb_turn_z(trb_v(1, 0, 0), 0.0, 1.0), trb_v(0, 1, 0), 0.0);
}

/* Angles are as exact as the library's on both sides of the place where the series ends, and so are their sums. */
static void test_angles(void)
{
  for (int i = 0; i < 2000; i++) {
    const double    angle = (i % 2 == 0 ? 0.26 : 4.0) * rig_random(&seed), other = 3.0 * rig_random(&seed);
    const trb_angle found = trb_angle_of(angle), sum = trb_angle_sum(found, trb_angle_of(other));
    CHECK_NEAR(found.cosine, cos(angle), 2.3e-16);
    CHECK_NEAR(found.sine, sin(angle), 2.3e-16 * fabs(angle));
    CHECK_NEAR(sum.cosine, cos(angle + other), 1e-15);
    CHECK_NEAR(sum.sine, sin(angle + other), 1e-15);
  }
  const trb_angle none = trb_angle_of(0.0), small = trb_angle_of(1e-200);
  CHECK(none.cosine == 1.0 && none.sine == 0.0 && small.cosine == 1.0 && small.sine == 1e-200);
  CHECK(!isfinite(trb_angle_of(NAN).sine));
}

static void test_tilted_frame(void)
{
  const trb_frame still = trb_tilted_frame(0.0, 0.0);
  check_same(still.n, trb_v(1, 0, 0), 0.0);
  check_same(still.t, trb_v(0, 1, 0), 0.0);
  check_same(still.a, trb_v(0, 0, 1), 0.0);
  for (int i = 0; i < 200; i++) {
    const double    skew = 1.5 * rig_random(&seed), tilt = 3.0 * rig_random(&seed);
    const trb_frame f = trb_tilted_frame(skew, tilt);
    check_frame(&f);
    check_same(f.a, trb_v(sin(tilt) * cos(skew), sin(skew), cos(tilt) * cos(skew)), 1e-15);
    /* R_y(tilt) R_x(-skew), a column at a time: first about x, then about y */
    const trb_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, found[3] = {f.n, f.t, f.a};
    for (int k = 0; k < 3; k++) {
      const trb_vec3 e = axes[k];
      const trb_vec3 x = trb_v(e.x, cos(skew) * e.y + sin(skew) * e.z, -sin(skew) * e.y + cos(skew) * e.z);
      check_same(found[k], trb_v(cos(tilt) * x.x + sin(tilt) * x.z, x.y, -sin(tilt) * x.x + cos(tilt) * x.z), 1e-15);
    }
  }
}

static void test_coordinates(void)
{
  for (int i = 0; i < 100; i++) {
    const trb_frame f = trb_tilted_frame(rig_random(&seed), rig_random(&seed)), g = trb_tilted_frame(rig_random(&seed), rig_random(&seed));
    const trb_frame both = trb_compose(&f, &g);
    const trb_vec3  v = any();
    check_same(trb_to_frame(&f, trb_from_frame(&f, v)), v, 1e-15);
    check_same(trb_from_frame(&f, trb_v(0, 0, 1)), f.a, 1e-15);
    check_frame(&both);
    check_same(trb_from_frame(&both, v), trb_from_frame(&f, trb_from_frame(&g, v)), 1e-15);
  }
}

int main(void)
{
  test_vectors();
  test_angles();
  test_tilted_frame();
  test_coordinates();
  return check_report();
}
