/* The layout of the state vector (docs/theory/motion.md#coordinates): the coordinates of the rollers (body/roller.h), those of the bodies
 * of the hub (body/hub.h), then spin angles and quadratures.
 *
 * The frame R turns about the bearing axis with the kinematic cage angle. A roller's coordinates are cylindrical and are offsets from
 * pure rolling; its axis is given by skew and tilt in the frame (e_r, e_t, e_z) that orbits with it; its velocities are inertial
 * velocities that are written in orbiting frames. In steady rolling the whole vector stands still. The spin angle is in the tail of the
 * vector, as nothing depends on it. */
#ifndef TRB_BODY_STATE_H
#define TRB_BODY_STATE_H

#include "bearing/losses.h"
#include "body/cage.h"
#include "body/ring.h"
#include "body/roller.h"
#include "laws/smooth.h"

/* Quadratures of the energy audit (docs/theory/energy.md#quadratures): works, then losses; each has its field of the same name in a record. */
#define TRB_QUADRATURE_OF_WORK(X, name, text) X(work_##name)
#define TRB_QUADRATURE_OF_LOSS(X, name, sense, text) X(loss_##name)
#define TRB_QUADRATURES(X) TRB_WORKS(TRB_QUADRATURE_OF_WORK, X) TRB_LOSSES(TRB_QUADRATURE_OF_LOSS, X)

enum {
#define TRB_QUADRATURE_ENUM(name) TRB_Q_##name,
  TRB_QUADRATURES(TRB_QUADRATURE_ENUM)
#undef TRB_QUADRATURE_ENUM
      TRB_N_QUADRATURES
};

/* The first loss. */
enum { TRB_Q_losses = TRB_N_QUADRATURES - TRB_N_LOSSES };

/* Quadratures that a model has. */
static inline int trb_n_quadratures(const trb_model *m) { return TRB_Q_losses + m->n_losses; }

/* State vector: rollers, hub, then the tail: a spin angle per roller, the quadratures. The cage is the first body of the hub, in every
 * model. */
static inline int trb_state_roller(int roller) { return roller * TRB_ROLLER_SIZE; }
static inline int trb_state_hub(const trb_model *m) { return m->n_rollers * TRB_ROLLER_SIZE; }
static inline int trb_state_cage(const trb_model *m) { return trb_state_hub(m); }
static inline int trb_state_main_size(const trb_model *m) { return trb_state_hub(m) + trb_hub_width(m); }
static inline int trb_state_spin(const trb_model *m) { return trb_state_main_size(m); }
static inline int trb_state_quadrature(const trb_model *m) { return trb_state_spin(m) + m->n_rollers; }
static inline int trb_state_size(const trb_model *m) { return trb_state_quadrature(m) + trb_n_quadratures(m); }

/* Tolerance kind of every entry. */
trb_tolerance trb_state_tolerance(const trb_model *m, int index);

#endif
