/* Rows of pockets: their faces as a user gives them, checked, and their places. */
#ifndef TRB_BEARING_POCKETS_H
#define TRB_BEARING_POCKETS_H

#include "bearing/model.h"

/* Fills a row of pockets of a cage with arrays of the model, whose geometry is known: faces of every pocket, one pocket after the other, without
 * those that the effects leave out. A pocket without faces holds no roller. */
trb_status trb_pockets_fill(trb_model *model, const trb_pocket_inputs *given, const trb_cage_inputs *cage, const trb_face *faces,
                            int n_faces, trb_pockets *row, trb_message *message);

#endif
