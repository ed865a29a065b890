/* What the right-hand side (motion/rhs.h) of a system is evaluated with: poses, loads and flows of all rollers and bodies, and scratch. */
#ifndef TRB_MOTION_DYNAMICS_H
#define TRB_MOTION_DYNAMICS_H

#include "base/memory.h"
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
  int             row;      /* its number in the system */
  int            *surfaces; /* of every roller: how many the pair tests for it; 0: they never touch */
  trb_bound      *bounds;   /* of every roller */
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
  trb_memory  memory;             /* of all arrays */
} trb_dynamics;

/* motion may be NULL where only poses that the caller places are used. */
trb_status trb_dynamics_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_dynamics **dynamics,
                               trb_message *message);
void       trb_dynamics_free(trb_dynamics *dynamics);

/* What the contacts read at the poses kept, of n chosen rollers; all surfaces of true form. */
static inline trb_instant trb_dynamics_instant(const trb_dynamics *d, const int *chosen, int n)
{
  return (trb_instant){.drive = &d->drive, .rollers = d->rollers, .bodies = d->bodies, .chosen = chosen, .n = n};
}

/* Where a roller's reactions are kept. */
static inline trb_wrench *trb_dynamics_reactions(const trb_dynamics *d, int roller)
{
  return d->reactions + (size_t)roller * (size_t)d->system->n_moving;
}

#endif
