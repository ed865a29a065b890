/* Newton's and Euler's equations of each roller and each body of the hub, in frames that orbit with them
 * (docs/theory/motion.md#newtons-equations): the parts of which motion/rhs.h makes the right-hand side. */
#ifndef TRB_MOTION_DYNAMICS_H
#define TRB_MOTION_DYNAMICS_H

#include "motion/bound.h"
#include "motion/ring_motion.h"
#include "system/system.h"

/* A roller's share of the right-hand side: rates of its state, of its spin angle, and its powers in the quadratures
 * (docs/theory/energy.md#quadratures). It is affine in the loads: a part from inertia and gravity, and a part that is linear in the
 * loads (the response). */
enum {
  TRB_FLOW_spin = TRB_ROLLER_SIZE,
  TRB_FLOW_quadrature = TRB_ROLLER_SIZE + 1,
  TRB_FLOW_N_QUADRATURES = TRB_Q_losses + TRB_N_ROLLER_LOSSES,
  TRB_FLOW_SIZE = TRB_FLOW_quadrature + TRB_FLOW_N_QUADRATURES,
  TRB_FLOW_ROOM = (TRB_FLOW_SIZE + 7) / 8 * 8 /* padded, so that loops over it have no remainder */
};

/* A pair that is evaluated at every instant, and what is proven of every roller in it. */
typedef struct trb_fast_pair {
  const trb_pair *pair;
  int             row;    /* its number in the system */
  trb_bound      *bounds; /* n_rollers */
  trb_arms        arms[TRB_N_GAPS];
  /* where the other body deforms; NULL where it does not */
  int    *places; /* [mode]: of its amplitude in the state */
  double *ways;   /* [roller][mode][gap]: as its kind gives them, for a unit of that coordinate */
  double *modal;  /* [roller][mode]: those coordinates where the gaps were found */
} trb_fast_pair;

typedef struct trb_dynamics {
  const trb_system *system;
  const trb_model  *model; /* of the system's bearing */
  const trb_motion *motion;
  trb_workspace    *work;
  trb_drive         drive;                    /* at the last time evaluated */
  trb_roller_pose  *rollers;                  /* at the last state evaluated */
  trb_body_at       bodies[TRB_MOST_BODIES];  /* of the system, at the last time and state evaluated */
  trb_wrench        on_body[TRB_MOST_BODIES]; /* load of the right-hand side under way on each of them, in R */
  int               spin_at, quadrature;      /* where the tail of the state begins, and its quadratures */
  trb_loads        *loads;                    /* of every roller */
  trb_loads         hub;                      /* of pairs without a roller, in R; zero where there are none */
  int              *everyone;                 /* 0, 1, ...: all rollers */
  trb_fast_pair     fast[TRB_MOST_PAIRS];
  int               n_fast;
  double (*flows)[TRB_FLOW_ROOM]; /* of every roller */
  trb_wrench *reactions;          /* of every roller: on each ring that has coordinates, in R */
  int        *exact;              /* rollers to evaluate exactly */
  int        *uneven;             /* of every roller: 1: surfaces may be off their true form where it is */
  double     *spin;               /* angle that each roller has turned by, rad; NULL: all surfaces have their true form */
  unsigned   *near;               /* of every roller: bit by fast pair, those that may touch */
  double     *held;               /* scratch: a state whose rollers a spacer holds; NULL: there is none */
} trb_dynamics;

/* motion may be NULL where only poses that the caller places are used. */
trb_status trb_dynamics_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_dynamics **dynamics,
                               trb_message *message);
void       trb_dynamics_free(trb_dynamics *dynamics);

/* What is prescribed at a time, and where bodies without coordinates are then; kept in the dynamics. */
void trb_dynamics_drive(trb_dynamics *d, double time);
/* Bodies without coordinates where the drive that is kept puts them. */
void trb_dynamics_place(trb_dynamics *d);
/* A state with its rollers where a spacer holds them, and the drive of its time kept; the state itself where there is none. */
const double *trb_dynamics_held(trb_dynamics *d, double time, const double *y);
/* Poses at (t, y), kept in the dynamics. */
void trb_dynamics_pose(trb_dynamics *d, double time, const double *y);
/* Poses of the bodies of the hub only. */
void trb_dynamics_pose_hub(trb_dynamics *d, const double *y);
/* Pose of one body of the hub only, from its part of a state. */
void trb_dynamics_pose_body(trb_dynamics *d, int body, const double *y_body);
/* The angle that a roller has turned by about its axis, out of a state, is kept, where surfaces are off their true form; gives whether one of
 * them may be where the roller is. Rings stand where they were put. */
int trb_dynamics_spin_roller(trb_dynamics *d, int roller, const double *y);
/* The longest step that steps over no part of such a surface, at the speeds that are kept, s. */
double trb_dynamics_longest_step(const trb_dynamics *d);
/* Pose of one roller only, from its part of a state; rings stand where they were put. */
void trb_dynamics_pose_roller(trb_dynamics *d, int roller, const double *y_roller);
/* A ring as a roller sees it at a pose. */
trb_ring_pose trb_dynamics_ring_seen(const trb_dynamics *d, int body, const trb_roller_pose *roller);
/* All loads at the poses kept; detail may be NULL. */
void trb_dynamics_loads(trb_dynamics *d, trb_detail *detail);
/* The same without the pairs that are proven not to touch, which changes no bit of the loads; apart: see trb_fast_apart, may be NULL. */
void trb_dynamics_loads_of(trb_dynamics *d, const unsigned *apart, trb_detail *detail);
/* What the contacts read, all surfaces of true form. */
trb_instant trb_dynamics_instant(const trb_dynamics *d);

void trb_dynamics_roller_flow(const trb_dynamics *d, int roller, const trb_loads *loads, double *flow);
/* What a roller's loads do to the rings that have coordinates, in R; its pose is kept. */
void trb_dynamics_roller_reactions(const trb_dynamics *d, int roller, const trb_loads *loads, trb_wrench *reactions);
/* Where a roller's reactions are kept. */
static inline trb_wrench *trb_dynamics_reactions(const trb_dynamics *d, int roller)
{
  return d->reactions + (size_t)roller * (size_t)d->system->n_moving;
}
/* Adds the kept reactions of a roller to the loads of the bodies. */
void trb_dynamics_add_reactions(trb_dynamics *d, int roller);

/* A right-hand side is made in four steps: start it, put in the flow of each roller (with its fast pairs), add the pairs without a roller, put in the rates of
 * the hub. */
void trb_dynamics_start(trb_dynamics *d, double *rates);
void trb_dynamics_put(const trb_dynamics *d, int roller, const double *flow, double *rates);
/* Adds the loads of pairs without a roller to those of the hub's bodies and their powers to the quadratures of the rates. */
void trb_dynamics_add_hub(trb_dynamics *d, double *rates);
/* Adds what bodies lose in themselves, at the poses kept, to a list of losses. */
void trb_dynamics_book_bodies(const trb_dynamics *d, double *losses);
void trb_dynamics_put_hub(const trb_dynamics *d, const double *y, double *rates);
/* Rates of a body at its pose under a load, by coordinate; of a carried body, whose coordinates another system has, what the load adds. */
void trb_dynamics_body_rates(const trb_dynamics *d, int body, const double *y, const trb_wrench *load, double *rates);

#endif
