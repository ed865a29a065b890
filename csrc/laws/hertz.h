/* Hertz contact of an ellipse with exact elliptic integrals (K. L. Johnson, Contact Mechanics, eqs. 4.26-4.28;
 * docs/theory/contacts.md#large-end-on-the-back-face-rib).
 *
 * With the principal relative radii R_long >= R_short, k = a/b >= 1 the ellipse's axis ratio and m = 1 - 1/k^2:
 *   R_short/R_long = [K(m) - E(m)] / [k^2 E(m) - K(m)]
 * and with 1/R = 1/R_long + 1/R_short (Hamrock, E' = 2/[...]):
 *   a = (6 k^2 E Q R/(pi E'))^(1/3), b = a/k, d = K [9/(2 E R) (Q/(pi k E'))^2]^(1/3), pmax = 3 Q/(2 pi a b). */
#ifndef TRB_LAWS_HERTZ_H
#define TRB_LAWS_HERTZ_H

typedef struct trb_hertz_point {
  double ellipticity; /* a/b >= 1 */
  double stiffness;   /* K in Q = K d^1.5, N/m^1.5 */
  double semi_long;   /* a / Q^(1/3), m/N^(1/3), along the larger radius */
  double semi_short;  /* b / Q^(1/3), m/N^(1/3) */
} trb_hertz_point;

/* Complete elliptic integrals of parameter m = modulus^2, 0 <= m < 1. */
void trb_elliptic(double m, double *first, double *second);

/* Constants of the contact of two radii (both > 0) at a modulus E'. */
trb_hertz_point trb_hertz_point_constants(double radius_one, double radius_two, double effective_modulus);

#endif
