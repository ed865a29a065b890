/* Friction coefficients of lubricated contacts, as functions of sliding (docs/theory/lubrication.md#traction-of-a-full-film). All are
 * zero without sliding. */
#ifndef TRB_LAWS_TRACTION_H
#define TRB_LAWS_TRACTION_H

#include "laws/smooth.h"

/* Smallest sliding speed in a ratio, m/s: far below the creep of a loaded roller (1e-4 of 6 m/s). */
#define TRB_SLIDING_GUARD 1e-9

/* asinh of x >= 0 without cancellation near zero, by functions that compilers have as vectors. */
static inline double trb_asinh(double x) { return log1p(x + x * x / (1.0 + sqrt(x * x + 1.0))); }

/* (6) mu_bd = (-limit + slope s) exp(-decay s) + limit, with 0.1, 22.28, 181.46 (Kragelskii's form; the paper). */
static inline double trb_friction_boundary(double slide_roll, double limit, double slope, double decay)
{
  const double e = expm1(-decay * slide_roll);
  return slope * slide_roll * (1.0 + e) - limit * e;
}

/* (7)-(8) Muraki & Kimura, isothermal: Xc = (D/Sigma) asinh(Sigma); Xc >= 2: S = Sigma/D (the paper's inverse is an erratum);
 * else S = asinh(Sigma) [1 - D/(4 Sigma) asinh(Sigma)]. mu = tau0 S/pmean (9). */
static inline double trb_traction_muraki_kimura(double sigma, double d)
{
  const double g = trb_max(sigma, 1e-300), a = trb_asinh(g), ratio = d / g;
  return ratio * a >= 2.0 ? g / d : a * (1.0 - 0.25 * ratio * a);
}

/* (2) share of boundary friction: 1 below lambda_boundary, 0 above lambda_full, ((Lambda - 1.5)/(0.01 - 1.5))^6 between. */
static inline double trb_boundary_share(double film_parameter, double lambda_boundary, double lambda_full)
{
  const double t = trb_clamp((film_parameter - lambda_full) / (lambda_boundary - lambda_full), 0.0, 1.0);
  const double t2 = t * t;
  return t2 * t2 * t2;
}

/* Share of the load that asperities carry: exp(-B Lambda^C) (Zhou & Hoeprich 1991, with B and C of the surfaces). */
static inline double trb_asperity_share(double film_parameter, double factor, double exponent)
{
  return exp(-factor * exp(exponent * log(trb_max(film_parameter, 1e-300))));
}

/* Slide-roll ratio of surfaces that do not roll (cage): s = |Du|/sqrt(|Du|^2/4 + ue^2). */
static inline double trb_slide_roll_cage(double sliding, double entrainment)
{
  return sliding / sqrt(0.25 * sliding * sliding + entrainment * entrainment);
}

#endif
