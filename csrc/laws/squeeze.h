/* Film between a rigid cylinder and a plane that approach each other while oil is drawn between them: Reynolds' equation of an isoviscous
 * line contact, with Reynolds' boundary where the film breaks off (docs/theory/contacts.md#film-between-roller-and-pocket).
 *
 * With x = sqrt(2 R h) xi, mean surface speed u > 0, approach V and s = (V/u) sqrt(2 R/h), the scaled pressure has the slope
 *     P' = (xi - r)(xi + r - s)/(1 + xi^2)^3   up to the place r where P and P' are zero, and P = 0 far before the contact.
 * Here P = p h^2/(12 eta u sqrt(2 R h)). Its integrals have closed forms in r, and so has s: the problem is solved backwards. r follows from s
 * by a hyperbola that has both asymptotes of the relation, and a fitted bump: the load is exact within 0.3 %.
 *
 * load I = integral of P, loss D = integral of (1 + xi^2)^3 P'^2. D is positive for every s, and I = dD/ds/2. */
#ifndef TRB_LAWS_SQUEEZE_H
#define TRB_LAWS_SQUEEZE_H

#include "laws/smooth.h"

typedef struct trb_squeeze {
  double load;  /* I: load a length over 24 eta u R/h */
  double loss;  /* D: power that the flow of pressure loses a length, over 12 eta u^2 sqrt(2 R/h) */
  double shear; /* integral of 1/(1 + xi^2) over the film: force of the sliding speed a length, over eta sqrt(2 R/h) and that speed */
} trb_squeeze;

/* Below this s the film's asymptote stands for it: the closed forms lose their digits there. */
#define TRB_SQUEEZE_APART (-40.0)

/* Integrals of xi^k/(1 + xi^2)^3 from minus infinity to r. */
typedef struct trb_squeeze_moments {
  double angle, of[5];
} trb_squeeze_moments;

static inline trb_squeeze_moments trb_squeeze_integrals(double r)
{
  const double        one = 1.0 / (1.0 + r * r), a = atan2(1.0, -r), two = 0.5 * (a + r * one), three = 0.75 * two + 0.25 * r * one * one;
  trb_squeeze_moments m;
  m.angle = a;
  m.of[0] = three;
  m.of[1] = -0.25 * one * one;
  m.of[2] = two - three;
  m.of[3] = 0.25 * one * one - 0.5 * one;
  m.of[4] = a - 2.0 * two + three;
  return m;
}

/* s at which the film breaks off at r. */
static inline double trb_squeeze_rate(const trb_squeeze_moments *m, double r)
{
  return (m->of[2] - r * r * m->of[0]) / (m->of[1] - r * m->of[0]);
}

/* Where the film breaks off at s, to 0.001. */
static inline double trb_squeeze_end(double s)
{
  const double from = s - 0.546;
  return (11.0 * s + sqrt(25.0 * s * s + 6.0 * TRB_PI * TRB_PI)) / 16.0 - (9.65e-3 + 7.04e-3 * from) / (1.0 + 0.3077 * from * from);
}

static inline trb_squeeze trb_squeeze_film(double s)
{
  const double              near = trb_max(s, TRB_SQUEEZE_APART), r = trb_squeeze_end(near);
  const trb_squeeze_moments m = trb_squeeze_integrals(r);
  const double              at = trb_squeeze_rate(&m, r), load = r * r * m.of[1] - m.of[3] + at * (m.of[2] - r * m.of[1]);
  const double              loss = at * load + m.of[4] - r * r * m.of[2] - at * (m.of[3] - r * m.of[2]);
  if (s >= TRB_SQUEEZE_APART) return (trb_squeeze){.load = load, .loss = loss, .shear = m.angle};
  const double more = near / s;
  return (trb_squeeze){.load = load * more * more, .loss = loss * more, .shear = m.angle * more};
}

#endif
