/* The Jacobian as a matrix in the shape of an arrow, and systems with it (docs/theory/numerics.md#arrow-shaped-system).
 *
 * Rollers do not act on each other but on the cage alone. If the rollers come first in the state and the cage last, the system matrix
 * I - gamma J therefore has a small block A_j on the diagonal for each roller j, a border B_j in the columns of the cage, a border C_j in
 * its rows, and the cage's block D; all else is zero. Such a system is solved by eliminating the rollers: the Schur complement
 * S = D - sum C_j A_j^-1 B_j gives the cage's part of the solution, and that gives the part of each roller. The effort is
 * proportional to the number of rollers. A roller that does not touch its pocket has no borders. One factorisation is used for many
 * solutions and the blocks are small, so their inverses are computed and stored. */
#ifndef TRB_STEPPING_ARROW_H
#define TRB_STEPPING_ARROW_H

#include "base/status.h"
#include "stepping/blocks.h"

/* The Jacobian J. */
typedef struct trb_arrow {
  int               n;                    /* rollers */
  int               with_cage;            /* 0: there is no cage, its block is zero */
  double            gamma;                /* of the system matrix I - gamma J */
  trb_arrow_block  *rollers;              /* n */
  trb_arrow_border *borders;              /* n */
  double            cage[TRB_NC][TRB_NC]; /* column by column */
} trb_arrow;

typedef struct trb_arrow_factors {
  const trb_block_kernels *kernels;
  int                      n;
  double                   gamma; /* of the system that was factored; 0: none was */
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
