#include "stepping/blocks.h"

#include "base/variant.h"

#define VARIANT(name) &trb_block_kernels_##name,
static const trb_block_kernels *const variants[] = {TRB_VARIANTS(VARIANT)};

const trb_block_kernels *trb_block_kernels_of(int variant) { return variants[variant]; }
