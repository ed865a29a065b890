/* The laws as the kernels inline them. Their check values are those of the Python tests; here: forms, limits, tables. */
#include "laws/film.h"
#include "laws/hertz.h"
#include "laws/line_contact.h"
#include "laws/profile.h"
#include "laws/rolling_resistance.h"
#include "laws/table.h"
#include "laws/traction.h"
#include "laws/viscosity.h"

#include "check.h"

static void test_smooth(void)
{
  CHECK_NEAR(trb_smooth_max(3.0, 1.0, 0.5), 3.0, 0.0);
  CHECK_NEAR(trb_smooth_max(-3.0, 1.0, 0.5), 1.0, 0.0);
  CHECK_NEAR(trb_smooth_max(1.0, 1.0, 0.5), 1.125, 0.0);
  CHECK_NEAR(trb_smooth_max(1.5, 1.0, 0.5), 1.5, 1e-15);
  CHECK_NEAR(trb_smooth_max(0.5, 1.0, 0.5), 1.0, 0.0);
  CHECK_NEAR(trb_smooth_step(0.25, 0.0, 1.0), 0.15625, 1e-16);
  CHECK_NEAR(trb_smooth_step(-1.0, 0.0, 1.0), 0.0, 0.0);
  CHECK_NEAR(trb_smooth_step(7.0, 0.0, 1.0), 1.0, 0.0);
  CHECK_NEAR(trb_clamp(5.0, -1.0, 2.0), 2.0, 0.0);
  CHECK_NEAR(trb_clamp(-5.0, -1.0, 2.0), -1.0, 0.0);
}

static void test_line_contact(void)
{
  const double modulus = 226.37e9, length = 0.02, d = 5e-6;
  CHECK_NEAR(exp(trb_line_log_load(log(d), modulus, length)) * length, 3206.56, 0.005);
  /* the energy is the integral of the load: midpoint rule, n cells, error 1/(24 n^2) of the second derivative */
  double    energy = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; i++) energy += exp(trb_line_log_load(log(d * (i + 0.5) / n), modulus, length)) * d / n;
  CHECK_RELATIVE(TRB_PALMGREN_ENERGY * exp(trb_line_log_load(log(d), modulus, length)) * d, energy, 1e-8);
  /* load = pi/2 b pmax; the mean pressure over the width 2 b is pi/4 of the largest */
  const double w = 9.2e4, radius = 8e-3, b = trb_line_half_width(w, radius, modulus), p = trb_line_pressure(w, radius, modulus);
  CHECK_RELATIVE(0.5 * TRB_PI * b * p, w, 1e-14);
  CHECK_RELATIVE(TRB_LINE_MEAN_PRESSURE * p * 2.0 * b, w, 1e-14);
}

static void test_film(void)
{
  const double w = 7e-5, u = 1.644e-10, g = 4460;
  CHECK_RELATIVE(trb_film_line_elastic(log(w), log(u), log(g)), 2.922 * pow(w, -0.166) * pow(u, 0.692) * pow(g, 0.470), 1e-14);
  CHECK_NEAR(trb_film_line_elastic(log(w), log(u), log(g)), 1.259e-4, 0.5e-7);
  CHECK_RELATIVE(trb_film_point_elastic(log(w), log(u), log(g), 0.7), 4.31 * 0.7 * pow(u, 0.68) * pow(g, 0.49) * pow(w, -0.073), 1e-14);
  CHECK_NEAR(trb_film_point_shape(1.0), 1.0 - exp(-1.23), 1e-15);
  CHECK_NEAR(trb_film_point_rigid_factor(1.0), 140.11, 0.005);
  CHECK_NEAR(trb_film_thermal(0.0, -700.0, -700.0, 0.05), 1.0, 1e-15);
  CHECK_NEAR(trb_film_thermal(0.1, 10.0, 0.0, 0.05), 0.05, 0.0);
}

static void test_traction(void)
{
  for (double x = 1e-300; x < 1e150; x *= 3.7) CHECK_RELATIVE(trb_asinh(x), asinh(x), 4e-16 * 4);
  CHECK_NEAR(trb_asinh(0.0), 0.0, 0.0);
  CHECK_NEAR(trb_traction_muraki_kimura(0.0, 5.0), 0.0, 1e-299);
  CHECK_NEAR(trb_traction_muraki_kimura(10, 1), 2.7735, 0.5e-4);
  CHECK_NEAR(trb_traction_muraki_kimura(1, 10), 0.1, 1e-15);
  CHECK_NEAR(trb_friction_boundary(0.0, 0.1, 22.28, 181.46), 0.0, 0.0);
  CHECK_NEAR(trb_friction_boundary(0.02, 0.1, 22.28, 181.46), 0.10917, 0.5e-5);
  CHECK_NEAR(trb_boundary_share(0.5, 0.01, 1.5), 0.09139, 0.5e-5);
  CHECK_NEAR(trb_slide_roll_cage(0.1, 0.05), 0.1 / sqrt(0.0025 + 0.0025), 1e-15);
  CHECK_NEAR(trb_rolling_share(1.0, 0.1), 0.5, 1e-15);
  CHECK_RELATIVE(trb_rolling_line(TRB_ROLLING_ZHOU_HOEPRICH, log(2e-4), log(1e-10), log(3745)) / 3745, 6.57e-8, 1e-3);
}

