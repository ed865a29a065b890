/* A pair: two bodies that act on each other, a row of the table of contact/pairs.c. Everything that evaluates forces, their slopes, records
 * or peaks loops over the rows that are on and names none: what a pair can do stands in its row. */
#ifndef TRB_CONTACT_PAIR_H
#define TRB_CONTACT_PAIR_H

#include <math.h>

#include "contact/bounds.h"
#include "contact/contact.h"

/* How a pair's forces change. Those of a slow pair follow the roller's motion smoothly; between exact evaluations a tangent may stand for
 * them (stepping/tangent.h). Those of a fast pair come and go with impacts: a roller's are evaluated at every instant, unless the bodies
 * are proven not to touch. */
typedef enum trb_pace { TRB_PACE_SLOW, TRB_PACE_FAST } trb_pace;

/* Where the pair's mechanisms are booked: entries of the lists of bearing/losses.h, or none. */
typedef struct trb_bookings {
  int loss[TRB_N_MECHANISMS];
  int torque[TRB_N_MECHANISMS]; /* share of the torque on the inner ring */
} trb_bookings;

#define TRB_NO_TORQUE {TRB_TORQUE_none, TRB_TORQUE_none, TRB_TORQUE_none, TRB_TORQUE_none, TRB_TORQUE_none}
/* Of a pair that only slides and damps. */
#define TRB_LOSES_BY_SLIDING(name) \
  {[TRB_BY_SLIDING] = TRB_LOSS_##name, \
   [TRB_BY_ROLLING] = TRB_LOSS_none, \
   [TRB_BY_ROLLING_PRESSURE] = TRB_LOSS_none, \
   [TRB_BY_DAMPING] = TRB_LOSS_damping, \
   [TRB_BY_FILM] = TRB_LOSS_none}
#define TRB_TURNS_BY_SLIDING(name) \
  {[TRB_BY_SLIDING] = TRB_TORQUE_##name, \
   [TRB_BY_ROLLING] = TRB_TORQUE_none, \
   [TRB_BY_ROLLING_PRESSURE] = TRB_TORQUE_none, \
   [TRB_BY_DAMPING] = TRB_TORQUE_none, \
   [TRB_BY_FILM] = TRB_TORQUE_none}

/* A roller's contact as peaks see it, and how far it holds. */
typedef struct trb_contact_look {
  double load;           /* N */
  double pressure;       /* largest, Pa */
  double film_parameter; /* mean weighted by load */
  double way;            /* displacement that changes the load by a share, m; negative: unknown */
  double speed;          /* change of velocity that changes film or damping by a share, m/s */
} trb_contact_look;

/* The pairs of a batch, all chosen rollers at once; added to the loads. detail may be NULL. */
typedef void trb_pair_evaluate(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                               trb_detail *detail);
/* The same for peaks; looks: a row of batch->n a chosen roller; share: see trb_contact_look. Loads are scratch. */
typedef void trb_pair_look(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                           trb_detail *detail, double share, trb_contact_look *looks);
/* A roller's contact out of a detail. */
typedef void trb_pair_view(const trb_model *m, const trb_detail *detail, int roller, trb_contact_view *view);
/* Load between one roller and the other body of a fast pair. The load is written only where they may touch, or if the detail asks for
 * interferences; the same holds for the slopes, which may be NULL. Forces are added to those in the detail. */
typedef trb_gaps trb_pair_touch(const trb_model *m, const trb_instant *at, int roller, trb_counters *counters, trb_load *load,
                                trb_slopes *slopes, trb_detail *detail);

/* How near the bodies of a pair without a roller are to a contact, and how hard it would be. */
typedef struct trb_approach {
  double left;  /* gap, m; not above 0: they touch */
  double speed; /* at which it changes, m/s */
  double rise;  /* largest interference of a hit over its speed, s */
} trb_approach;

