/* Newton's method for the equations of an implicit step, as a nonlinear solver of SUNDIALS. */
#ifndef TRB_STEPPING_NEWTON_H
#define TRB_STEPPING_NEWTON_H

#include <sundials/sundials_nonlinearsolver.h>

#include "stepping/sundials_shim.h"

enum { TRB_NEWTON_MOST = 12 }; /* iterations at most */

/* like: a vector of the state's length. NULL if out of memory. */
SUNNonlinearSolver trb_newton_solver(int max_iterations, N_Vector like, SUNContext context);

/* Whether the last solve failed. */
int trb_newton_troubled(SUNNonlinearSolver solver);
/* Forget whether the last solve failed. */
void trb_newton_forget(SUNNonlinearSolver solver);

#endif
