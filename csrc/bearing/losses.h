/* The one list of losses, and the lists of works and of shares in the shaft's torque. They make the powers of a load, the quadratures of
 * the state and the fields power_*, loss_*, work_* and inner_torque_* of a record, which files, plots and summaries read by their names. A
 * row of the table of pairs (contact/pair.h) says where each mechanism of the pair is booked.
 *
 * TRB_LOSSES(F, X): F(X, name, sense, text). TAKES: the mechanism never gives energy; EITHER: it may, at a body. Fields read "loss <text>"
 * and "energy lost <text>". */
#ifndef TRB_BEARING_LOSSES_H
#define TRB_BEARING_LOSSES_H

#define TRB_LOSSES(F, X) \
  F(X, traction_outer,   TAKES,  "by sliding at the outer raceway") \
  F(X, traction_inner,   TAKES,  "by sliding at the inner raceway") \
  F(X, rolling,          EITHER, "by rolling resistance") \
  F(X, rolling_pressure, EITHER, "by the rolling film's pressure force, which may also give energy") \
  F(X, rib,              TAKES,  "at the back-face rib") \
  F(X, front_rib,        TAKES,  "at the front rib") \
  F(X, pocket,           TAKES,  "by friction in the pockets") \
  F(X, damping,          TAKES,  "by normal damping") \
  F(X, drag,             TAKES,  "by drag of the oil on rollers") \
  F(X, land_film,        TAKES,  "in the oil film between cage and land") \
  F(X, land,             TAKES,  "by friction of the cage on the land")

/* Works put in: F(X, name, text), each a quadrature and a field work_*. */
#define TRB_WORKS(F, X) \
  F(X, shaft,   "work put in by the shaft's torque") \
  F(X, ring,    "work put in by motion of the inner ring's position") \
  F(X, gravity, "work of gravity (minus the change of potential energy)")

/* TRB_TORQUES(F, X): F(X, name, text). The field reads "share of <text> in the shaft's torque". */
#define TRB_TORQUES(F, X) \
  F(X, traction,  "raceway sliding friction") \
  F(X, rolling,   "rolling resistance") \
  F(X, rib,       "the back-face rib") \
  F(X, front_rib, "the front rib") \
  F(X, land,      "the cage on the inner ring's land")

enum {
  TRB_LOSS_none = -1,
#define TRB_LOSS_ENUM(X, name, sense, text) TRB_LOSS_##name,
  TRB_LOSSES(TRB_LOSS_ENUM, 0)
#undef TRB_LOSS_ENUM
      TRB_N_LOSSES
};

enum {
  /* Those before it have a quadrature in every model, later ones only up to the last one whose effect is on: a state without them is as long
   * as ever, and measures that are means over all of its entries stay the same. */
  TRB_N_USUAL_LOSSES = TRB_LOSS_drag,
  /* Those of pairs with a roller come first: what a roller does to the right-hand side has no others. */
  TRB_N_ROLLER_LOSSES = TRB_LOSS_drag + 1
};

enum {
  TRB_TORQUE_none = -1,
#define TRB_TORQUE_ENUM(X, name, text) TRB_TORQUE_##name,
  TRB_TORQUES(TRB_TORQUE_ENUM, 0)
#undef TRB_TORQUE_ENUM
      TRB_N_TORQUES
};

typedef enum trb_sense { TRB_SENSE_TAKES, TRB_SENSE_EITHER } trb_sense;

#endif
