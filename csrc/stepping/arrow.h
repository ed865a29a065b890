/* The Jacobian as a matrix in the shape of an arrow, and systems with it (docs/theory/numerics.md#arrow-shaped-system).
 *
 * Rollers do not act on each other but on the other bodies alone: the cage, and whatever else is not a rolling element. These bodies
 * together are the hub. If the rollers come first in the state and the hub last, the system matrix I - gamma J therefore has a small block
 * A_j on the diagonal for each roller j, a border B_j in the columns of the hub, a border C_j in its rows, and the hub's block D; all else
 * is zero. Such a system is solved by eliminating the rollers: the Schur complement S = D - sum C_j A_j^-1 B_j gives the hub's part of the
 * solution, and that gives the part of each roller. The effort is proportional to the number of rollers. A roller's borders have only the
 * parts of the hub on whose bodies it acts. One factorisation is used for many solutions and the blocks are small, so their inverses are computed and
 * stored. */
#ifndef TRB_STEPPING_ARROW_H
#define TRB_STEPPING_ARROW_H

#include "base/status.h"
#include "stepping/followers.h"

typedef struct trb_arrow_factors {
  const trb_block_kernels *kernels;
  int                      n;
  double                   gamma; /* of the system that was factored; 0: none was */
  trb_arrow_factor_block  *rollers;
  trb_arrow_factor_border *borders;
  trb_hub_factor           hub;
  trb_followers           *followers; /* entries of the hub that are eliminated first; NULL: none */
  trb_memory               memory;    /* of all arrays */
} trb_arrow_factors;

/* hub_width: entries of the hub, from 0. */
trb_status trb_arrow_create(int n_rollers, int hub_width, trb_arrow **arrow, trb_message *message);
void       trb_arrow_free(trb_arrow *arrow);
/* Adds parts of the hub, which are zero, to a roller's borders. */
void trb_arrow_add_parts(trb_arrow *arrow, int roller, unsigned parts);

/* variant: index of the kernels' instruction set. */
trb_status trb_arrow_factors_create(int n_rollers, int hub_width, int variant, trb_arrow_factors **factors, trb_message *message);
/* Entries of the hub whose rate is another one times a constant (stepping/followers.h): two for each, its own and that of the other one. */
trb_status trb_arrow_factors_follow(trb_arrow_factors *factors, int n, const int (*entries)[2], trb_message *message);
void       trb_arrow_factors_free(trb_arrow_factors *factors);
/* Of I - gamma J with n chosen rollers (NULL: the first n), which become the first ones of the system; 1 if it is regular. */
int trb_arrow_factor(const trb_arrow *arrow, double gamma, const int *chosen, int n, trb_arrow_factors *factors);
/* x: rollers then hub, overwritten by the solution; see trb_block_kernels. */
void trb_arrow_solve(const trb_arrow_factors *factors, double *x);

#endif
