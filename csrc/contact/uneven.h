/* What surfaces off their true form do to a contact of a roller with a raceway
 * (docs/theory/contacts.md#surfaces-off-their-true-form).
 *
 * The interference of a node is less by the depth h there, so that the elastic energy of the contact depends on the angles psi from which the
 * depths are read: that of the roller on the race, and that of the contact on the roller. What follows from the energy alone is right
 * whatever the shape of the surface: a normal load q is accompanied by the generalised force q dh/dpsi. On a race psi is the angle about
 * the ring's axis of the point of the roller's axis from which the node's contact is seen, so the force is q (dh/dpsi)/rho there, across
 * the plane of ring axis and point, with rho the distance from the ring's axis, and its opposite acts on the ring at the same point. On a
 * roller psi is minus the angle that it has turned by in its orbiting frame, and the force is q (dh/dpsi) a_z/r along the tangential
 * direction, at the point where the normal meets the bearing's axis: it turns the roller, and no ring about its axis. */
#ifndef TRB_CONTACT_UNEVEN_H
#define TRB_CONTACT_UNEVEN_H

#include "contact/kernels.h"

/* Of the nodes of a tile of contacts. */
struct trb_uneven {
  double depth[TRB_LANE_STRIDE]; /* m */
  double rate[TRB_LANE_STRIDE];  /* of the depth, m/s */
  /* for a unit of load: force on the roller, its moment about the roller's centre of mass, and that of the opposite force about ring->centre */
  double fx[TRB_LANE_STRIDE], fy[TRB_LANE_STRIDE], fz[TRB_LANE_STRIDE];
  double mx[TRB_LANE_STRIDE], my[TRB_LANE_STRIDE], mz[TRB_LANE_STRIDE];
  double hx[TRB_LANE_STRIDE], hy[TRB_LANE_STRIDE], hz[TRB_LANE_STRIDE];
};

/* Whether a contact may be on a patch. azimuth: of the roller about the bearing's axis; turned: of the ring; spin: of the roller, rad. */
int trb_uneven_is_near(const trb_model *m, int race, int roller, double azimuth, double turned, double spin);

/* Fills the nodes of a contact, from `first` on. azimuth: of the frame of the contact's roller. */
void trb_uneven_fill(const trb_model *m, const trb_race_input *in, int roller, double azimuth, double spin, int first, trb_uneven *to);

#endif
