/* Film of a short journal bearing with half-Sommerfeld boundaries (docs/theory/contacts.md#film-of-a-short-journal-bearing): Reynolds'
 * equation without flow around the axis, of which only the half with positive pressure is kept.
 *
 * All that moves the oil is in one velocity: that of the inner surface relative to the outer one, both taken midway between the two axes.
 * With d the place of the inner axis relative to the outer one, w1 and w2 the angular velocities, it is V = d' - (w1 + w2)/2 k x d. Pressure
 * is positive where V points to, on the half circle about its direction, and the force on the inner surface is
 *     F = -eta R L^3 M V,   M = integral over that half circle of n n^T/(c - d.n)^3 dtheta.
 * M is half of the second derivatives of G = integral of 1/(c - d.n), which has a closed form (Capone 1986 has the same for a rotor). As M is
 * positive, the film only takes energy, and it never pulls. */
#ifndef TRB_LAWS_JOURNAL_H
#define TRB_LAWS_JOURNAL_H

#include "laws/smooth.h"

/* Entries of M, times the cube of the clearance. */
typedef struct trb_journal_film {
  double along;  /* force along V, for a velocity along V */
  double across; /* force along k x V, for a velocity along V */
} trb_journal_film;

/* u, w: eccentricity over clearance, along V and along k x V; u^2 + w^2 < 1. */
static inline trb_journal_film trb_journal_short(double u, double w)
{
  const double q2 = 1.0 - u * u - w * w, q = sqrt(q2), q4 = q2 * q2, turn = atan2(q, -u);
  return (trb_journal_film){.along = 3.0 * u / q4 + turn * (q2 + 3.0 * u * u) / (q4 * q),
                            .across = w * ((2.0 + u * u / (1.0 - w * w)) / q4 + 3.0 * turn * u / (q4 * q))};
}

/* Torque on the inner surface over the difference of the angular velocities, outer minus inner, with the whole circle filled (Petroff),
 * N m s. viscosity in Pa s, radius, width and clearance in m, eccentricity over clearance. */
static inline double trb_journal_shear(double viscosity, double radius, double width, double clearance, double eccentricity)
{
  return 2.0 * TRB_PI * viscosity * radius * radius * radius * width / (clearance * sqrt(1.0 - eccentricity * eccentricity));
}

#endif
