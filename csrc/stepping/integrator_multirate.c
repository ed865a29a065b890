/* Steps as long as each body allows (docs/theory/multirate.md). A roller that touches nothing with coordinates steps by itself; the hub and the
 * rollers that touch it, or may soon do so, step together. Rollers by themselves step until they are no earlier than the end of the hub's step; the
 * hub's team steps; then every roller by itself is proven to have touched nothing in the whole of that step. Where the proof fails, the step is taken
 * back, and the roller is one of the team from where it began. Time and state of the integrator are those at the end of the hub's step. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stepping/constants.h"
#include "stepping/multirate.h"
#include "motion/fast_pairs.h"

static trb_team hub_team(const trb_multirate *s) { return (trb_team){.rollers = s->together, .n = s->n_together, .with_hub = 1}; }

static void set_step(const trb_multirate *s, const trb_team *team, double step)
{
  for (int k = 0; k < trb_team_size(team); k++)
    if (trb_team_mover(s, team, k)->course.now.scale != step) trb_course_rescale(&trb_team_mover(s, team, k)->course, step);
}

/* Where a team's next step ends: no later than what is prescribed allows, to which its length is set. */
static double end_of(const trb_integrator *it, const trb_team *team)
{
  const trb_multirate *s = it->self;
  const trb_course    *course = &trb_team_head(s, team)->course;
  const trb_motion    *motion = it->members[0].motion;
  const double         from = course->now.end, stop = fmin(trb_motion_stop(motion, from), trb_never);
  double               step = fmin(course->now.scale, trb_motion_longest_step(motion, from, it->settings.max_step));
  const int            last = from + step >= stop;
  if (last) step = stop - from;
  else if (from + trb_sliver * step > stop) step = trb_half_step * (stop - from); /* no sliver is left */
  set_step(s, team, step);
  return last ? stop : from + step;
}

/* Rates at the last time take the place of what is known of the course, after a kink in what is prescribed or in the forces. */
static void begin_again(trb_integrator *it, const trb_team *team)
{
  trb_multirate *s = it->self;
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    memcpy(b->x, b->course.now.z[0], sizeof b->x);
  }
  const trb_course *head = &trb_team_head(s, team)->course;
  trb_multirate_flows(it, team, head->now.end, head->now.scale / trb_course_l1, 1);
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_course_step *now = &trb_team_mover(s, team, k)->course.now;
    for (int i = 0; i < trb_team_mover(s, team, k)->course.n; i++) {
      now->z[1][i] = now->scale * trb_team_mover(s, team, k)->flow[i];
      now->z[2][i] = 0.0;
    }
  }
}

/* After a step that failed. */
static trb_status shorten(trb_integrator *it, const trb_team *team, trb_outcome outcome, double error, trb_message *message)
{
  trb_multirate *s = it->self;
  trb_mover     *head = trb_team_head(s, team);
  const double   step = head->course.now.scale;
  double         by = trb_unsolved_cut;
  if (outcome == TRB_STEP_WRONG) {
    s->count.error_failures++;
    by = trb_clamp(1.0 / cbrt(trb_error_margin * error), trb_least_cut, trb_most_cut);
  }
  head->errors = outcome == TRB_STEP_WRONG ? head->errors + 1 : 0;
  set_step(s, team, by * step);
  head->course.wait = TRB_STEPS_UNTIL_LONGER;
  if (!(by * step >= it->settings.smallest_step) || head->course.now.end + by * step == head->course.now.end)
    return trb_fail(message, TRB_ERR_STEP, "the step of %s fell to %g s", team->with_hub ? "the cage" : "a roller", by * step);
  if (head->errors > 0 && head->errors % TRB_ERRORS_UNTIL_RESTART == 0) begin_again(it, team);
  return TRB_OK;
}

