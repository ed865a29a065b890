#include "stepping/arrow_solver.h"

#include <string.h>

#include "stepping/sundials_context.h"

trb_arrow *trb_arrow_of(SUNMatrix matrix) { return matrix->content; }

static SUNMatrix_ID matrix_id(SUNMatrix matrix)
{
  (void)matrix;
  return SUNMATRIX_CUSTOM;
}

static void matrix_destroy(SUNMatrix matrix)
{
  if (matrix == NULL) return;
  trb_arrow_free(matrix->content);
  matrix->content = NULL;
  SUNMatFreeEmpty(matrix);
}

SUNMatrix trb_arrow_matrix(int n_rollers, int hub_width, SUNContext context)
{
  SUNMatrix  matrix = trb_sundials_has_room(1) ? SUNMatNewEmpty(context) : NULL;
  trb_arrow *arrow = NULL;
  if (matrix == NULL) return NULL;
  if (trb_arrow_create(n_rollers, hub_width, &arrow, NULL) != TRB_OK) {
    SUNMatFreeEmpty(matrix);
    return NULL;
  }
  matrix->content = arrow;
  matrix->ops->getid = matrix_id;
  matrix->ops->destroy = matrix_destroy;
  return matrix;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver solver)
{
  (void)solver;
  return SUNLINEARSOLVER_DIRECT;
}

/* > 0: singular, the integrator may try again with another step. */
static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix)
{
  const trb_arrow *arrow = trb_arrow_of(matrix);
  return trb_arrow_factor(arrow, arrow->gamma, NULL, arrow->n, solver->content) ? 0 : 1;
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance)
{
  double       *to = N_VGetArrayPointer(x);
  const double *from = N_VGetArrayPointer(b);
  (void)tolerance;
  (void)matrix;
  if (to != from) memcpy(to, from, (size_t)N_VGetLength(b) * sizeof *to);
  trb_arrow_solve(solver->content, to);
  return 0;
}

static int solver_free(SUNLinearSolver solver)
{
  if (solver == NULL) return 0;
  trb_arrow_factors_free(solver->content);
  solver->content = NULL;
  SUNLinSolFreeEmpty(solver);
  return 0;
}

/* Amplitudes follow their rates. */
static trb_status follow(const trb_assembly *assembly, trb_arrow_factors *factors)
{
  int entries[TRB_MOST_MEMBERS * TRB_MOST_BODIES * TRB_MOST_MODES][2], n = 0;
  for (int k = 0; k < assembly->n; k++) {
    const trb_system *system = &assembly->members[k];
    for (int b = 0; b < system->n_bodies; b++) {
      const trb_body *body = &system->bodies[b];
      for (int i = 0; body->modes != NULL && i < body->modes->n; i++, n++) {
        double per[2];
        entries[n][0] = body->first - trb_state_hub(system) + body->kind->amplitude(body, i, per);
        entries[n][1] = entries[n][0] + 1;
      }
    }
  }
  return n > 0 ? trb_arrow_factors_follow(factors, n, (const int (*)[2])entries, NULL) : TRB_OK;
}

SUNLinearSolver trb_arrow_linear_solver(const trb_assembly *assembly, int variant, SUNContext context)
{
  const trb_layout  *layout = &assembly->members[0].layout;
  SUNLinearSolver    solver = trb_sundials_has_room(1) ? SUNLinSolNewEmpty(context) : NULL;
  trb_arrow_factors *factors = NULL;
  if (solver == NULL) return NULL;
  if (trb_arrow_factors_create(layout->n_rollers, layout->hub_width, variant, &factors, NULL) != TRB_OK ||
      follow(assembly, factors) != TRB_OK) {
    trb_arrow_factors_free(factors);
    SUNLinSolFreeEmpty(solver);
    return NULL;
  }
  solver->content = factors;
  solver->ops->gettype = solver_type;
  solver->ops->setup = solver_setup;
  solver->ops->solve = solver_solve;
  solver->ops->free = solver_free;
  return solver;
}
