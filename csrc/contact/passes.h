/* Loops (passes) over lanes that raceways and ribs share: one loop for each law. Which effects a scene has is decided outside the loops.
 *
 * Included by the kernel files only, which are compiled once for each instruction set. The number of lanes n must be a multiple of
 * TRB_LANE_PAD. */
#ifndef TRB_CONTACT_PASSES_H
#define TRB_CONTACT_PASSES_H

#include <float.h>

#include "base/variant.h"
#include "contact/kernels.h"
#include "laws/film.h"
#include "laws/line_contact.h"
#include "laws/traction.h"
#include "laws/viscosity.h"

#if defined(__GNUC__)
#define TRB_PADDED(n) if ((n) % TRB_LANE_PAD != 0) __builtin_unreachable()
#else
#define TRB_PADDED(n) (void)(n)
#endif

/* Interference below which a node carries nothing, m: keeps logarithms finite. */
#define TRB_SMALLEST_INTERFERENCE 1e-15

/* What differs between a line and an ellipse in the laws of friction. */
typedef struct trb_pass_kind {
  double mean_pressure; /* mean Hertz pressure over the largest */
  double roughness;     /* composite rms, m */
  double boundary_limit;
  double asperity_factor, asperity_exponent;
} trb_pass_kind;

/* Mean and sliding speed, slide-roll ratio; smooth at zero. */
static inline void pass_speeds(const trb_model *m, int n, trb_lanes *l)
{
  const double floor2 = m->params.friction.speed_floor * m->params.friction.speed_floor;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double mean = sqrt(l->mx[i] * l->mx[i] + l->my[i] * l->my[i] + l->mz[i] * l->mz[i] + floor2);
    const double slide = sqrt(l->sx[i] * l->sx[i] + l->sy[i] * l->sy[i] + l->sz[i] * l->sz[i] + TRB_SLIDING_GUARD * TRB_SLIDING_GUARD);
    l->mean_speed[i] = mean;
    l->sliding_speed[i] = slide;
    l->slide_roll[i] = slide / mean;
    l->log_u[i] = log(mean);
    l->friction_coefficient[i] = 0.0;
  }
}

static inline void pass_thermal(const trb_model *m, int n, trb_lanes *l)
{
  const double base = m->log_thermal, modulus = m->geometry.effective_modulus, floor = m->params.friction.thermal_floor;
  TRB_PADDED(n);
  if (m->params.effects.thermal == TRB_THERMAL_AIHARA) {
    TRB_LANES for (int i = 0; i < n; i++) l->thermal_factor[i] = trb_film_thermal_aihara(base + 2.0 * l->log_u[i]);
    return;
  }
  TRB_LANES for (int i = 0; i < n; i++) l->thermal_factor[i] =
      trb_film_thermal(l->pressure[i] / modulus, base + 2.0 * l->log_u[i], log(l->slide_roll[i]), floor);
}

/* (3), and (11) at the rib, with a starvation factor. */
static inline void pass_film_parameter(const trb_model *m, const trb_pass_kind *kind, int n, trb_lanes *l)
{
  const double starvation = m->params.effects.starvation_factor, per_roughness = 1.0 / kind->roughness;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    l->film[i] = starvation * l->thermal_factor[i] * trb_max(l->film_elastic[i], l->film_rigid[i]);
    l->film_parameter[i] = l->film[i] * per_roughness;
  }
}

/* The traction loop once per viscosity law, so that the choice is made outside. */
#define TRB_TRACTION_LOOP(log_ratio) \
  TRB_PADDED(n); \
  TRB_LANES for (int i = 0; i < n; i++) \
  { \
    const double mean_pressure = mean_share * l->pressure[i]; \
    const double eta = viscosity * exp(log_ratio); \
    const double sigma = eta * l->sliding_speed[i] / (tau0 * l->film[i]); \
    const double d = eta * l->mean_speed[i] / (trb_shear_modulus(mean_pressure, temperature, floor) * l->half_width[i]); \
    l->traction_coefficient[i] = tau0 * trb_traction_muraki_kimura(sigma, d) / mean_pressure; \
  }

/* (7)-(9) Muraki & Kimura. */
static inline void pass_muraki_kimura(const trb_model *m, const trb_pass_kind *kind, int n, trb_lanes *l)
{
  const trb_params *p = &m->params;
  const double      viscosity = p->oil.viscosity, tau0 = p->oil.eyring_stress, temperature = p->oil.temperature,
                    floor = p->oil.shear_modulus_floor;
  const double      alpha = p->oil.pressure_coefficient, cap = p->oil.viscosity_exponent_cap, mean_share = kind->mean_pressure;
  if (p->oil.viscosity_law == TRB_VISCOSITY_DICKE) {
    const double at = p->oil.dicke_a + p->oil.dicke_b * temperature, ct = p->oil.dicke_c + p->oil.dicke_d * temperature;
    TRB_TRACTION_LOOP(trb_viscosity_dicke(mean_pressure, at, ct))
  } else if (p->oil.viscosity_law == TRB_VISCOSITY_ROELANDS) {
    const double log_viscosity = m->log_viscosity;
    TRB_TRACTION_LOOP(trb_viscosity_roelands(mean_pressure, alpha, log_viscosity, cap))
  } else {
    TRB_TRACTION_LOOP(trb_viscosity_barus(mean_pressure, alpha, cap))
  }
}

