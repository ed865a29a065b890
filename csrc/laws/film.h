/* Central film thickness of rolling contacts (docs/theory/lubrication.md#films). The laws take logarithms, as the logarithm of a load or
 * a speed is needed for several powers of it. W, U, G are the usual groups: line W = w/(E' Re), U = eta0 u/(E' Re);
 * ellipse W = Q/(E' Rx^2), U = eta0 u/(E' Rx); G = alpha0 E'. Lt = eta0 beta u^2/k'. */
#ifndef TRB_LAWS_FILM_H
#define TRB_LAWS_FILM_H

#include "laws/smooth.h"

/* (4) line, piezoviscous-elastic: h/Re = 2.922 W^-0.166 U^0.692 G^0.470 (Pan & Hamrock 1989, central). */
#define TRB_FILM_LINE_LOAD 0.166
#define TRB_FILM_LINE_SPEED 0.692
static inline double trb_film_line_elastic(double log_w, double log_u, double log_g)
{
  return exp(1.0722683133285078 - TRB_FILM_LINE_LOAD * log_w + TRB_FILM_LINE_SPEED * log_u + 0.470 * log_g);
}

/* The smallest film of the same: h/Re = 1.714 W^-0.128 U^0.694 G^0.568 (Pan & Hamrock 1989). */
static inline double trb_film_line_smallest(double log_w, double log_u, double log_g)
{
  return exp(0.5388299 - 0.128 * log_w + 0.694 * log_u + 0.568 * log_g);
}

/* (5) line, isoviscous-rigid: h/Re = 4.9 U/W (Martin). */
static inline double trb_film_line_rigid(double u_over_w) { return 4.9 * u_over_w; }

/* (12) ellipse, piezoviscous-elastic: h/Rx = 4.31 U^0.68 G^0.49 W^-0.073 shape, shape = 1 - exp[-1.23 (Ry/Rx)^(2/3)]
 * (Chittenden et al. 1985, x along rolling; the paper's exponent of k is an erratum). */
static inline double trb_film_point_elastic(double log_w, double log_u, double log_g, double shape)
{
  return 4.31 * shape * exp(0.68 * log_u + 0.49 * log_g - 0.073 * log_w);
}

/* The same for an ellipse that is long along rolling, as of a needle: 1.25 x 3.63 U^0.68 G^0.49 W^-0.073 [1 - exp(-0.68 k)], k = 1.03 (Ry/Rx)^0.64:
 * Hamrock's smallest film, and a quarter more in the middle (Aihara 1987, 16 and 17). As a shape in the form above. */
static inline double trb_film_needle_shape(double radius_ratio)
{
  return -1.25 * 3.63 / 4.31 * expm1(-0.68 * 1.03 * pow(radius_ratio, 0.64));
}

static inline double trb_film_point_shape(double radius_ratio) { return -expm1(-1.23 * pow(radius_ratio, 2.0 / 3.0)); }

/* (13) ellipse, isoviscous-rigid: h/Rx = 128 ar phi^2 [0.131 atan(ar/2) + 1.683]^2 (U/W)^2, phi = 1/(1 + 2/(3 ar)), ar = Ry/Rx
 * (Brewe, Hamrock & Taylor 1979; the paper's phi^2 is missing). The factor before (U/W)^2 is geometry. */
static inline double trb_film_point_rigid_factor(double radius_ratio)
{
  const double phi = 1.0 / (1.0 + 2.0 / (3.0 * radius_ratio)), bracket = 0.131 * atan(0.5 * radius_ratio) + 1.683;
  return 128.0 * radius_ratio * phi * phi * bracket * bracket;
}

/* phi_T = [1 - 13.2 (pmax/E') Lt^0.42] / [1 + 0.213 (1 + 2.23 s^0.83) Lt^0.64] (Gupta et al. 1991), kept above a floor where the
 * numerator falls to zero and below. */
static inline double trb_film_thermal(double pressure_over_modulus, double log_lt, double log_slide_roll, double floor)
{
  const double top = 1.0 - 13.2 * pressure_over_modulus * exp(0.42 * log_lt);
  const double bottom = 1.0 + 0.213 * (1.0 + 2.23 * exp(0.83 * log_slide_roll)) * exp(0.64 * log_lt);
  return trb_smooth_max(top / bottom, floor, 0.5 * floor);
}

/* The same without pressure and slip: 1/(1 + 0.29 Lt^0.78) (Aihara 1987). */
static inline double trb_film_thermal_aihara(double log_lt) { return 1.0 / (1.0 + 0.29 * exp(0.78 * log_lt)); }

#endif
