/* Kinds of bodies without coordinates: a ring at rest, a ring that is placed and turned as prescribed, and what fills the room between the
 * bodies, which rests. Contacts read the pose of a ring and ask no more. */
#ifndef TRB_BODY_RING_H
#define TRB_BODY_RING_H

#include "body/body.h"

extern const trb_body_kind trb_ring_at_rest, trb_ring_turning, trb_ring_prescribed, trb_fluid_at_rest;

/* The prescribed pose: displacement and misalignment (rotation vector in the x-y plane), with their rates, and the shaft's speed. */
void trb_drive_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
                     double shaft_speed, trb_drive *drive);

#endif
