/* The arrow-shaped matrix and its solver as SUNDIALS objects. */
#ifndef TRB_STEPPING_ARROW_SOLVER_H
#define TRB_STEPPING_ARROW_SOLVER_H

#include "stepping/arrow.h"
#include "system/assembly.h"
#include "stepping/sundials_shim.h"

/* NULL if out of memory. The tail of the state (spin angles, quadratures) has the identity. */
SUNMatrix       trb_arrow_matrix(int n_rollers, int hub_width, SUNContext context);
trb_arrow      *trb_arrow_of(SUNMatrix matrix);
SUNLinearSolver trb_arrow_linear_solver(const trb_assembly *assembly, int variant, SUNContext context);

#endif
