/* A roller that touches its pocket: slopes of the loads between roller and cage with each coordinate of either body. The pocket gives
 * the slopes with their relative motion (trb_pocket_slopes); here they are written in the coordinates of the state. */
#ifndef TRB_STEPPING_COUPLING_H
#define TRB_STEPPING_COUPLING_H

#include "contact/pair.h"

/* All vectors are in the roller's cylindrical frame. */
typedef struct trb_coupling {
  const trb_roller_pose *roller;
  const trb_cage_pose   *cage;
  trb_vec3               arm;           /* from the cage's centre of mass to the roller's, m */
  trb_vec3               force, moment; /* on the roller, about its centre of mass, N and N m */
  trb_slopes             slopes;
} trb_coupling;

/* Sets bodies and load; the slopes must be there before. */
void trb_coupling_place(trb_coupling *k, const trb_roller_pose *roller, const trb_cage_pose *cage, const trb_load *load);
/* Slope of the loads of roller and cage with a coordinate of the roller, and of the cage. */
trb_load trb_coupling_of_roller(const trb_coupling *k, int coordinate);
trb_load trb_coupling_of_cage(const trb_coupling *k, int coordinate);

#endif