/* A step is taken. */
static void accept(trb_integrator *it, const trb_team *team, double end, double error)
{
  trb_multirate *s = it->self;
  trb_mover     *head = trb_team_head(s, team);
  const double   step = head->course.now.scale;
  for (int k = 0; k < trb_team_size(team); k++) {
    trb_mover *b = trb_team_mover(s, team, k);
    trb_course_accept(&b->course, end, b->p, b->e, !team->with_hub);
  }
  s->count.body_steps += trb_team_size(team);
  s->count.smallest_step = fmin(s->count.smallest_step, step);
  head->errors = 0;
  if (head->course.wait > 0) return;
  const double growth = fmin(1.0 / (cbrt(trb_error_margin * error) + trb_growth_offset), trb_most_growth);
  head->course.wait = growth >= trb_least_growth ? TRB_STEPS_UNTIL_LONGER : 1;
  if (growth >= trb_least_growth) set_step(s, team, fmin(step * growth, it->settings.max_step));
}

static trb_status step_alone(trb_integrator *it, int roller, trb_message *message)
{
  const trb_team team = {.rollers = &roller, .n = 1, .with_hub = 0};
  for (int i = 0; i < TRB_MOST_TRIES; i++) {
    double            error;
    const double      end = end_of(it, &team);
    const trb_outcome outcome = trb_multirate_try(it, &team, end, &error);
    if (outcome == TRB_STEP_GOOD) {
      accept(it, &team, end, error);
      return TRB_OK;
    }
    const trb_status status = shorten(it, &team, outcome, error, message);
    if (status != TRB_OK) return status;
  }
  return trb_fail(message, TRB_ERR_STEP, "roller %d: no step in %d tries", roller, TRB_MOST_TRIES);
}

/* Rollers by themselves step until they are no earlier than the end of the hub's step. A roller whose steps are much shorter makes that step end where it
 * has come to: so no more than TRB_COURSE_LEAD of its steps are ahead of the hub. */
static trb_status lead(trb_integrator *it, double *end, trb_message *message)
{
  const trb_multirate *s = it->self;
  for (int j = 0; j < s->n_rollers; j++) {
    trb_course *course = &s->movers[j].course;
    while (!s->movers[j].together && course->now.end < *end) {
      if (trb_course_lead(course, it->time) >= TRB_COURSE_LEAD) {
        *end = course->now.end;
        break;
      }
      const trb_status status = step_alone(it, j, message);
      if (status != TRB_OK) return status;
    }
  }
  return TRB_OK;
}

/* The state of all bodies at a time of the last step. */
static void read(const trb_integrator *it, double time, double *y)
{
  const trb_multirate *s = it->self;
  const trb_dynamics  *d = it->members[0].dynamics;
  const trb_mover     *hub = &s->movers[s->n_rollers];
  const int            n = s->n_quadratures < TRB_FLOW_N_QUADRATURES ? s->n_quadratures : TRB_FLOW_N_QUADRATURES;
  double               at[TRB_COURSE_ROOM];
  trb_course_at(&hub->course, time, hub->course.n, at);
  memcpy(y + hub->first, at, (size_t)hub->course.main * sizeof *y);
  memcpy(y + trb_state_quadrature(d->system), at + hub->course.main, (size_t)s->n_quadratures * sizeof *y);
  for (int j = 0; j < s->n_rollers; j++) {
    trb_course_at(&s->movers[j].course, time, TRB_FLOW_SIZE, at);
    memcpy(y + s->movers[j].first, at, TRB_NR * sizeof *y);
    y[trb_state_spin(d->system) + j] = at[TRB_FLOW_spin];
    for (int k = 0; k < n; k++) y[trb_state_quadrature(d->system) + k] += at[TRB_FLOW_quadrature + k];
  }
}

static trb_status multirate_step(trb_integrator *it, trb_message *message)
{
  trb_multirate *s = it->self;
  const int      most = TRB_MOST_TRIES + s->n_rollers;
  if (!s->jacobian->tangents->has_slopes)
    trb_jacobian_slopes(s->jacobian, it->time, it->y, it->members[0].dynamics->everyone, s->n_rollers);
  for (int i = 0; i < most; i++) {
    trb_team   team = hub_team(s);
    double     end = end_of(it, &team), error;
    trb_status status = lead(it, &end, message);
    if (status != TRB_OK) return status;
    const double step = end - it->time;
    set_step(s, &team, step);
    trb_integrator_look(it, 0, step, s->together, s->n_together);
    const trb_outcome outcome = trb_multirate_try(it, &team, end, &error);
    if (outcome != TRB_STEP_GOOD) {
      status = shorten(it, &team, outcome, error, message);
      if (status != TRB_OK) return status;
      continue;
    }
    if (trb_multirate_join(it, end) > 0) {
      team = hub_team(s);
      set_step(s, &team, trb_half_step * step);
      continue;
    }
    accept(it, &team, end, error);
    s->count.steps++;
    s->count.last_step = step;
    it->time = end;
    read(it, end, it->y);
    trb_multirate_leave(it);
    return TRB_OK;
  }
  return trb_fail(message, TRB_ERR_STEP, "the cage: no step in %d tries", most);
}

