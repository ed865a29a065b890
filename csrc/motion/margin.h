/* Margins: how far a roller is from the onset or the end of its contacts with raceways and ribs.
 *
 * Where forces are evaluated, the largest interference of every contact is known, or its gap. It cannot change by more than the roller has
 * moved since, each coordinate times a bound of what it does to the interference. As long as that sum is smaller than the margin, what
 * touched still touches and what did not still does not: forces may then be followed along a tangent, which knows nothing of gaps. */
#ifndef TRB_MOTION_MARGIN_H
#define TRB_MOTION_MARGIN_H

#include "contact/pair.h"

/* Of the slow pairs that are on. */
typedef struct trb_margin_arms {
  trb_margin_arm of[TRB_N_PAIRS];
  int            row[TRB_N_PAIRS]; /* in the table of pairs */
  int            n;
} trb_margin_arms;

trb_margin_arms trb_margin_arms_of(const trb_model *m);
/* Whether every contact is proven to change its interference by less than a share of its margin. place: the roller's state at which the
 * margins, one a row of the table of pairs, hold; step: from there, of the same coordinates; turn: of the frame R since then, rad. */
int trb_margin_holds(const trb_margin_arms *arms, const trb_drive *drive, const double *margin, double share, const double *place,
                     const double *step, double turn);

#endif
