/* The arrow matrix: rollers couple only through the cage, so the Jacobian has a block a roller, a border to the cage and the cage's own
 * block. Systems with it are solved by eliminating the rollers onto the cage (Schur complement): linear in the number of rollers.
 * The rollers' blocks are small and serve many solves, so their inverses are kept. */
#ifndef TRB_STEPPING_ARROW_H
#define TRB_STEPPING_ARROW_H

#include "base/status.h"
#include "stepping/blocks.h"

/* The Jacobian J. */
typedef struct trb_arrow {
  int               n;                    /* rollers */
  int               with_cage;            /* 0: the cage's part is zero and uncoupled */
  double            gamma;                /* of the system I - gamma J that is to be solved */
  trb_arrow_block  *rollers;              /* n */
  trb_arrow_border *borders;              /* n */
  double            cage[TRB_NC][TRB_NC]; /* column by column */
} trb_arrow;

typedef struct trb_arrow_factors {
  const trb_block_kernels *kernels;
  int                      n;
  double                   gamma; /* of the system; 0: none was factored */
  trb_arrow_factor_block  *rollers;
  trb_arrow_factor_border *borders;
  double                   cage[TRB_NC][TRB_NC]; /* column by column: inverse of the Schur complement */
} trb_arrow_factors;

trb_status trb_arrow_create(int n_rollers, int with_cage, trb_arrow **arrow, trb_message *message);
void       trb_arrow_free(trb_arrow *arrow);

/* variant: index of the kernels' instruction set. */
trb_status trb_arrow_factors_create(int n_rollers, int variant, trb_arrow_factors **factors, trb_message *message);
void       trb_arrow_factors_free(trb_arrow_factors *factors);
/* 1 if I - gamma J is regular. */
int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *factors);
/* x: rollers then cage, overwritten by the solution. */
void trb_arrow_solve(const trb_arrow_factors *factors, double *x);

#endif
