#if TRB_SUNDIALS_CVODES
#include <cvodes/cvodes.h>
#else
#include <cvode/cvode.h>
#endif
#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_version.h>

#ifndef SUNDIALS_DOUBLE_PRECISION
#error "SUNDIALS was not built for double precision"
#endif

int trb_probe(void);

int trb_probe(void) {
  SUNContext context = 0;
#if SUNDIALS_VERSION_MAJOR >= 7
  if (SUNContext_Create(SUN_COMM_NULL, &context)) return 1;
#else
  if (SUNContext_Create(0, &context)) return 1;
#endif
  N_Vector        vector = N_VNew_Serial(3, context);
  void           *cvode  = CVodeCreate(CV_BDF, context);
  void           *erk    = ERKStepCreate(0, 0, vector, context);
  SUNMatrix       matrix = SUNMatNewEmpty(context);
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  return !(cvode && erk && matrix && solver);
}
