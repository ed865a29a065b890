/* Drag of a body that moves through a mixture of oil and air: F = fill rho Cd A v^2/2 against its velocity
 * (docs/theory/contacts.md#drag-of-the-oil; Schlichting, Boundary-Layer
 * Theory; for rollers in bearings e.g. Rumbarger, Filetti and Gubernick 1973, ASME J. Lubr. Technol. 95, 401). Smooth at zero speed. */
#ifndef TRB_LAWS_DRAG_H
#define TRB_LAWS_DRAG_H

/* Force over speed, N s/m: the force is minus this times the velocity. density: of the oil, kg/m3; fill: its share of the mixture's volume;
 * area: of the body across its motion, m2; speed: relative to the mixture, m/s. */
static inline double trb_drag_over_speed(double fill, double density, double coefficient, double area, double speed)
{
  return 0.5 * fill * density * coefficient * area * speed;
}

#endif
