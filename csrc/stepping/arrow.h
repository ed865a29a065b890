/* The Jacobian as a matrix in the shape of an arrow, and systems with it (docs/theory/numerics.md#arrow-shaped-system). Rollers act on the hub, all
 * bodies that are no rolling elements, and not on each other: I - gamma J has a small block for each roller, borders in the columns and rows of the
 * hub, and the hub's block. Rollers are eliminated first. A roller's borders have only the parts of the hub on whose bodies it acts. One
 * factorisation is used for many solutions, so the inverses of blocks are stored. */
#ifndef TRB_STEPPING_ARROW_H
#define TRB_STEPPING_ARROW_H

#include "base/status.h"
#include "stepping/followers.h"

typedef struct trb_arrow_factors {
  const trb_block_kernels *kernels;
  int                      n;
  double                   gamma;   /* of the system that was factored; 0: none was */
  trb_arrow_factor_block  *rollers; /* of each */
  double                  *held;    /* of each: gamma of its inverse; 0: there is none */
  trb_arrow_factor_border *borders; /* of each */
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
/* Of I - gamma J with n chosen rollers (NULL: the first n); 1 if it is regular. */
int trb_arrow_factor(const trb_arrow *arrow, double gamma, const int *chosen, int n, trb_arrow_factors *factors);
/* The same where no roller's block has changed since its inverse was found: inverses for this gamma are used again. */
int trb_arrow_factor_again(const trb_arrow *arrow, double gamma, const int *chosen, int n, trb_arrow_factors *factors);
/* The inverse of a roller's block alone, likewise. */
int trb_arrow_factor_alone(const trb_arrow *arrow, double gamma, int roller, trb_arrow_factors *factors);
/* x: rollers then hub, overwritten by the solution; see trb_block_kernels. */
void trb_arrow_solve(const trb_arrow_factors *factors, double *x);

#endif
