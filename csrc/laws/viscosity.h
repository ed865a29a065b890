/* Viscosity at pressure, as ln(eta/eta0). */
#ifndef TRB_LAWS_VISCOSITY_H
#define TRB_LAWS_VISCOSITY_H

#include "laws/smooth.h"

enum { TRB_VISCOSITY_DICKE = 0, TRB_VISCOSITY_ROELANDS = 1, TRB_VISCOSITY_BARUS = 2 };

#define TRB_PASCAL_PER_BAR 1e5
/* Roelands' reference pressure, Pa, and ln of his reference viscosity 6.31e-5 Pa s, negated. */
#define TRB_ROELANDS_PRESSURE 1.962e8
#define TRB_ROELANDS_LOG 9.67

/* Dicke: p/(a + c p) with p in bar; the coefficients at temperature t are at = a + b t, ct = c + d t
 * (docs/theory/lubrication.md#viscosity-over-pressure). */
static inline double trb_viscosity_dicke(double pressure, double at, double ct)
{
  const double bar = pressure / TRB_PASCAL_PER_BAR;
  return bar / (at + ct * bar);
}

/* Roelands: (ln eta0 + 9.67) [(1 + p/p0)^Z - 1], Z from the slope alpha0 at p = 0; capped smoothly. */
static inline double trb_viscosity_roelands(double pressure, double pressure_coefficient, double log_viscosity, double cap)
{
  const double base = log_viscosity + TRB_ROELANDS_LOG, z = pressure_coefficient * TRB_ROELANDS_PRESSURE / base;
  const double exponent = base * (exp(z * log1p(pressure / TRB_ROELANDS_PRESSURE)) - 1.0);
  return -trb_smooth_max(-exponent, -cap, 1.0);
}

/* Barus: alpha0 p, capped smoothly. */
static inline double trb_viscosity_barus(double pressure, double pressure_coefficient, double cap)
{
  return -trb_smooth_max(-pressure_coefficient * pressure, -cap, 1.0);
}

/* Ginf = 1.2 pmean/(2.52 + 0.024 t) - 1e8 Pa (Dyson), smoothly kept above a floor. */
static inline double trb_shear_modulus(double mean_pressure, double temperature, double floor)
{
  return trb_smooth_max(1.2 * mean_pressure / (2.52 + 0.024 * temperature) - 1e8, floor, 0.5 * floor);
}

#endif
