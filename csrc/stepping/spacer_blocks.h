/* What a spacer does to the Jacobian (motion/spacer.h). */
#ifndef TRB_STEPPING_SPACER_BLOCKS_H
#define TRB_STEPPING_SPACER_BLOCKS_H

#include "stepping/arrow.h"

/* Takes a system's blocks, borders and its part of the hub, which are those of rollers with orbits of their own, to those of rollers that a
 * spacer holds at a state; nothing where there is none. Terms of a displacement over the pitch radius are left out. */
void trb_spacer_blocks(const trb_dynamics *d, const double *y, trb_arrow *arrow);

#endif