static trb_status multirate_restart(trb_integrator *it, trb_message *message)
{
  trb_multirate    *s = it->self;
  const trb_system *system = &it->assembly->members[0];
  trb_dynamics     *d = it->members[0].dynamics;
  (void)message;
  trb_tangents_forget(s->jacobian->tangents);
  s->has_jacobian = s->has_factors = s->n_joined = 0;
  memset(s->factors->held, 0, (size_t)s->n_rollers * sizeof *s->factors->held);
  s->count.restarts++;
  memcpy(s->y, it->y, (size_t)it->n * sizeof(double));
  trb_rhs_rollers(d, NULL, it->time, s->y, d->everyone, s->n_rollers, s->rates);
  trb_rhs_hub(d, s->y, s->rates);
  for (int j = 0; j <= s->n_rollers; j++) {
    trb_mover   *b = &s->movers[j];
    const int    is_hub = j == s->n_rollers;
    double       y[TRB_COURSE_ROOM] = {0}, rates[TRB_COURSE_ROOM] = {0};
    const double step = it->settings.first_step > 0.0 ? it->settings.first_step : trb_first_step;
    memset(b, 0, sizeof *b);
    b->first = is_hub ? trb_state_hub(system) : trb_state_roller(system, j);
    b->course.main = is_hub ? system->layout.hub_width : TRB_NR;
    b->course.n = is_hub ? b->course.main + s->n_quadratures : TRB_FLOW_SIZE;
    b->slopes_at = -INFINITY;
    memcpy(y, s->y + b->first, (size_t)b->course.main * sizeof *y);
    if (is_hub) {
      memcpy(y + b->course.main, s->y + trb_state_quadrature(d->system), (size_t)s->n_quadratures * sizeof *y);
      memcpy(rates, s->rates + b->first, (size_t)b->course.main * sizeof *y);
      memcpy(rates + b->course.main, s->rates + trb_state_quadrature(d->system), (size_t)s->n_quadratures * sizeof *y);
    } else {
      y[TRB_FLOW_spin] = s->y[trb_state_spin(d->system) + j];
      memcpy(rates, d->flows[j], TRB_FLOW_SIZE * sizeof *y);
    }
    trb_course_begin(&b->course, it->time, step, y, rates);
    b->course.wait = TRB_STEPS_UNTIL_LONGER;
    for (int f = 0; f < d->n_fast && !is_hub; f++) b->together |= d->fast[f].surfaces[j] != 0 && !(trb_fast_gap_left(d, f, j, s->y) > 0.0);
  }
  trb_multirate_list(s);
  return TRB_OK;
}

static const char *multirate_refuses(const trb_integrator *it)
{
  const trb_system   *system = &it->assembly->members[0];
  const trb_dynamics *d = it->members[0].dynamics;
  if (it->assembly->n != 1) return "several bearings are simulated together";
  if (system->n_moving > 0) return "a ring moves freely";
  for (int b = 0; b < system->n_bodies; b++)
    if (system->bodies[b].modes != NULL) return "the cage deforms";
  if (system->layout.hub_width != TRB_HUB_ONE_BODY) return "other bodies than a rigid cage have coordinates";
  if (d->held != NULL) return "a spacer joins all rollers";
  if (d->spin != NULL) return "surfaces are off their true form";
  if (it->settings.max_order != 2.0) return "max_order is not 2";
  for (int i = 0; i < d->work->n_batches; i++)
    for (int k = 0; k < d->work->batches[i].n; k++) {
      const trb_pair *pair = d->work->batches[i].pairs[k];
      if (pair->kind->pace == TRB_PACE_SLOW && system->bodies[pair->b].size > 0) return "a film joins rollers and cage at every distance";
    }
  return NULL;
}

