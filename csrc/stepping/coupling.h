/* A roller that touches a body of the hub, as its pocket: slopes of the loads between both with each coordinate of either. The pair gives
 * the slopes with their relative motion (trb_slopes); here they are written in the coordinates of the state. */
#ifndef TRB_STEPPING_COUPLING_H
#define TRB_STEPPING_COUPLING_H

#include "body/body.h"
#include "contact/pair.h"

/* All vectors are in the roller's cylindrical frame. */
typedef struct trb_coupling {
  const trb_roller_pose *roller;
  const trb_body        *other;         /* body */
  const trb_rigid_pose  *body;          /* its pose */
  trb_vec3               arm;           /* from the body's centre of mass to the roller's, m */
  trb_vec3               force, moment; /* on the roller, about its centre of mass, N and N m */
  trb_slopes             slopes;
} trb_coupling;

/* Sets bodies and load; the slopes must be there before. */
void trb_coupling_place(trb_coupling *k, const trb_roller_pose *roller, const trb_body *other, const trb_rigid_pose *body,
                        const trb_load *load);
/* Slope of the loads of both with a coordinate of the roller, and of the other body. */
trb_load trb_coupling_of_roller(const trb_coupling *k, int coordinate);
trb_load trb_coupling_of_body(const trb_coupling *k, int coordinate);
/* The same with the amplitude of a mode of the other body, or with its rate, that changes by so much. */
trb_load trb_coupling_of_mode(const trb_coupling *k, int mode, int is_place, double by);
/* Motion of the roller relative to the other body with a coordinate of the roller, or of the other body, along the axes of the slopes:
 * displacement, then turn. */
void trb_coupling_along(const trb_coupling *k, int of_body, int coordinate, double along[6]);

#endif
