#include "stepping/blocks.h"

static const trb_block_kernels *const variants[] = {
    &trb_block_kernels_scalar,
    &trb_block_kernels_base,
#ifdef TRB_HAVE_AVX2
    &trb_block_kernels_avx2,
#endif
#ifdef TRB_HAVE_AVX512
    &trb_block_kernels_avx512,
#endif
};

const trb_block_kernels *trb_block_kernels_of(int variant) { return variants[variant]; }
