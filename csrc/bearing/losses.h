/* The one list of losses, and the lists of works and of shares in the shaft's torque. They make the powers of a load, the quadratures of
 * the state and the fields power_*, loss_*, work_* and inner_torque_* of a record, which files, plots and summaries read by their names. A
 * row of the table of pairs (contact/pair.h) says where each mechanism of the pair is booked.
 *
 * F(X, name, sense, is_on, text). TAKES: the mechanism never gives energy; EITHER: it may, at a body. is_on: whether parameters p can have
 * such a loss; a state has quadratures up to the last loss that is on. Fields read "loss <text>" and "energy lost <text>". */
#ifndef TRB_BEARING_LOSSES_H
#define TRB_BEARING_LOSSES_H

/* Of pairs with a roller. */
#define TRB_ROLLER_LOSSES(F, X) \
  F(X, traction_outer,   TAKES,  1, "by sliding at the outer raceway") \
  F(X, traction_inner,   TAKES,  1, "by sliding at the inner raceway") \
  F(X, rolling,          EITHER, 1, "by rolling resistance") \
  F(X, rolling_pressure, EITHER, 1, "by the rolling film's pressure force, which may also give energy") \
  F(X, rib,              TAKES,  1, "at the back-face rib; of cylindrical rollers at all ribs against the ends towards +z") \
  F(X, front_rib,        TAKES,  1, "at the front rib; of cylindrical rollers at all ribs against the ends towards -z") \
  F(X, pocket,           TAKES,  1, "by friction in the pockets") \
  F(X, damping,          TAKES,  1, "by normal damping") \
  F(X, drag,             TAKES,  p->effects.oil_fill > 0.0, "by drag of the oil on rollers and cage") \
  F(X, pocket_film,      TAKES,  p->pocket.film > 0.0, "in the oil films between rollers and pockets")

/* Of pairs without one. */
#define TRB_HUB_LOSSES(F, X) \
  F(X, land_film, TAKES, p->effects.guidance != TRB_GUIDANCE_ROLLERS, "in the oil film between cage and land") \
  F(X, land,      TAKES, p->effects.guidance != TRB_GUIDANCE_ROLLERS, "by friction of the cage on the land") \
  F(X, support,   TAKES, p->inner_ring.free > 0.0 || p->outer_ring.free > 0.0, "by damping between free rings and the surroundings") \
  F(X, vibration, TAKES, p->cage.n_modes > 0.0, "by damping of the cage's own vibrations")

#define TRB_LOSSES(F, X) TRB_ROLLER_LOSSES(F, X) TRB_HUB_LOSSES(F, X)

/* Works put in: F(X, name, text), each a quadrature and a field work_*. */
#define TRB_WORKS(F, X) \
  F(X, shaft,   "work put in by the shaft's torque") \
  F(X, ring,    "work put in by motion of the inner ring's position, or by the loads on a free ring") \
  F(X, gravity, "work of gravity (minus the change of potential energy)")

/* TRB_TORQUES(F, X): F(X, name, text). The field reads "share of <text> in the shaft's torque". */
#define TRB_TORQUES(F, X) \
  F(X, traction,  "raceway sliding friction") \
  F(X, rolling,   "rolling resistance") \
  F(X, rib,       "the back-face rib") \
  F(X, front_rib, "the front rib") \
  F(X, land,      "the cage on the inner ring's land")

#define TRB_LOSS_ENUM(X, name, sense, is_on, text) TRB_LOSS_##name,
/* What a roller does to the right-hand side has no others. */
enum { TRB_ROLLER_LOSSES(TRB_LOSS_ENUM, 0) TRB_N_ROLLER_LOSSES };
enum { TRB_LAST_ROLLER_LOSS = TRB_N_ROLLER_LOSSES - 1, TRB_HUB_LOSSES(TRB_LOSS_ENUM, 0) TRB_N_LOSSES };
#undef TRB_LOSS_ENUM

enum {
#define TRB_TORQUE_ENUM(X, name, text) TRB_TORQUE_##name,
  TRB_TORQUES(TRB_TORQUE_ENUM, 0)
#undef TRB_TORQUE_ENUM
      TRB_N_TORQUES
};

/* Quadratures of the energy audit (docs/theory/energy.md#quadratures): works, then losses; each has its field of the same name in a record. */
#define TRB_QUADRATURE_OF_WORK(X, name, text) X(work_##name)
#define TRB_QUADRATURE_OF_LOSS(X, name, sense, is_on, text) X(loss_##name)
#define TRB_QUADRATURES(X) TRB_WORKS(TRB_QUADRATURE_OF_WORK, X) TRB_LOSSES(TRB_QUADRATURE_OF_LOSS, X)

enum {
#define TRB_QUADRATURE_ENUM(name) TRB_Q_##name,
  TRB_QUADRATURES(TRB_QUADRATURE_ENUM)
#undef TRB_QUADRATURE_ENUM
      TRB_N_QUADRATURES
};

/* The first loss. */
enum { TRB_Q_losses = TRB_N_QUADRATURES - TRB_N_LOSSES };

/* How a row of a system says where it books: the number of an entry of a list, counted from 1. */
#define TRB_BOOK(entry) (1 + (entry))

typedef enum trb_sense { TRB_SENSE_TAKES, TRB_SENSE_EITHER } trb_sense;

#endif
