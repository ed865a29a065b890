/* A cage that deforms by its natural modes (docs/theory/cage.md#an-elastic-cage): the coordinates of the rigid cage, which are those of its
 * mean axes, then, of one mode after the other, W q and W q'/w, q being its amplitude, w its angular frequency, and W that of the fastest mode. Both are
 * velocities and are integrated to their tolerance: then errors of all modes are as large at the faces, and none has a larger error of its
 * velocity. Modes act on each other by Coriolis forces, as
 * the cage turns, and on the rigid motion through the contacts alone. */
#ifndef TRB_BODY_ELASTIC_CAGE_H
#define TRB_BODY_ELASTIC_CAGE_H

#include "body/body.h"
#include "body/cage.h"

extern const trb_body_kind trb_body_elastic_cage;

/* The row of a cage with these modes. */
trb_body trb_elastic_cage_of(const trb_modes *modes, const char *name);

#endif
