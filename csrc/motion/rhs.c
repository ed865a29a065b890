#include "motion/rhs.h"

/* What approximates a roller's forces knows surfaces of true form: it stands aside where a roller may be on one that is not, and learns
 * nothing there. */

/* Poses of the bodies, but for rollers whose forces are approximated and that touch nothing: they need none. Gives how many rollers are to
 * be evaluated exactly; they are d->exact, and d->near says which fast pairs of a roller may touch. */
static int place(trb_dynamics *d, const trb_approximation *instead, double time, const double *y)
{
  const trb_model *m = d->model;
  int              n_exact = 0;
  trb_dynamics_drive(d, time);
  trb_dynamics_pose_hub(d, y);
  if (instead != NULL) instead->begin(instead->self, d, time);
  for (int j = 0; j < m->n_rollers; j++) {
    const double *own = y + trb_state_roller(d->system, j);
    d->near[j] = trb_fast_near(d, j, y);
    d->uneven[j] = trb_dynamics_spin_roller(d, j, y);
    const int follows =
        instead != NULL && !d->uneven[j] && instead->follow(instead->self, d, j, own, d->flows[j], trb_dynamics_reactions(d, j));
    if (!follows) d->exact[n_exact++] = j;
    if (!follows || d->near[j] != 0) trb_dynamics_pose_roller(d, j, own);
  }
  d->work->counters.tangent_rollers += m->n_rollers - n_exact;
  return n_exact;
}

/* Flows under the slow pairs' exact forces. */
static void evaluate_slow(trb_dynamics *d, const trb_approximation *instead, int n_exact, const double *y)
{
  trb_instant at = trb_dynamics_instant(d);
  at.chosen = d->exact;
  at.spin = d->spin;
  at.n = n_exact;
  if (n_exact == 0) return;
  trb_contact_slow(d->model, &at, d->work, d->loads, NULL);
  for (int k = 0; k < n_exact; k++) {
    const int         j = d->exact[k];
    trb_wrench *const reactions = trb_dynamics_reactions(d, j);
    trb_dynamics_roller_flow(d, j, &d->loads[j], d->flows[j]);
    trb_dynamics_roller_reactions(d, j, &d->loads[j], reactions);
    if (instead != NULL && !d->uneven[j]) instead->learn(instead->self, d, j, y + trb_state_roller(d->system, j), d->flows[j], reactions);
  }
}

void trb_rhs(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, double *rates)
{
  const trb_model *m = d->model;
  d->work->counters.force_evaluations++;
  /* poses */
  const int n_exact = place(d, instead, time, y);
  trb_dynamics_start(d, rates);
  /* slow pairs, exactly or approximated */
  evaluate_slow(d, instead, n_exact, y);
  for (int j = 0; j < m->n_rollers; j++) {
    /* fast pairs that are not proven clear */
    if (d->near[j] != 0) trb_fast_add(d, j, y, d->flows[j]);
    trb_dynamics_add_reactions(d, j);
    /* rates of rollers */
    trb_dynamics_put(d, j, d->flows[j], rates);
  }
  /* pairs without a roller */
  trb_dynamics_add_hub(d, rates);
  /* rates of the hub's bodies */
  trb_dynamics_put_hub(d, y, rates);
}