static inline void pass_coulomb(const trb_model *m, int n, trb_lanes *l, double *restrict coefficient)
{
  const double mu = m->params.friction.dry_friction, turn = m->params.friction.coulomb_speed * m->params.friction.coulomb_speed;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double s = l->sliding_speed[i];
    coefficient[i] = mu * s / sqrt(s * s + turn);
  }
}

/* (6) boundary friction. */
static inline void pass_boundary(const trb_model *m, const trb_pass_kind *kind, int n, trb_lanes *l)
{
  const double limit = kind->boundary_limit, slope = m->params.friction.boundary_slope, decay = m->params.friction.boundary_decay;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++) l->boundary_coefficient[i] = trb_friction_boundary(l->slide_roll[i], limit, slope, decay);
}

static inline double thinnest(int n, const trb_lanes *l)
{
  double least = DBL_MAX;
  TRB_PADDED(n);
  for (int i = 0; i < n; i++) least = trb_min(least, l->film_parameter[i]);
  return least;
}

/* The loop of mixed friction once per law. */
#define TRB_MIX_LOOP(law) \
  TRB_PADDED(n); \
  TRB_LANES for (int i = 0; i < n; i++) \
  { \
    const double share = (law); \
    l->friction_coefficient[i] = l->traction_coefficient[i] + share * (l->boundary_coefficient[i] - l->traction_coefficient[i]); \
  }

/* (2) mixed friction, or with an exponential share of the asperities. */
static inline void pass_mix(const trb_model *m, const trb_pass_kind *kind, int n, trb_lanes *l)
{
  const double low = m->params.friction.lambda_boundary, high = m->params.friction.lambda_full, b = kind->asperity_factor,
               c = kind->asperity_exponent;
  if (m->params.effects.mixed_law > 0.0) {
    TRB_MIX_LOOP(trb_asperity_share(l->film_parameter[i], b, c))
  } else {
    TRB_MIX_LOOP(trb_boundary_share(l->film_parameter[i], low, high))
  }
}

static inline void copy_lanes(int n, const double *restrict from, double *restrict to)
{
  for (int i = 0; i < n; i++) to[i] = from[i];
}

/* Friction coefficients of the scene's kind of lubrication. */
static inline void pass_friction(const trb_model *m, const trb_pass_kind *kind, int n, trb_lanes *l, trb_counters *counters)
{
  const trb_params *p = &m->params;
  if (p->effects.lubrication == TRB_LUBRICATION_DRY) {
    pass_coulomb(m, n, l, l->friction_coefficient);
    counters->coulomb_nodes += n;
    return;
  }
  if (p->effects.lubrication == TRB_LUBRICATION_BOUNDARY) {
    pass_boundary(m, kind, n, l);
    counters->boundary_nodes += n;
    copy_lanes(n, l->boundary_coefficient, l->friction_coefficient);
    return;
  }
  if (p->effects.traction == TRB_TRACTION_MURAKI_KIMURA) {
    pass_muraki_kimura(m, kind, n, l);
    counters->traction_nodes += n;
  } else if (p->effects.traction == TRB_TRACTION_COULOMB) {
    pass_coulomb(m, n, l, l->traction_coefficient);
    counters->coulomb_nodes += n;
  } else {
    for (int i = 0; i < n; i++) l->traction_coefficient[i] = 0.0;
  }
  /* boundary friction only where some film is thin enough to share it */
  if (p->effects.lubrication == TRB_LUBRICATION_MIXED && (p->effects.mixed_law > 0.0 || thinnest(n, l) < p->friction.lambda_full)) {
    pass_boundary(m, kind, n, l);
    counters->boundary_nodes += n;
    pass_mix(m, kind, n, l);
  } else {
    copy_lanes(n, l->traction_coefficient, l->friction_coefficient);
  }
}

/* What the oil does: films, of which the parts before the thermal factor are there, and friction. */
static inline void pass_oil(const trb_model *m, const trb_pass_kind *kind, int n, trb_lanes *l, trb_counters *counters)
{
  if (m->film) {
    counters->film_nodes += n;
    if (m->params.effects.thermal > 0.0) {
      pass_thermal(m, n, l);
      counters->thermal_nodes += n;
    }
    pass_film_parameter(m, kind, n, l);
  }
  if (m->friction) pass_friction(m, kind, n, l, counters);
}

#endif
