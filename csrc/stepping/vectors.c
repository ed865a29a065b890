#include "stepping/vectors.h"

typedef void use_function(N_Vector v);

static use_function *const variants[] = {
    trb_vector_use_scalar,
    trb_vector_use_base,
#ifdef TRB_HAVE_AVX2
    trb_vector_use_avx2,
#endif
#ifdef TRB_HAVE_AVX512
    trb_vector_use_avx512,
#endif
};

void trb_vector_use(N_Vector v, int variant) { variants[variant](v); }
