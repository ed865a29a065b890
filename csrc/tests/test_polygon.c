/* The nearest point of a bounded convex polygon. */
#include "surface/polygon.h"

#include "check.h"
#include "rig.h"

static unsigned long long seed = 7;

/* Distance to the outline and whether a point is inside, from triangles and segments alone. */
static double brute(const double *v, int n, double u, double w)
{
  double best = INFINITY;
  int    inside = 0;
  for (int i = 1; i + 1 < n; i++) {
    const double *a = v, *b = v + 2 * i, *c = v + 2 * (i + 1);
    const double  area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const double  s = ((u - a[0]) * (c[1] - a[1]) - (w - a[1]) * (c[0] - a[0])) / area,
                  t = ((b[0] - a[0]) * (w - a[1]) - (b[1] - a[1]) * (u - a[0])) / area;
    inside |= s >= 0.0 && t >= 0.0 && s + t <= 1.0;
  }
  if (inside) return 0.0;
  for (int i = 0; i < n; i++) {
    const double *a = v + 2 * i, *b = v + 2 * ((i + 1) % n);
    double        low = 0.0, high = 1.0;
    /* ternary search: the distance along a segment is convex */
    for (int k = 0; k < 120; k++) {
      const double one = low + (high - low) / 3.0, two = high - (high - low) / 3.0;
      const double du = a[0] + one * (b[0] - a[0]) - u, dv = a[1] + one * (b[1] - a[1]) - w;
      const double eu = a[0] + two * (b[0] - a[0]) - u, ev = a[1] + two * (b[1] - a[1]) - w;
      if (du * du + dv * dv < eu * eu + ev * ev) high = two;
      else low = one;
    }
    best = trb_min(best, hypot(a[0] + low * (b[0] - a[0]) - u, a[1] + low * (b[1] - a[1]) - w));
  }
  return best;
}

static void check_polygon(const double *v, int n, double size)
{
  int    inside = 0, beside = 0;
  double nu, nv, mu, mv;
  for (int i = 0; i < 2000; i++) {
    const double u = 1.6 * size * rig_random(&seed), w = 1.6 * size * rig_random(&seed), d = brute(v, n, u, w);
    trb_nearest_in_polygon(v, n, u, w, &nu, &nv);
    CHECK_NEAR(hypot(u - nu, w - nv), d, 3e-8 * size);
    CHECK_NEAR(brute(v, n, nu, nv), 0.0, 3e-8 * size);
    if (d == 0.0) CHECK(nu == u && nv == w), inside++;
    else beside++;
    /* a projection on a convex set brings no two points further apart */
    const double e = 0.01 * size * rig_random(&seed), f = 0.01 * size * rig_random(&seed);
    trb_nearest_in_polygon(v, n, u + e, w + f, &mu, &mv);
    CHECK(hypot(mu - nu, mv - nv) <= hypot(e, f) * (1.0 + 1e-9) + 1e-15 * size);
  }
  CHECK(inside > 20 && beside > 20);
  for (int i = 0; i < n; i++) {
    trb_nearest_in_polygon(v, n, v[2 * i], v[2 * i + 1], &nu, &nv);
    CHECK_NEAR(hypot(nu - v[2 * i], nv - v[2 * i + 1]), 0.0, 1e-15 * size);
  }
}

static void test_rectangle(void)
{
  const double v[8] = {-2, -1, 2, -1, 2, 1, -2, 1};
  double       u, w;
  trb_nearest_in_polygon(v, 4, 5.0, 0.5, &u, &w);
  CHECK(u == 2.0 && w == 0.5);
  trb_nearest_in_polygon(v, 4, 5.0, 7.0, &u, &w);
  CHECK(u == 2.0 && w == 1.0);
  trb_nearest_in_polygon(v, 4, -0.3, 0.2, &u, &w);
  CHECK(u == -0.3 && w == 0.2);
  check_polygon(v, 4, 2.0);
}

static void test_many(void)
{
  for (int n = 3; n <= TRB_MAX_VERTICES; n++) {
    double v[2 * TRB_MAX_VERTICES];
    for (int i = 0; i < n; i++) {
      const double angle = 2.0 * TRB_PI * (i + 0.3 * rig_random(&seed)) / n;
      v[2 * i] = 9.9e-3 * cos(angle), v[2 * i + 1] = 1.5e-3 * sin(angle);
    }
    check_polygon(v, n, 9.9e-3);
  }
}

int main(void)
{
  test_rectangle();
  test_many();
  return check_report();
}
