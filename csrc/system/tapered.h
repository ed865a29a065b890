/* The builder of a roller bearing, tapered or cylindrical: from its numbers to its bodies, surfaces and pairs. Records and files know these by name. */
#ifndef TRB_SYSTEM_TAPERED_H
#define TRB_SYSTEM_TAPERED_H

#include "system/system.h"

/* Bodies. */
enum { TRB_BODY_OUTER_RING, TRB_BODY_CAGE, TRB_BODY_INNER_RING, TRB_BODY_OIL, TRB_N_BODIES };

/* Pairs, in the order in which they are evaluated: X(name). Only cylindrical bearings have the last two: put new ones before. */
#define TRB_PAIRS(X) X(outer) X(inner) X(rib) X(front_rib) X(drag) X(pocket) X(inner_land) X(outer_land) X(cage_drag) X(outer_rib) X(outer_front_rib)

enum {
#define TRB_PAIR_ENUM(name) TRB_PAIR_##name,
  TRB_PAIRS(TRB_PAIR_ENUM)
#undef TRB_PAIR_ENUM
      TRB_N_PAIRS
};
enum { TRB_N_TAPERED_PAIRS = TRB_PAIR_outer_rib };

/* model: must live as long as the system; freed by trb_system_free. */
trb_status trb_system_tapered(const trb_model *model, trb_system **system, trb_message *message);
void       trb_system_free(trb_system *system);

#endif
