/* A spacer in place of the cage: it holds all rollers at even spacing on one orbit (motion/spacer.h), and has no play, no friction and no
 * displacement. Its coordinates are those of a cage, of which only the turn moves. */
#ifndef TRB_BODY_SPACER_H
#define TRB_BODY_SPACER_H

#include "body/cage.h"

extern const trb_body_kind trb_body_spacer;

#endif
