/* Margins: proofs that no contact of a roller with raceways and ribs has begun or ended (docs/theory/numerics.md#margins-of-contacts).
 *
 * A tangent of the forces is wrong as soon as a contact begins or ends. Where forces are evaluated exactly, the largest interference of
 * each contact is known, or its gap; the size of either is the margin. An interference is a distance between a surface of the ring and a
 * point that is fixed in the roller. If the roller's coordinates change, it cannot change by more than the sum of all changes, each
 * multiplied by the largest arm by which that coordinate moves the point along the normal. The same holds for the ring, which seems to
 * move in the frame of a roller that orbits if it is displaced or misaligned. As long as the sum is smaller than the margin, bodies that
 * touched still touch and bodies that did not touch still do not. The sum is an upper bound and not an estimate;
 * csrc/tests/test_margin.c tries to break it. */
#ifndef TRB_MOTION_MARGIN_H
#define TRB_MOTION_MARGIN_H

#include "system/system.h"

/* Of the slow pairs that are on. */
typedef struct trb_margin_arms {
  trb_margin_arm of[TRB_MOST_PAIRS];
  int            row[TRB_MOST_PAIRS];  /* number of the pair in the system */
  int            body[TRB_MOST_PAIRS]; /* the ring */
  int            n;
} trb_margin_arms;

/* How far a ring's axis is from the bearing's axis. */
typedef struct trb_ring_offset {
  double lean;  /* sine of the angle between the axes */
  double aside; /* of the reference point from the bearing's axis, m */
  /* of a ring with coordinates: since the margins were found */
  double shifted; /* of its reference point, m */
  double leaned;  /* of its axis, rad */
} trb_ring_offset;

trb_margin_arms trb_margin_arms_of(const trb_system *system);
/* Of every body of a system that is a ring. */
void trb_ring_offsets_of(const trb_system *system, const trb_body_at *bodies, trb_ring_offset *offsets);
/* Contacts, bit by arm, that are not proven to change their interference by less than a share of their margin. rings: of every body; place: the
 * roller's state at which the margins, one a pair, hold; step: from there, of the same coordinates; turn: of the frame R since then, rad. */
unsigned trb_margin_open(const trb_margin_arms *arms, const trb_ring_offset *rings, const double *margin, double share, const double *place,
                         const double *step, double turn);

#endif
