/* The arrow matrix: rollers couple only through the cage, so the Jacobian has a block a roller, a border to the cage and the cage's own
 * block. Systems with it are solved by eliminating the rollers onto the cage (Schur complement): linear in the number of rollers.
 * The rollers' blocks are small and serve many solves, so their inverses are kept. */
#ifndef TRB_STEPPING_ARROW_H
#define TRB_STEPPING_ARROW_H

#include "base/status.h"
#include "stepping/blocks.h"

typedef struct trb_arrow {
  int              n;         /* rollers */
  int              with_cage; /* 0: the cage's part is the identity and uncoupled */
  double           gamma;     /* of the last I - gamma J that this was made */
  trb_arrow_block *rollers;   /* n */
  double           cage[TRB_NC][TRB_NC];
} trb_arrow;

typedef struct trb_arrow_factors {
  const trb_block_kernels *kernels;
  int                      n;
  double                   gamma; /* of the matrix; 0: none was factored */
  trb_arrow_factor_block  *rollers;
  double                   lu[TRB_NC][TRB_NC]; /* of the Schur complement */
  int                      pivot[TRB_NC];
} trb_arrow_factors;

trb_status trb_arrow_create(int n_rollers, int with_cage, trb_arrow **arrow, trb_message *message);
void       trb_arrow_free(trb_arrow *arrow);
void       trb_arrow_zero(trb_arrow *arrow);
void       trb_arrow_copy(const trb_arrow *from, trb_arrow *to);
/* arrow = c arrow + I */
void trb_arrow_scale_add_identity(trb_arrow *arrow, double c);

/* variant: index of the kernels' instruction set. */
trb_status trb_arrow_factors_create(int n_rollers, int variant, trb_arrow_factors **factors, trb_message *message);
void       trb_arrow_factors_free(trb_arrow_factors *factors);
/* 1 if the matrix is regular. */
int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *factors);
/* x: rollers then cage, overwritten by the solution. */
void trb_arrow_solve(const trb_arrow_factors *factors, double *x);

#endif
