/* What surfaces off their true form do to a contact of a roller with a raceway (docs/theory/contacts.md#surfaces-off-their-true-form). The
 * interference of a node is less by the depth h there, so the elastic energy depends on the angles psi from which depths are read, and a normal
 * load q is accompanied by the generalised force q dh/dpsi: on a race across the plane of ring axis and point, with its opposite on the ring at
 * the same point; on a roller along the tangential direction where the normal meets the bearing's axis, so that it turns the roller alone. */
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
