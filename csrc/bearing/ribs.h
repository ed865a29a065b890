/* Conical ribs of the rings, with the spherical ends of rollers that meet them, their Hertz contacts and films. */
#ifndef TRB_BEARING_RIBS_H
#define TRB_BEARING_RIBS_H

#include "bearing/model.h"

/* The ribs of a model: a tapered bearing has that of the inner ring against the large ends alone, a cylindrical one all, whether they act or not. */
trb_status trb_ribs_fill(trb_model *model, trb_message *message);

/* Whether cylindrical rollers have a rib that acts at either end. */
int trb_between_ribs(const trb_params *params);

#endif
