/* One step of a team: its equations by Newton's method, its error (docs/theory/multirate.md#the-formula). The rules are those of newton.c;
 * tolerances hold for each body by itself and not for the mean of all. */
#include "stepping/multirate.h"

#include <math.h>
#include <string.h>

#include "stepping/constants.h"

static const int swings[] = {TRB_ROLLER_skew, TRB_ROLLER_tilt, TRB_ROLLER_omega_n, TRB_ROLLER_omega_t};

/* The larger of two errors; one that is no number stays, whatever follows it. */
static double larger(double a, double b) { return isnan(a) || b <= a ? a : b; }

static void put_state(const trb_multirate *s, const trb_mover *mover, const double *from)
{
  memcpy(s->y + mover->first, from, (size_t)mover->course.main * sizeof *from);
}

void trb_multirate_flows(trb_integrator *it, const trb_team *team, double time, double gamma, int exact)
{
  trb_multirate           *s = it->self;
  trb_dynamics            *d = it->members[0].dynamics;
  const trb_approximation *instead = exact ? NULL : &s->tangents;
  s->measure.gamma = gamma;
  s->count.rhs_evaluations++;
  if (team->with_hub) {
    for (int k = 0; k < trb_team_size(team); k++) put_state(s, trb_team_mover(s, team, k), trb_team_mover(s, team, k)->x);
    trb_rhs_rollers(d, instead, time, s->y, team->rollers, team->n, s->rates);
    trb_rhs_hub(d, s->y, s->rates);
    trb_mover *hub = &s->movers[s->n_rollers];
    memcpy(s->hub_flow, s->rates + hub->first, (size_t)hub->course.main * sizeof(double));
    memcpy(s->hub_flow + hub->course.main, s->rates + trb_state_quadrature(d->system), (size_t)s->n_quadratures * sizeof(double));
    hub->flow = s->hub_flow;
  } else trb_rhs_alone(d, instead, time, team->rollers[0], s->movers[team->rollers[0]].x);
  for (int k = 0; k < team->n; k++) s->movers[team->rollers[k]].flow = d->flows[team->rollers[k]];
}

/* Whether a roller's slopes are to be taken again for a step that ends at a time: they are old, poor, were corrected often, or served for some solves
 * while the prescribed motion changes (integrator_cvode.c says why). fresh: the solve failed with those that there are. */
static int wants_slopes(const trb_integrator *it, int roller, double end, int fresh)
{
  const trb_multirate *s = it->self;
  const trb_mover     *mover = &s->movers[roller];
  if (mover->slopes_at == end) return 0;
  return fresh || (mover->poor && mover->solves >= TRB_SOLVES_BETWEEN_RENEWALS) || trb_tangents_are_worn(s->jacobian->tangents, roller) ||
         fabs(end - mover->slopes_at) > it->settings.rings_age ||
         (mover->solves >= TRB_JACOBIAN_EVERY && trb_motion_changes(it->members[0].motion, end - it->settings.rings_age, end));
}

static void note_slopes(trb_mover *mover, double end)
{
  mover->poor = 0;
  mover->solves = 0;
  mover->slopes_at = end;
}

/* filled: the Jacobian is new; else inverses of single rollers can be used again. */
static int factor(trb_multirate *s, const trb_team *team, double gamma, int filled)
{
  s->count.linear_setups++;
  s->factors_age = 0;
  s->has_factors = (filled ? trb_arrow_factor : trb_arrow_factor_again)(s->arrow, gamma, team->rollers, team->n, s->factors);
  return s->has_factors;
}

