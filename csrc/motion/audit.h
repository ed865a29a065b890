/* Energies that are functions of the state (docs/theory/energy.md#stored-energy). Works and losses are quadratures (bearing/losses.h). */
#ifndef TRB_MOTION_AUDIT_H
#define TRB_MOTION_AUDIT_H

#include "motion/rhs.h"

/* Kinetic energy of rollers and of the bodies of the hub at the poses kept, J. */
double trb_audit_kinetic(const trb_dynamics *d);
/* Elastic energy of all contacts at the loads kept, and within bodies at the poses kept, J. */
double trb_audit_elastic(const trb_dynamics *d);

#endif
