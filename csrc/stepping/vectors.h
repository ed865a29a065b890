/* Vectors of the integrator: SUNDIALS' serial vector with the operations of a kernel variant; clones inherit them. */
#ifndef TRB_STEPPING_VECTORS_H
#define TRB_STEPPING_VECTORS_H

#include "stepping/sundials_shim.h"

void trb_vector_use_scalar(N_Vector v);
void trb_vector_use_base(N_Vector v);
void trb_vector_use_avx2(N_Vector v);
void trb_vector_use_avx512(N_Vector v);

/* variant: index into trb_kernel_variants. */
void trb_vector_use(N_Vector v, int variant);

#endif