/* The linear system of the team with the hub; 0: it is singular. */
static int prepare_hub(trb_integrator *it, const trb_team *team, double end, double gamma, int fresh)
{
  trb_multirate *s = it->self;
  int            fill = fresh || !s->has_jacobian || s->jacobian_age >= TRB_JACOBIAN_EVERY;
  for (int k = 0; k < team->n; k++) {
    if (!wants_slopes(it, team->rollers[k], end, fresh)) continue;
    trb_jacobian_renew(s->jacobian, team->rollers[k]);
    note_slopes(&s->movers[team->rollers[k]], end);
    fill = 1;
  }
  if (fill) {
    for (int k = 0; k < trb_team_size(team); k++) put_state(s, trb_team_mover(s, team, k), trb_team_mover(s, team, k)->p[0]);
    trb_jacobian_fill_of(s->jacobian, end, s->y, 0, team->rollers, team->n, s->arrow);
    s->count.jacobian_evaluations++;
    s->has_jacobian = 1;
    s->jacobian_age = 0;
  } else if (s->n_joined > 0) {
    put_state(s, &s->movers[s->n_rollers], s->movers[s->n_rollers].p[0]);
    for (int k = 0; k < s->n_joined; k++) {
      put_state(s, &s->movers[s->joined[k]], s->movers[s->joined[k]].p[0]);
      trb_jacobian_add(s->jacobian, end, s->y, s->joined[k], s->arrow);
      s->factors->held[s->joined[k]] = 0.0;
    }
  }
  s->n_joined = 0;
  const int other = fabs(gamma / s->factors->gamma - 1.0) > trb_gamma_change || s->factors_age >= TRB_SETUP_EVERY;
  return fill || !s->has_factors || other ? factor(s, team, gamma, fill) : 1;
}

static int prepare_alone(trb_integrator *it, int roller, double end, double gamma, int fresh)
{
  trb_multirate *s = it->self;
  trb_mover     *mover = &s->movers[roller];
  if (wants_slopes(it, roller, end, fresh)) {
    put_state(s, mover, mover->p[0]);
    trb_jacobian_slopes(s->jacobian, end, s->y, &roller, 1);
    note_slopes(mover, end);
    s->factors->held[roller] = 0.0;
  }
  const double held = s->factors->held[roller];
  if (held > 0.0 && fabs(gamma / held - 1.0) <= trb_gamma_change && mover->age < TRB_SETUP_EVERY) return 1;
  for (int c = 0; c < TRB_NR; c++)
    memcpy(s->arrow->rollers[roller].own[c], trb_tangents_column(s->jacobian->tangents, roller, c), TRB_NR * sizeof(double));
  s->count.linear_setups++;
  mover->age = 0;
  return trb_arrow_factor_alone(s->arrow, gamma, roller, s->factors);
}

/* Correction from what the equations lack, both in s->packed. */
static void solve(trb_multirate *s, const trb_team *team)
{
  const trb_block_kernels *kernels = s->factors->kernels;
  if (team->with_hub) kernels->solve(s->factors->rollers, s->factors->borders, team->rollers, team->n, &s->factors->hub, s->packed);
  else {
    double to[TRB_NP] = {0};
    kernels->add(s->factors->rollers[team->rollers[0]].inverse[0], TRB_NP, TRB_NR, s->packed, to);
    memcpy(s->packed, to, TRB_NR * sizeof *to);
  }
}

/* What the equations lack at the present e, with its largest part of a body in tolerances. */
static double measure(trb_integrator *it, const trb_team *team, double end, double gamma, int exact)
{
  trb_multirate *s = it->self;
  double         off = 0.0, *packed = s->packed, *weight = s->weight;
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    for (int i = 0; i < b->course.main; i++) b->x[i] = b->p[0][i] + b->e[i];
  }
  trb_multirate_flows(it, team, end, gamma, exact);
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    const int  n = b->course.main;
    for (int i = 0; i < n; i++) packed[i] = gamma * b->flow[i] - (b->e[i] + trb_course_per_l1 * b->p[1][i]);
    b->left = sqrt(trb_weighted_product(n, packed, packed, weight) / n);
    off = larger(off, b->left);
    packed += n, weight += n;
  }
  return off;
}

/* Adds the correction; gives its largest part of a body in tolerances. */
static double add(trb_multirate *s, const trb_team *team)
{
  double        change = 0.0;
  const double *packed = s->packed, *weight = s->weight;
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    const int  n = b->course.main;
    change = larger(change, sqrt(trb_weighted_product(n, packed, packed, weight) / n));
    for (int i = 0; i < n; i++) b->e[i] += packed[i];
    packed += n, weight += n;
  }
  return change;
}

/* Integrals, which no force reads, solve their equations with the rates that were evaluated last. */
static void integrate(trb_multirate *s, const trb_team *team, double gamma)
{
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    for (int i = b->course.main; i < b->course.n; i++) b->e[i] = gamma * b->flow[i] - trb_course_per_l1 * b->p[1][i];
  }
}