static trb_status multirate_create(trb_integrator *it, trb_message *message)
{
  const trb_system *system = &it->assembly->members[0];
  const char       *reason = multirate_refuses(it);
  if (reason != NULL) return trb_fail(message, TRB_ERR_INPUT, "integrator = 'multirate': %s; choose integrator = 'bdf'", reason);
  trb_multirate *s = calloc(1, sizeof *s);
  if (s == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  it->self = s;
  const int    width = system->layout.hub_width;
  const size_t n = (size_t)it->n + TRB_NP;
  s->n_rollers = system->layout.n_rollers;
  s->n_quadratures = trb_n_quadratures(system);
  for (int b = 0; b < system->n_bodies; b++)
    if (system->bodies[b].size > 0) s->hub_body = b;
  s->stride = (size_t)s->n_rollers * TRB_NR + (size_t)width + TRB_NP;
  s->count.smallest_step = (double)INFINITY;
  s->count.last_order = 2.0;
  s->movers = trb_memory_zeros(&s->memory, (size_t)s->n_rollers + 1, sizeof *s->movers);
  s->together = trb_memory_zeros(&s->memory, (size_t)s->n_rollers, sizeof *s->together);
  s->joined = trb_memory_zeros(&s->memory, (size_t)s->n_rollers, sizeof *s->joined);
  s->y = trb_memory_zeros(&s->memory, n, sizeof *s->y);
  s->rates = trb_memory_zeros(&s->memory, n, sizeof *s->rates);
  s->error = trb_memory_zeros(&s->memory, n, sizeof *s->error);
  s->packed = trb_memory_zeros(&s->memory, s->stride, sizeof *s->packed);
  s->weight = trb_memory_zeros(&s->memory, s->stride, sizeof *s->weight);
  s->taken = trb_memory_zeros(&s->memory, s->stride * TRB_NEWTON_ITERATIONS, sizeof *s->taken);
  if (s->memory.lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the integrator");
  const int  variant = it->members[0].dynamics->work->variant, first = trb_state_roller(system, 0);
  trb_status status = trb_jacobian_create(system, it->members[0].motion, it->variant, &s->jacobian, message);
  if (status == TRB_OK) status = trb_arrow_create(s->n_rollers, width, &s->arrow, message);
  if (status == TRB_OK) status = trb_arrow_factors_create(s->n_rollers, width, variant, &s->factors, message);
  if (status != TRB_OK) return status;
  s->measure = (trb_tangent_measure){.relative = it->relative + first,
                                     .scale = it->scale + first,
                                     .kernels = s->factors->kernels,
                                     .share = it->settings.rings_share,
                                     .margin_share = trb_margin_share,
                                     .slip_share = trb_slip_share};
  s->tangents = trb_tangents_open(s->jacobian->tangents, &s->measure);
  return multirate_restart(it, message);
}

static void multirate_free(trb_integrator *it)
{
  trb_multirate *s = it->self;
  if (s == NULL) return;
  trb_jacobian_free(s->jacobian);
  trb_arrow_free(s->arrow);
  trb_arrow_factors_free(s->factors);
  trb_memory_free(&s->memory);
  free(s);
  it->self = NULL;
}

static trb_status multirate_interpolate(trb_integrator *it, double time, double *y, trb_message *message)
{
  (void)message;
  read(it, time, y);
  return TRB_OK;
}

static void multirate_statistics(const trb_integrator *it, trb_statistics *statistics)
{
  *statistics = ((const trb_multirate *)it->self)->count;
}

static int multirate_worst(trb_integrator *it) { return trb_integrator_worst(it, ((const trb_multirate *)it->self)->error); }

const trb_integrator_kind trb_integrator_multirate = {
    "multirate",          "backward differentiation of order 2 with steps of its own for each roller that touches nothing",
    multirate_refuses,    multirate_create,
    multirate_free,       multirate_restart,
    multirate_step,       multirate_interpolate,
    multirate_statistics, multirate_worst};
