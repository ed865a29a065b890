/* The pockets of a model: their faces as a user gives them, checked, and where they stand. */
#ifndef TRB_BEARING_POCKETS_H
#define TRB_BEARING_POCKETS_H

#include "bearing/model.h"

/* Faces of every pocket, one pocket after the other, without those that the effects leave out. */
trb_status trb_pockets_fill_faces(trb_model *m, const trb_face *faces, int n_faces, trb_message *message);
/* Where each roller stands in the bearing, and each pocket in the cage. */
void trb_pockets_place(trb_model *m);

#endif
