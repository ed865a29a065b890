#include "body/hub.h"

#include "body/cage.h"

/* The kinds of bodies of the hub, in the order of the state. The cage is the first: trb_state_cage relies on it. */
const trb_hub_kind *const trb_hub_table[] = {&trb_hub_cage};
const int                 trb_n_hub_kinds = (int)(sizeof trb_hub_table / sizeof trb_hub_table[0]);

_Static_assert(sizeof trb_hub_table / sizeof trb_hub_table[0] <= TRB_N_BODIES, "a body of the hub for each kind of body at most");
