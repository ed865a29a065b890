/* The differences between SUNDIALS 6.4 and 7.x, in one place. SUNDIALS headers appear only in stepping/. */
#ifndef TRB_STEPPING_SUNDIALS_SHIM_H
#define TRB_STEPPING_SUNDIALS_SHIM_H

#include <arkode/arkode_erkstep.h>
#ifdef TRB_SUNDIALS_CVODES
#include <cvodes/cvodes.h>
#include <cvodes/cvodes_ls.h>
#else
#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#endif
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_version.h>

#define TRB_SUNDIALS_AT_LEAST(major, minor) \
  (SUNDIALS_VERSION_MAJOR > (major) || (SUNDIALS_VERSION_MAJOR == (major) && SUNDIALS_VERSION_MINOR >= (minor)))

#if TRB_SUNDIALS_AT_LEAST(7, 0)
#define TRB_SUN_NO_COMM SUN_COMM_NULL
#else
#define TRB_SUN_NO_COMM NULL
#endif

/* From 7.1 on the steppers of ARKODE share their functions. */
#if TRB_SUNDIALS_AT_LEAST(7, 1)
#define TRB_ARK(name) ARKode##name
#else
#define TRB_ARK(name) ERKStep##name
#endif

#endif
