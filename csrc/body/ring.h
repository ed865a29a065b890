/* Kinds of bodies without coordinates: a ring at rest, a ring that is placed and turned as prescribed, and what fills the room between the
 * bodies, which rests. Contacts read the pose of a ring and ask no more. */
#ifndef TRB_BODY_RING_H
#define TRB_BODY_RING_H

#include "body/body.h"

extern const trb_body_kind trb_ring_at_rest, trb_ring_turning, trb_ring_prescribed, trb_fluid_at_rest;

#endif
