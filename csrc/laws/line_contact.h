/* Normal load of a roller on a raceway or a bar: Palmgren's line contact, and the Hertz pressure of a line
 * (docs/theory/contacts.md#raceways).
 *
 * (1) q = 0.356 E' Nsl^(-1/9) l^(8/9) d^(10/9) for a slice of length l = L/Nsl. With a weight w_k along the contact this is
 *     q_k = 0.356 E' L^(-1/9) w_k d_k^(10/9), the same for uniform slices and valid for any quadrature.
 * Hertz, line: b = sqrt(8 w Re/(pi E')), pmax = 2 w/(pi b), with w the load per length. */
#ifndef TRB_LAWS_LINE_CONTACT_H
#define TRB_LAWS_LINE_CONTACT_H

#include "laws/smooth.h"

#define TRB_PALMGREN_FACTOR 0.356
#define TRB_PALMGREN_EXPONENT (10.0 / 9.0)
/* Elastic energy over load times interference: the integral of d^(10/9). */
#define TRB_PALMGREN_ENERGY (9.0 / 19.0)

/* Load per length at interference exp(log_d), as its logarithm. */
static inline double trb_line_log_load(double log_d, double effective_modulus, double length)
{
  return log(TRB_PALMGREN_FACTOR * effective_modulus) - log(length) / 9.0 + TRB_PALMGREN_EXPONENT * log_d;
}

static inline double trb_line_half_width(double load_per_length, double radius, double effective_modulus)
{
  return sqrt(8.0 * load_per_length * radius / (TRB_PI * effective_modulus));
}

static inline double trb_line_pressure(double load_per_length, double radius, double effective_modulus)
{
  return sqrt(load_per_length * effective_modulus / (2.0 * TRB_PI * radius));
}

/* Mean Hertz pressure over the largest: line pi/4, ellipse 2/3 (erratum of the paper's eq. 9). */
#define TRB_LINE_MEAN_PRESSURE (TRB_PI / 4.0)
#define TRB_POINT_MEAN_PRESSURE (2.0 / 3.0)

#endif