/* Load between the bodies of a pair without a roller, evaluated at every instant; wrenches in R. The load is zero before. */
typedef void trb_pair_between(const trb_model *m, const trb_instant *at, trb_counters *counters, trb_load *load, trb_detail *detail);

typedef struct trb_pair {
  const char *name;
  const char *text;
  trb_body    a, b;  /* the bodies; a is the roller where there is one */
  trb_pace    pace;  /* of pairs with a roller */
  int         seats; /* 1: under load it holds a roller along the roller's axis */
  int (*is_on)(const trb_model *m);
  trb_pair_evaluate *evaluate;
  trb_bookings       books;
  /* of slow pairs */
  trb_margin_arm (*margin)(const trb_model *m);
  trb_hold_arms (*hold)(const trb_model *m);
  trb_pair_look *look;
  trb_pair_view *view;
  /* of fast pairs */
  trb_pair_touch *touch;
  int (*surfaces)(const trb_model *m, int roller);                       /* that it tests for a roller; 0: they never touch */
  void (*count_clear)(const trb_model *m, int roller, trb_counters *to); /* counts a roller that is proven clear */
  void (*clearance)(const trb_model *m, trb_clearance_arms *arms);       /* TRB_N_GAPS of them */
  double (*stiffness)(const trb_model *m, double depth);                 /* load over interference at an interference, N/m */
  /* of pairs without a roller, which have nothing of the others */
  trb_pair_between *between;
  trb_approach (*approach)(const trb_model *m, const trb_instant *at); /* NULL: they do not touch */
} trb_pair;

/* Adds what a pair does to the sums. */
static inline void trb_add_load(const trb_pair *pair, const trb_load *load, trb_loads *to)
{
  trb_add_wrench(&to->on[pair->a], &load->on_a);
  trb_add_wrench(&to->on[pair->b], &load->on_b);
  to->elastic += load->elastic;
  for (int by = 0; by < TRB_N_MECHANISMS; by++) {
    if (pair->books.loss[by] != TRB_LOSS_none) to->power[pair->books.loss[by]] += load->lost[by];
    if (pair->books.torque[by] != TRB_TORQUE_none) to->torque[pair->books.torque[by]] += load->torque[by];
  }
}

/* Change of velocity that films and damping of a contact with a ring may bear, m/s. */
static inline double trb_look_speed(const trb_model *m, double mean_speed, double share)
{
  double speed = m->film ? share * mean_speed : (double)INFINITY;
  if (m->params.damping > 0.0 && m->params.damping_race > 0.0) speed = fmin(speed, share / m->params.damping_race);
  return speed;
}

/* How far a point contact, with a load that goes with the interference to the power 1.5, or without a load, may go. */
static inline double trb_look_way(const trb_point_detail *c, double share)
{
  return c->interference > 0.0 ? share * c->interference / 1.5 : -c->interference;
}

#define TRB_PAIR_DECLARE(name) extern const trb_pair trb_pair_##name;
TRB_PAIRS(TRB_PAIR_DECLARE)
#undef TRB_PAIR_DECLARE

extern const trb_pair *const trb_pair_table[TRB_N_PAIRS];

/* Whether a row is on: its effect is, and the model does not leave it out. */
int trb_pair_is_on(const trb_model *m, int row);
/* Bodies of a pair. */
static inline int trb_pair_joins(const trb_pair *pair, trb_body body) { return pair->a == body || pair->b == body; }
/* Puts the rows that are on into a workspace. */
void trb_pairs_choose(const trb_model *m, trb_workspace *work);
/* Whether a pair that is on holds rollers along their axes. */
int trb_pairs_seat(const trb_model *m);
/* For rows without a switch. */
int trb_pair_always(const trb_model *m);

trb_pair_evaluate trb_contact_raceway, trb_contact_rib, trb_contact_front_rib, trb_contact_pocket;
trb_pair_touch    trb_contact_pocket_of;

#endif
