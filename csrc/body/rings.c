#include "body/ring.h"

/* The kinds of the rings of a bearing. */
const trb_ring_kind *const trb_ring_table[TRB_N_RINGS] = {[TRB_RING_OUTER] = &trb_ring_at_rest, [TRB_RING_INNER] = &trb_ring_prescribed};
