/* The Jacobian's part of bodies that deform: what contacts of rollers do to the amplitudes of their modes, and these to the contacts. */
#ifndef TRB_STEPPING_MODAL_H
#define TRB_STEPPING_MODAL_H

#include "motion/dynamics.h"
#include "stepping/arrow.h"
#include "stepping/coupling.h"

/* Of one body. */
typedef struct trb_modal {
  int              n;       /* modes */
  trb_modal_slopes slopes;  /* of the roller under way */
  double          *pulls;   /* [entry of the hub][mode]: slopes of the force on the mode, summed over rollers */
  double          *rows;    /* of the slopes */
  size_t           room[2]; /* entries of the slopes, and of the pulls */
} trb_modal;

/* In a memory, with which it is freed; NULL: out of memory. */
trb_modal *trb_modal_create(trb_memory *memory, const trb_body *body, int hub_width);
/* Before the rollers of a Jacobian. */
void trb_modal_start(trb_modal *modal);
/* After each roller that touches the body: slopes are added to zeros. */
void trb_modal_clear(trb_modal *modal);
/* Adds what a roller that touches the body gives: to its borders, to the slopes of the loads on the hub's coordinates, and to the pulls.
 * first: of the body's coordinates in the hub. */
void trb_modal_add(trb_modal *modal, const trb_dynamics *d, int roller, const trb_coupling *k, int first, trb_arrow *arrow,
                   trb_wrench *changes);
/* Adds the pulls to the hub's block. */
void trb_modal_finish(const trb_modal *modal, const trb_body *body, int first, trb_arrow *arrow);

/* How many coordinates of a body come before those of its modes. */
static inline int trb_rigid_coordinates(const trb_body *body)
{
  double per[2];
  return body->modes == NULL ? body->size : body->kind->amplitude(body, 0, per);
}

#endif
