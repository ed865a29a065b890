#include "motion/rhs.h"
#include "motion/fast_pairs.h"
#include "motion/spacer.h"

/* What approximates a roller's forces knows surfaces of true form: it stands aside where a roller may be on one that is not, and learns
 * nothing there. */

/* Poses of the bodies, but for rollers whose forces are approximated and that touch nothing: they need none. Gives how many of the n chosen
 * rollers are to be evaluated exactly; they are d->exact, and d->near says which fast pairs of a roller may touch. */
static int place(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, const int *chosen, int n)
{
  int n_exact = 0;
  trb_dynamics_drive(d, time);
  trb_dynamics_pose_hub(d, y);
  if (instead != NULL) instead->begin(instead->self, d, time);
  for (int k = 0; k < n; k++) {
    const int     j = chosen[k];
    const double *own = y + trb_state_roller(d->system, j);
    d->near[j] = trb_fast_near(d, j, y);
    d->uneven[j] = trb_dynamics_spin_roller(d, j, y);
    const int follows =
        instead != NULL && !d->uneven[j] && instead->follow(instead->self, d, j, own, d->flows[j], trb_dynamics_reactions(d, j));
    if (!follows) d->exact[n_exact++] = j;
    if (!follows || d->near[j] != 0) trb_dynamics_pose_roller(d, j, own);
  }
  d->work->counters.tangent_rollers += n - n_exact;
  return n_exact;
}

/* Flow under the slow pairs' exact loads. */
static void take(trb_dynamics *d, const trb_approximation *instead, int j, const double *y_roller)
{
  trb_wrench *const reactions = trb_dynamics_reactions(d, j);
  trb_dynamics_roller_flow(d, j, &d->loads[j], d->flows[j]);
  trb_dynamics_roller_reactions(d, j, &d->loads[j], reactions);
  if (instead != NULL && !d->uneven[j]) instead->learn(instead->self, d, j, y_roller, d->flows[j], reactions);
}

/* Slow pairs of the rollers that are to be evaluated exactly. */
static void evaluate_slow(trb_dynamics *d, int n_exact)
{
  trb_instant at = trb_dynamics_instant(d);
  at.chosen = d->exact;
  at.spin = d->spin;
  at.n = n_exact;
  trb_contact_slow(d->model, &at, d->work, d->loads, NULL);
}

void trb_rhs_rollers(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, const int *chosen, int n,
                     double *rates)
{
  d->work->counters.force_evaluations++;
  /* poses */
  const int n_exact = place(d, instead, time, y, chosen, n);
  trb_dynamics_start(d, rates);
  /* slow pairs, exactly or approximated */
  if (n_exact > 0) evaluate_slow(d, n_exact);
  for (int k = 0; k < n_exact; k++) take(d, instead, d->exact[k], y + trb_state_roller(d->system, d->exact[k]));
  for (int k = 0; k < n; k++) {
    /* fast pairs that are not proven clear */
    if (d->near[chosen[k]] != 0) trb_fast_add(d, chosen[k], y, d->flows[chosen[k]]);
    trb_dynamics_add_reactions(d, chosen[k]);
  }
}

void trb_rhs_hub(trb_dynamics *d, const double *y, double *rates)
{
  /* pairs without a roller */
  trb_dynamics_add_hub(d, rates);
  /* rates of the hub's bodies */
  trb_dynamics_put_hub(d, y, rates);
}

void trb_rhs_alone(trb_dynamics *d, const trb_approximation *instead, double time, int j, const double *y_roller)
{
  if (d->drive.time != time) trb_dynamics_drive(d, time);
  d->uneven[j] = 0;
  if (instead != NULL) instead->begin(instead->self, d, time);
  if (instead != NULL && instead->follow(instead->self, d, j, y_roller, d->flows[j], trb_dynamics_reactions(d, j))) {
    d->work->counters.tangent_rollers++;
    return;
  }
  trb_dynamics_pose_roller(d, j, y_roller);
  d->exact[0] = j;
  evaluate_slow(d, 1);
  take(d, instead, j, y_roller);
}

void trb_rhs(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, double *rates)
{
  const int n = d->model->n_rollers;
  y = trb_dynamics_held(d, time, y);
  trb_rhs_rollers(d, instead, time, y, d->everyone, n, rates);
  for (int j = 0; j < n; j++) trb_dynamics_put(d, j, d->flows[j], rates);
  trb_rhs_hub(d, y, rates);
  if (d->held == NULL) return;
  trb_spacer_join(d->system, &d->drive, y, rates);
  d->work->counters.spacers++;
}
