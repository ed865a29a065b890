/* A cage that deforms by its natural modes (docs/theory/cage.md#an-elastic-cage): the coordinates of the rigid cage, which are those of its
 * mean axes, then, of one mode after the other, W q and W q'/w, q being its amplitude, w its angular frequency, and W the same but for slow
 * modes, of which it is trb_least_mode_frequency. Both are velocities and are integrated to their tolerance. Modes act on each other by
 * Coriolis forces, as the cage turns, and on the rigid motion through the contacts alone. */
#ifndef TRB_BODY_ELASTIC_CAGE_H
#define TRB_BODY_ELASTIC_CAGE_H

#include "body/body.h"
#include "body/cage.h"

extern const trb_body_kind trb_body_elastic_cage;

/* The row of a cage with these modes. */
trb_body trb_elastic_cage_of(const trb_modes *modes, const char *name);

#endif
