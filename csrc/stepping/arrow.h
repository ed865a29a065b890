/* The arrow matrix: rollers couple only through the cage, so the Jacobian has a block a roller, a border to the cage and the cage's own
 * block. Systems with it are solved by eliminating the rollers onto the cage (Schur complement): linear in the number of rollers.
 * The rollers' blocks are small and serve many solves, so their inverses are kept. */
#ifndef TRB_STEPPING_ARROW_H
#define TRB_STEPPING_ARROW_H

#include "base/status.h"
#include "bearing/state.h"

/* TRB_NP: a roller's entries, padded. */
enum { TRB_NR = TRB_ROLLER_SIZE, TRB_NC = TRB_CAGE_SIZE, TRB_NP = 12 };

/* Row-major blocks of one roller. */
typedef struct trb_arrow_block {
  double own[TRB_NR][TRB_NR];     /* d roller / d roller */
  double to_cage[TRB_NR][TRB_NC]; /* d roller / d cage */
  double from[TRB_NC][TRB_NR];    /* d cage / d roller */
  int    coupled;                 /* 0: both borders are zero */
} trb_arrow_block;

typedef struct trb_arrow {
  int              n;             /* rollers */
  int              with_cage;     /* 0: the cage's part is the identity and uncoupled */
  trb_arrow_block *rollers;       /* n */
  double           cage[TRB_NC][TRB_NC];
} trb_arrow;

/* Columns are contiguous, so that a product with a vector is a sum of columns. */
typedef struct trb_arrow_factor_block {
  double inverse[TRB_NR][TRB_NP]; /* column by column: inverse of the roller's block */
  double solved[TRB_NC][TRB_NP];  /* column by column: inverse to_cage */
  double from[TRB_NR][TRB_NC];    /* column by column: border of the cage's rows */
  int    coupled;
} trb_arrow_factor_block;

typedef struct trb_arrow_factors {
  int                     n;
  trb_arrow_factor_block *rollers;
  double                  lu[TRB_NC][TRB_NC]; /* of the Schur complement */
  int                     pivot[TRB_NC];
} trb_arrow_factors;

trb_status trb_arrow_create(int n_rollers, int with_cage, trb_arrow **arrow, trb_message *message);
void       trb_arrow_free(trb_arrow *arrow);
void       trb_arrow_zero(trb_arrow *arrow);
void       trb_arrow_copy(const trb_arrow *from, trb_arrow *to);
/* arrow = c arrow + I */
void trb_arrow_scale_add_identity(trb_arrow *arrow, double c);

trb_status trb_arrow_factors_create(int n_rollers, trb_arrow_factors **factors, trb_message *message);
void       trb_arrow_factors_free(trb_arrow_factors *factors);
/* 1 if the matrix is regular. */
int trb_arrow_factor(const trb_arrow *arrow, trb_arrow_factors *factors);
/* x: rollers then cage, overwritten by the solution. */
void trb_arrow_solve(const trb_arrow_factors *factors, double *x);

#endif