static void test_viscosity(void)
{
  const double at = 327.79 + 2.9862 * 60, ct = 4.419e-3 + 3.0115e-4 * 60;
  CHECK_NEAR(trb_viscosity_dicke(6e8, at, ct), 6000.0 / (at + ct * 6000.0), 1e-14);
  CHECK_NEAR(trb_viscosity_barus(6e8, 1.97e-8, 25), 11.82, 1e-12);
  CHECK_NEAR(trb_viscosity_barus(6e9, 1.97e-8, 25), 25, 1e-12);
  CHECK_NEAR(trb_viscosity_roelands(0.0, 1.97e-8, log(0.0346), 25), 0.0, 1e-14);
  CHECK_NEAR(trb_shear_modulus(0.5e9, 60, 1e7), 1.2 * 0.5e9 / 3.96 - 1e8, 1e-6);
  CHECK_NEAR(trb_shear_modulus(0.0, 60, 1e7), 1e7, 0.0);
}

static void test_hertz(void)
{
  double k, e, k1, e1;
  for (double m = 0.01; m < 1.0; m += 0.01) {
    trb_elliptic(m, &k, &e);
    trb_elliptic(1.0 - m, &k1, &e1);
    CHECK_NEAR(e * k1 + e1 * k - k * k1, 0.5 * TRB_PI, 1e-14);
  }
  trb_elliptic(0.0, &k, &e);
  CHECK_NEAR(k, 0.5 * TRB_PI, 1e-15);
  CHECK_NEAR(e, 0.5 * TRB_PI, 1e-15);
  /* two radii and the other way round; a sphere on a plane */
  const trb_hertz_point p = trb_hertz_point_constants(1.761, 0.2022, 226e9), q = trb_hertz_point_constants(0.2022, 1.761, 226e9);
  CHECK_NEAR(p.stiffness, q.stiffness, 0.0);
  CHECK_RELATIVE(p.semi_long, p.ellipticity * p.semi_short, 1e-14);
  const trb_hertz_point round = trb_hertz_point_constants(0.01, 0.01, 226e9);
  CHECK_RELATIVE(round.stiffness, 4.0 / 3.0 * 113e9 * sqrt(0.01), 1e-9);
  CHECK_RELATIVE(round.semi_short, cbrt(0.75 * 0.01 / 113e9), 1e-9);
}

/* n Gauss nodes integrate x^p exactly up to p = 2 n - 1; uniform slices integrate a line. */
static void test_quadrature(void)
{
  double node[200], weight[200];
  for (int n = 1; n <= 200; n += n < 20 ? 1 : 36) {
    trb_quadrature(TRB_QUADRATURE_GAUSS, n, node, weight);
    for (int p = 0; p < 2 * n && p < 60; p++) {
      double sum = 0.0;
      for (int i = 0; i < n; i++) sum += weight[i] * pow(node[i], p);
      CHECK_NEAR(sum, p % 2 ? 0.0 : 2.0 / (p + 1.0), 1e-13);
    }
    for (int i = 0; i < n; i++) {
      CHECK(node[i] > -1.0 && node[i] < 1.0 && weight[i] > 0.0 && (i == 0 || node[i] > node[i - 1]));
      CHECK_NEAR(node[i], -node[n - 1 - i], 1e-14);
    }
    trb_quadrature(TRB_QUADRATURE_UNIFORM, n, node, weight);
    double sum = 0.0, moment = 0.0;
    for (int i = 0; i < n; i++) sum += weight[i], moment += weight[i] * node[i];
    CHECK_NEAR(sum, 2.0, 1e-14);
    CHECK_NEAR(moment, 0.0, 1e-14);
  }
}

static void test_profile(void)
{
  const double length = 19.8e-3;
  CHECK_NEAR(trb_profile_crowned(0.01, 10.0), 10.0 - sqrt(100.0 - 1e-4), 1e-14);
  CHECK_NEAR(trb_profile_crowned(0.0, 10.0), 0.0, 0.0);
  CHECK_RELATIVE(trb_profile_logarithmic(0.5 * length, length, 1.5, 0.4, 1e-6, 1833, 226e9), 1e-6, 1e-12);
  CHECK_NEAR(trb_profile_logarithmic(0.29 * length, length, 1.5, 0.4, 10e-6, 1833, 226e9), 0.0, 0.0);
  CHECK_NEAR(trb_profile_logarithmic(0.5 * length, length, 1.5, 0.4, 0.0, 1833, 226e9), 0.0, 0.0);
}

static void test_table(void)
{
  for (int i = 0; i < trb_n_laws; i++) {
    const trb_law *law = &trb_law_table[i];
    int            words = 1;
    for (const char *c = law->arguments; *c; c++) words += *c == ' ';
    CHECK(words == law->n && law->n <= TRB_LAW_MOST_ARGUMENTS);
    CHECK(strlen(law->text) > 5);
    for (int j = 0; j < i; j++) CHECK(strcmp(law->name, trb_law_table[j].name) != 0);
    const double ones[TRB_LAW_MOST_ARGUMENTS] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
    CHECK(isfinite(law->function(ones)));
  }
}

int main(void)
{
  test_smooth();
  test_line_contact();
  test_film();
  test_traction();
  test_viscosity();
  test_hertz();
  test_quadrature();
  test_profile();
  test_table();
  return check_report();
}
