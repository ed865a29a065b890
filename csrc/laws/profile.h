/* Profile of the rollers, and the nodes along a contact (docs/theory/geometry.md#roller-profile). */
#ifndef TRB_LAWS_PROFILE_H
#define TRB_LAWS_PROFILE_H

enum { TRB_PROFILE_STRAIGHT = 0, TRB_PROFILE_CROWNED = 1, TRB_PROFILE_LOGARITHMIC = 2, TRB_PROFILE_ISO = 3 };
enum { TRB_QUADRATURE_UNIFORM = 0, TRB_QUADRATURE_GAUSS = 1 };

/* Arc of radius r: y^2/(2 r) to leading order, exact here. */
double trb_profile_crowned(double y, double radius);

/* Logarithmic drop A ln{1/[1 - (1 - e^(-zm/A)) ((|y|-a)/(K2 a) + 1)^2]} for |y| > a - K2 a, A = 2 K1 Q/(pi L E'), a = L/2
 * (Fujiwara & Kawase 2007). */
double trb_profile_logarithmic(double y, double length, double k1, double k2, double zm, double load, double effective_modulus);

/* Drop of the general form of ISO/TS 16281 (DIN 26281): P = scale ln{1/[1 - ((2|y| - straight)/length)^exponent]} for 2|y| > straight,
 * scale = a_p Dwe. It grows without bound towards 2|y| = straight + length; from TRB_PROFILE_STEEPEST of the way on it stays. */
#define TRB_PROFILE_STEEPEST (1.0 - 1e-6)
double trb_profile_iso(double y, double scale, double length, double straight, double exponent);

/* n nodes on (-1, 1) and weights that sum to 2; kind is TRB_QUADRATURE_*. */
void trb_quadrature(int kind, int n, double *nodes, double *weights);

#endif
