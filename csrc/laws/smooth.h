/* Smooth guards that the laws share. All are exact outside the band that they smooth. */
#ifndef TRB_LAWS_SMOOTH_H
#define TRB_LAWS_SMOOTH_H

#include <math.h>

#define TRB_PI 3.14159265358979323846

static inline double trb_min(double a, double b) { return a < b ? a : b; }
static inline double trb_max(double a, double b) { return a > b ? a : b; }
static inline double trb_clamp(double x, double low, double high) { return trb_min(trb_max(x, low), high); }

/* max(x, low), once differentiable: a parabola where |x - low| < half_width, exact elsewhere. */
static inline double trb_smooth_max(double x, double low, double half_width)
{
  const double e = x - low;
  const double t = trb_clamp(e, -half_width, half_width) + half_width;
  return low + t * t / (4.0 * half_width) + trb_max(e - half_width, 0.0);
}

/* 0 below low, 1 above high, C1 between. */
static inline double trb_smooth_step(double x, double low, double high)
{
  const double t = trb_clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/* Value and slope at the fraction s of an interval of length h of the cubic with the values a, b and the slopes da, db at its ends (Hermite). */
typedef struct trb_curve {
  double value, slope;
} trb_curve;

static inline trb_curve trb_hermite(double s, double h, double a, double da, double b, double db)
{
  const double s2 = s * s, s3 = s2 * s;
  return (trb_curve){(2 * s3 - 3 * s2 + 1) * a + (s3 - 2 * s2 + s) * h * da + (3 * s2 - 2 * s3) * b + (s3 - s2) * h * db,
                     (6 * s2 - 6 * s) / h * (a - b) + (3 * s2 - 4 * s + 1) * da + (3 * s2 - 2 * s) * db};
}

#endif
