/* An assembly: bearings that are simulated together with one integrator, each a system of its own with its rollers, its cage and its oil. Their
 * state is one vector: the rollers of all bearings, the bodies of the hub, spin angles, quadratures; every system knows where its own entries lie.
 * Bearings on one shaft, or in one housing, share a body. The first system has it; in the others the ring is a part of it, and the forces of its
 * contacts act on it. The work that passes between them is booked in both. One bearing is an assembly of one. */
#ifndef TRB_SYSTEM_ASSEMBLY_H
#define TRB_SYSTEM_ASSEMBLY_H

#include "system/system.h"

/* Most bearings, and most coordinates of their bodies that are no rollers: the parts of a hub are bits of a word (stepping/blocks.h). */
enum { TRB_MOST_MEMBERS = 4, TRB_MOST_HUB = 31 * 12 };

typedef struct trb_assembly {
  trb_system members[TRB_MOST_MEMBERS];
  int        n;
} trb_assembly;

/* Copies systems, which must have been finished, and lays out their common state. */
trb_status trb_assembly_make(const trb_system *const *systems, int n, trb_assembly *assembly, trb_message *message);

/* The member that has an entry of the state; NULL: an entry of the tail. */
const trb_system *trb_assembly_owner(const trb_assembly *assembly, int index);

#endif
