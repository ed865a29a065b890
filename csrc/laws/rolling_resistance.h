/* EHL rolling resistance of a line contact (docs/theory/lubrication.md#rolling-resistance): the force F that drags each surface against
 * rolling. Six laws, each as alpha0 F/(Re l phi_T) = G F/(E' Re l phi_T), of the groups W = w/(E' Re), U = eta0 u/(E' Re), G = alpha0 E'.
 *
 * Four are powers of the groups, c (G U)^a W^b G^e:
 *   (10) Zhou & Hoeprich 1991       29.2  (G U)^0.648 W^0.246
 *        Goksem & Hargreaves 1978   4.318 (G U)^0.658 W^0.0126
 *        Aihara 1987                88    (G U)^0.658 W^0.31
 *        Matsuyama 2004             7.1   (G U)^0.75  W^0.08  G^0.21
 * They hold in the piezoviscous-elastic regime. The paper lets (10) vanish at h_PE = h_IR, here they set in over a band of h_PE/h_IR.
 *
 * Biboulet & Houpert 2010 covers the isoviscous-rigid regime as well and needs no such band:
 *   F/(E' Re l) = 1.42 sqrt(2 U W) / [1 + (1.4/1.45 sqrt(M))^10]^0.1, M = W/sqrt(2 U)
 * It goes with sqrt(U W) at low loads, and with U^0.75 alone at high ones. Numerical solutions of the contact give this over
 *   k = 1.064 (U/1e-10)^0.053 (W/5e-5)^-0.031 (G/4500)^0.02
 * for U of 9e-12 to 5e-10, W of 2e-5 to 2.6e-4, G of 3100 to 5000; beyond, k stays as it is at the nearest of these ends. */
#ifndef TRB_LAWS_ROLLING_RESISTANCE_H
#define TRB_LAWS_ROLLING_RESISTANCE_H

#include <math.h>

#include "laws/smooth.h"

enum {
  TRB_ROLLING_OFF,
  TRB_ROLLING_ZHOU_HOEPRICH,
  TRB_ROLLING_GOKSEM_HARGREAVES,
  TRB_ROLLING_AIHARA,
  TRB_ROLLING_MATSUYAMA,
  TRB_ROLLING_BIBOULET_HOUPERT,
  TRB_ROLLING_LINE_SOLUTION,
  TRB_N_ROLLING_LAWS
};

/* alpha0 F/(Re l phi_T) = factor (G U)^speed W^load G^material */
typedef struct trb_rolling_power {
  double factor, speed, load, material;
} trb_rolling_power;

static inline trb_rolling_power trb_rolling_power_of(int law)
{
  switch (law) {
  case TRB_ROLLING_GOKSEM_HARGREAVES: return (trb_rolling_power){.factor = 4.318, .speed = 0.658, .load = 0.0126};
  case TRB_ROLLING_AIHARA: return (trb_rolling_power){.factor = 88.0, .speed = 0.658, .load = 0.31};
  case TRB_ROLLING_MATSUYAMA: return (trb_rolling_power){.factor = 7.1, .speed = 0.75, .load = 0.08, .material = 0.21};
  default: return (trb_rolling_power){.factor = 29.2, .speed = 0.648, .load = 0.246};
  }
}

/* Without the factor and the power of G alone, which are the same for all contacts of a bearing. */
static inline double trb_rolling_power_at(trb_rolling_power law, double log_w, double log_u, double log_g)
{
  return exp(law.speed * (log_g + log_u) + law.load * log_w);
}

/* F/(E' Re l phi_T) */
static inline double trb_rolling_biboulet_houpert(double log_w, double log_u)
{
  const double log_2u = 0.69314718055994531 + log_u, log_ratio = -0.03509131981127017 + 0.5 * log_w - 0.25 * log_2u; /* log(1.4/1.45) */
  return 1.42 * exp(0.5 * (log_2u + log_w)) * exp(-0.1 * log1p(exp(10.0 * log_ratio)));
}

/* k: the law above over numerical solutions. */
static inline double trb_rolling_excess(double log_w, double log_u, double log_g)
{
  const double w = trb_min(trb_max(log_w, -10.819778284410283), -8.254828926948747); /* log(2e-5), log(2.6e-4) */
  const double u = trb_min(trb_max(log_u, -25.43379653859233), -21.416413017506358); /* log(9e-12), log(5e-10) */
  const double g = trb_min(trb_max(log_g, 8.039157390473237), 8.517193191416238);    /* log(3100), log(5000) */
  return 1.064 * exp(0.053 * (u + 23.025850929940457) - 0.031 * (w + 9.903487552536127) + 0.02 * (g - 8.411832675758411));
}

/* F/(E' Re l phi_T) of numerical solutions */
static inline double trb_rolling_line_solution(double log_w, double log_u, double log_g)
{
  return trb_rolling_biboulet_houpert(log_w, log_u) / trb_rolling_excess(log_w, log_u, log_g);
}

/* Any of the laws, for a table of laws and tests. */
static inline double trb_rolling_line(int law, double log_w, double log_u, double log_g)
{
  const trb_rolling_power power = trb_rolling_power_of(law);
  if (law == TRB_ROLLING_BIBOULET_HOUPERT) return exp(log_g) * trb_rolling_biboulet_houpert(log_w, log_u);
  if (law == TRB_ROLLING_LINE_SOLUTION) return exp(log_g) * trb_rolling_line_solution(log_w, log_u, log_g);
  return power.factor * exp(power.material * log_g) * trb_rolling_power_at(power, log_w, log_u, log_g);
}

/* Share of rolling resistance that a meniscus at a height of oil leaves, S: that height over the smallest film of a flooded contact. Numerical
 * solutions within 0.025 rms; Biboulet & Houpert 2010, part 1, eq. 44 is 0.1 below. */
static inline double trb_rolling_meniscus(double s) { return s / (s + 5.3); }

/* Heat and starvation together. The inlet of a starved contact is short and heats less: where the heat of a full inlet leaves the share phi, a
 * supply f leaves f/(1 + f (1/phi - 1)), here over phi. */
static inline double trb_rolling_supplied(double supply, double phi) { return supply / (phi + supply * (1.0 - phi)); }

/* Rolling resistance of a rigid cylinder at a gap that is full of oil, over eta0 u l (Biboulet & Houpert 2010; Reynolds' equation, solved
 * apart in a test). */
static inline double trb_rolling_gap(double radius_over_gap) { return 4.596 * sqrt(radius_over_gap); }

/* Elastic hysteresis of a line contact, whose moment is a_v 2 b/(3 pi) times the load (Johnson 1985, 9.1): as the force F on each surface that
 * loses as much, over the load. */
static inline double trb_rolling_hysteresis(double loss_factor, double half_width, double radius)
{
  return loss_factor * half_width / (3.0 * TRB_PI * radius);
}

static inline double trb_rolling_share(double elastic_over_rigid, double half_width)
{
  return trb_smooth_step(elastic_over_rigid, 1.0 - half_width, 1.0 + half_width);
}

#endif