static int iterate(trb_integrator *it, const trb_team *team, double end, double gamma, double tolerance, double failing, int exact)
{
  trb_multirate *s = it->self;
  const int      size = team->n * TRB_NR + (team->with_hub ? s->movers[s->n_rollers].course.main : 0);
  double         first = INFINITY, before = 0.0, square[TRB_NEWTON_ITERATIONS];
  for (int k = 0; k < trb_team_size(team); k++) memset(trb_team_mover(s, team, k)->e, 0, TRB_NP * sizeof(double));
  for (int m = 0; m < TRB_NEWTON_ITERATIONS; m++) {
    const double off = measure(it, team, end, gamma, exact);
    if (!isfinite(off)) return 0;
    for (int k = 0; k < team->n && m == 1 && off > trb_poor_share * before && off > trb_newton_negligible * tolerance; k++)
      s->movers[team->rollers[k]].poor |= s->movers[team->rollers[k]].left > trb_poor_body_share * trb_poor_share * before;
    solve(s, team);
    trb_newton_improve(m, size, s->weight, s->packed, s->taken, s->stride, square);
    s->count.nonlinear_iterations++;
    const double change = add(s, team);
    if (change <= tolerance && trb_newton_holds(failing, off, before, tolerance)) {
      integrate(s, team, gamma);
      return 1;
    }
    before = off;
    if (m == 0) first = change;
    if (!(change <= trb_newton_divergence * first) || !(square[m] > 0.0)) return 0;
  }
  return 0;
}

/* Weights of the bodies' coordinates where the step begins. */
static void weigh(const trb_integrator *it, const trb_team *team)
{
  const trb_multirate *s = it->self;
  double              *weight = s->weight;
  for (int k = 0; k < trb_team_size(team); k++) {
    const trb_mover *b = trb_team_mover(s, team, k);
    const int        at = k < team->n ? team->rollers[k] : s->n_rollers + s->hub_body;
    const double     factor = team->with_hub ? it->members[0].impacts.factor[at] : 1.0;
    for (int i = 0; i < b->course.main; i++)
      *weight++ = 1.0 / ((it->relative[b->first + i] * fabs(b->course.now.z[0][i]) + it->scale[b->first + i]) * factor);
  }
}

/* Largest error of a body, in tolerances. */
static double error_of(trb_multirate *s, const trb_team *team, double per)
{
  const double *weight = s->weight;
  double        largest = 0.0;
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    const int  n = b->course.main;
    double     e[TRB_COURSE_ROOM];
    memcpy(e, b->e, (size_t)n * sizeof *e);
    for (size_t i = 0; i < sizeof swings / sizeof *swings && team->with_hub && k < team->n; i++) e[swings[i]] *= trb_swing_share;
    largest = larger(largest, per * sqrt(trb_weighted_product(n, e, e, weight) / n));
    for (int i = n; i < b->course.n; i++) largest += 0.0 * b->e[i]; /* an integral that is no number any more */
    for (int i = 0; i < n; i++) s->error[b->first + i] = per * b->e[i];
    weight += n;
  }
  return largest;
}

trb_outcome trb_multirate_try(trb_integrator *it, const trb_team *team, double end, double *error)
{
  trb_multirate   *s = it->self;
  const trb_mover *head = trb_team_head(s, team);
  const double     gamma = head->course.now.scale / trb_course_l1, per = trb_course_error_of(&head->course);
  double           failing = 0.0;
  int              troubled = !(it->settings.rings_share > 0.0), solved = 0;
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    trb_course_predict(&b->course, b->p);
    failing = fmax(failing, b->failing);
    troubled |= b->troubled || b->failing > trb_failing_sometimes;
  }
  weigh(it, team);
  for (int fresh = 0; fresh < 2 && !solved; fresh++) {
    solved = (team->with_hub ? prepare_hub(it, team, end, gamma, fresh) : prepare_alone(it, team->rollers[0], end, gamma, fresh)) &&
             iterate(it, team, end, gamma, it->settings.newton_share / per, failing, troubled);
    if (!solved) s->count.nonlinear_failures += fresh;
  }
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    b->failing += trb_newest_solve_weight * (!solved - b->failing);
    b->troubled = !solved;
    b->solves++;
  }
  if (team->with_hub) s->jacobian_age++, s->factors_age++;
  else s->movers[team->rollers[0]].age++;
  *error = error_of(s, team, per);
  return !solved ? TRB_STEP_UNSOLVED : *error <= 1.0 ? TRB_STEP_GOOD : TRB_STEP_WRONG;
}
