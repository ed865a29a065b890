/* A SUNDIALS built with SUNDIALS_ENABLE_PYTHON (LLNL's wheel on PyPI is one) frees, with its own objects, the tables of functions
 * that its Python bindings hang on them: through the functions below, which the bindings define. Without the bindings every
 * such table is a null pointer, and there is nothing to free. */

#define TRB_NOTHING_TO_FREE(name) \
  void name(void *table); \
  void name(void *table) { (void)table; }

TRB_NOTHING_TO_FREE(SUNContextFunctionTable_Destroy)
TRB_NOTHING_TO_FREE(SUNDomEigEstimatorFunctionTable_Destroy)
TRB_NOTHING_TO_FREE(SUNLinearSolverFunctionTable_Destroy)
TRB_NOTHING_TO_FREE(SUNLoggerFunctionTable_Destroy)
TRB_NOTHING_TO_FREE(SUNNonlinearSolverFunctionTable_Destroy)
TRB_NOTHING_TO_FREE(SUNStepperFunctionTable_Destroy)
TRB_NOTHING_TO_FREE(arkode_user_supplied_fn_table_destroy)
TRB_NOTHING_TO_FREE(cvode_user_supplied_fn_table_destroy)
TRB_NOTHING_TO_FREE(kinsol_user_supplied_fn_table_destroy)
TRB_NOTHING_TO_FREE(mristepinnerstepper_user_supplied_fn_table_destroy)
