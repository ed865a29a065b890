/* Drag of a body that moves through a mixture of oil and air: F = fill rho Cd A v^2/2 against its velocity
 * (docs/theory/contacts.md#drag-of-the-oil; Schlichting, Boundary-Layer
 * Theory; for rollers in bearings e.g. Rumbarger, Filetti and Gubernick 1973, ASME J. Lubr. Technol. 95, 401). Smooth at zero speed. */
#ifndef TRB_LAWS_DRAG_H
#define TRB_LAWS_DRAG_H

#include "laws/smooth.h"

/* Force over speed, N s/m: the force is minus this times the velocity. density: of the oil, kg/m3; fill: its share of the mixture's volume;
 * area: of the body across its motion, m2; speed: relative to the mixture, m/s. */
static inline double trb_drag_over_speed(double fill, double density, double coefficient, double area, double speed)
{
  return 0.5 * fill * density * coefficient * area * speed;
}

/* Torque over speed of a disc that turns in a fluid, of both sides together: M = C rho w^2 R^5/2 with C = 3.87 Re^-0.5 where the flow is
 * laminar and 0.146 Re^-0.2 where it is turbulent, Re = R^2 w/nu (Schlichting, Boundary-Layer Theory, rotating disc); the larger of both, which meet
 * at Re = 5.5e4. Zero without speed, N m s. viscosity: kinematic, m2/s. */
static inline double trb_disc_over_speed(double density, double viscosity, double radius, double speed)
{
  const double square = radius * radius, re = trb_max(square * speed / viscosity, 1e-300), root = sqrt(re);
  const double c = trb_max(3.87 / root, 0.146 / exp(0.2 * log(re)));
  return 0.5 * c * density * speed * square * square * radius;
}

#endif
