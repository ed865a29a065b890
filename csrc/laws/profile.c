#include "laws/profile.h"

#include <math.h>

#include "laws/smooth.h"

double trb_profile_crowned(double y, double radius) { return y * y / (radius + sqrt(trb_max(radius * radius - y * y, 0.0))); }

double trb_profile_logarithmic(double y, double length, double k1, double k2, double zm, double load, double effective_modulus)
{
  const double a = 0.5 * length, from = a - k2 * a, amplitude = 2.0 * k1 * load / (TRB_PI * length * effective_modulus);
  if (fabs(y) <= from || zm <= 0.0 || amplitude <= 0.0) return 0.0;
  const double x = trb_min((fabs(y) - a) / (k2 * a) + 1.0, 1.0);
  /* 1 - (1 - e) x^2 = (1 - x^2) + e x^2 as a sum of two exponentials: no cancellation at the end (x = 1), none where x is small */
  const double one = x < 0.5 ? log1p(-x * x) : log((1.0 - x) * (1.0 + x)), other = 2.0 * log(x) - zm / amplitude;
  return -amplitude * (trb_max(one, other) + log1p(exp(trb_min(one, other) - trb_max(one, other))));
}

double trb_profile_iso(double y, double scale, double length, double straight, double exponent)
{
  const double way = trb_min((2.0 * fabs(y) - straight) / length, 1.0);
  return way > 0.0 ? -scale * log1p(-trb_min(pow(way, exponent), TRB_PROFILE_STEEPEST)) : 0.0;
}

/* Legendre polynomial of degree n and its derivative. */
static void legendre(int n, double x, double *value, double *slope)
{
  double before = 1.0, here = x;
  for (int k = 2; k <= n; k++) {
    const double next = ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k;
    before = here;
    here = next;
  }
  *value = here;
  *slope = n * (x * here - before) / (x * x - 1.0);
}

void trb_quadrature(int kind, int n, double *nodes, double *weights)
{
  for (int i = 0; i < n; i++) {
    if (kind == TRB_QUADRATURE_UNIFORM || n == 1) {
      nodes[i] = (2.0 * i + 1.0) / n - 1.0;
      weights[i] = 2.0 / n;
      continue;
    }
    /* Newton from Chebyshev's guess */
    double x = -cos(TRB_PI * (i + 0.75) / (n + 0.5)), value, slope;
    for (int step = 0; step < 20; step++) {
      legendre(n, x, &value, &slope);
      const double correction = value / slope;
      x -= correction;
      if (fabs(correction) < 1e-15) break;
    }
    legendre(n, x, &value, &slope);
    nodes[i] = x;
    weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
  }
}
