/* Vectors of the integrator: SUNDIALS' serial vector with the operations of a kernel variant. Its norm must know which entries belong to
 * which body, and an operation of SUNDIALS sees nothing but vectors. So the numbers of entries are stored in the memory behind the last
 * entry, which has room for them; clones inherit them and the operations. */
#ifndef TRB_STEPPING_VECTORS_H
#define TRB_STEPPING_VECTORS_H

#include "system/assembly.h"
#include "stepping/sundials_shim.h"

/* Entries of a state that control the step: those of the rollers, then those of each body of the hub. */
typedef struct trb_body_entries {
  int           n_rollers;
  int           n_bodies;                                 /* of the hub */
  int           size[TRB_MOST_MEMBERS * TRB_MOST_BODIES]; /* of each */
  const double *swings; /* of each roller: share that skew, tilt and their spins have of their error; NULL: they count whole */
} trb_body_entries;

/* Length of the memory behind the entries. */
enum { TRB_VECTOR_ROOM = (sizeof(trb_body_entries) + sizeof(double) - 1) / sizeof(double) };

trb_body_entries trb_body_entries_of(const trb_assembly *assembly);

/* A vector over n values that the caller owns, which have TRB_VECTOR_ROOM more behind them; variant: index into trb_kernel_variants. NULL:
 * out of memory. */
N_Vector trb_vector_over(double *values, int n, const trb_body_entries *entries, int variant, SUNContext context);

/* Put in the operations of a variant. */
void trb_vector_use_scalar(N_Vector v);
void trb_vector_use_base(N_Vector v);
void trb_vector_use_avx2(N_Vector v);
void trb_vector_use_avx512(N_Vector v);

#endif
