#include "laws/hertz.h"

#include <math.h>

#include "laws/smooth.h"

/* Arithmetic-geometric mean (Abramowitz and Stegun 17.6); converges quadratically. */
void trb_elliptic(double m, double *first, double *second)
{
  double a = 1.0, b = sqrt(1.0 - m), c = sqrt(m), sum = 0.5 * m, power = 0.5;
  for (int i = 0; i < 40 && fabs(c) > 1e-17 * a; i++) {
    const double mean = 0.5 * (a + b);
    c = 0.5 * (a - b);
    b = sqrt(a * b);
    a = mean;
    power *= 2.0;
    sum += power * c * c;
  }
  *first = TRB_PI / (2.0 * a);
  *second = *first * (1.0 - sum);
}

/* R_short/R_long of an ellipse of axis ratio k; falls from 1 at k = 1. */
static double radius_ratio(double k)
{
  double first, second;
  /* series about the circle: the exact form is 0/0 there */
  if (k < 1.0 + 1e-6) return 1.0 - 1.5 * (k - 1.0);
  trb_elliptic(1.0 - 1.0 / (k * k), &first, &second);
  return (first - second) / (k * k * second - first);
}

trb_hertz_point trb_hertz_point_constants(double radius_one, double radius_two, double effective_modulus)
{
  const double longer = trb_max(radius_one, radius_two), shorter = trb_min(radius_one, radius_two);
  const double target = shorter / longer, radius = longer * shorter / (longer + shorter);
  double       low = 0.0, high = log(1e6), first, second;
  /* bisection on ln k, monotonic */
  for (int i = 0; i < 200 && high - low > 1e-15; i++) {
    const double mid = 0.5 * (low + high);
    if (radius_ratio(exp(mid)) > target) low = mid;
    else high = mid;
  }
  const double k = exp(0.5 * (low + high));
  trb_elliptic(1.0 - 1.0 / (k * k), &first, &second);
  const double    along = cbrt(6.0 * k * k * second * radius / (TRB_PI * effective_modulus));
  const double    per_load = first * cbrt(9.0 / (2.0 * second * radius) / pow(TRB_PI * k * effective_modulus, 2.0));
  trb_hertz_point point = {k, pow(per_load, -1.5), along, along / k};
  return point;
}
