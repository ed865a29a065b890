/* Newton's method for the equations of an implicit step, as a nonlinear solver of SUNDIALS. */
#ifndef TRB_STEPPING_NEWTON_H
#define TRB_STEPPING_NEWTON_H

#include <sundials/sundials_nonlinearsolver.h>

#include "stepping/sundials_shim.h"

/* like: a vector of the state's length. Its first n_main entries are n_bodies bodies of the same size and one more, which has what is left
 * of them. The entries after those are integrals that no force reads. NULL if out of memory. */
SUNNonlinearSolver trb_newton_solver(N_Vector like, int n_main, int n_bodies, int size, SUNContext context);

/* Whether solves fail: the last one that was not broken off by an evaluation or a Jacobian that failed, or more than a tenth of those before. */
int trb_newton_troubled(SUNNonlinearSolver solver);
/* Whether slopes are being taken again within a solve: all of them, then. */
int trb_newton_renewing(SUNNonlinearSolver solver);
/* Whether the slopes of a body are to be taken again, as the last first correction left too much of what its equations lacked, or as it lacked
 * most when a solve failed. */
int trb_newton_is_poor(SUNNonlinearSolver solver, int body);
/* Forget which solves failed, and what corrections left. */
void trb_newton_forget(SUNNonlinearSolver solver);

#endif
