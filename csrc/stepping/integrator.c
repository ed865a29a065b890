#include "stepping/integrator.h"

#include <math.h>

#include "stepping/blocks.h"
#include "stepping/constants.h"

const trb_setting_info trb_setting_table[TRB_N_SETTINGS] = {
#define TRB_SETTING_INFO(name, standard, lower, upper, text) {#name, standard, lower, upper, text},
    TRB_SETTINGS(TRB_SETTING_INFO)
#undef TRB_SETTING_INFO
};

const trb_integrator_kind *const trb_integrator_kinds[] = {&trb_integrator_bdf, &trb_integrator_erk, &trb_integrator_multirate};
const int                        trb_n_integrator_kinds = (int)(sizeof trb_integrator_kinds / sizeof trb_integrator_kinds[0]);

void trb_integrator_choose(trb_integrator *it)
{
  it->reason = trb_integrator_multirate.refuses(it);
  it->kind = it->reason == NULL ? &trb_integrator_multirate : &trb_integrator_bdf;
}

/* Share of a velocity's absolute tolerance that holds at a speed of the shaft relative to the outer ring: no more than a share of the rolling speed, so that slow
 * rotation, whose slip is a small share of a small speed, is followed as exactly as fast rotation. */
static double speed_share(const trb_integrator *it, const trb_model *m, double speed)
{
  const double rolling = 0.5 * m->params.roller.diameter * fabs(m->geometry.roller_spin_ratio * speed);
  return trb_min(1.0, trb_slow_share * it->settings.rtol * trb_max(rolling, m->params.friction.speed_floor) / it->settings.atol_velocity);
}

/* Tolerances of the entries from one on, which are the coordinates of a body of a system. */
static void set_entries(trb_integrator *it, const trb_system *system, int first, int n, double share)
{
  const trb_settings *s = &it->settings;
  const double        scale[TRB_N_TOLERANCES] = {s->atol_position, s->atol_angle, share * s->atol_velocity, share * s->atol_spin,
                                                 trb_tolerance_of_integrals};
  const double        relative[TRB_N_TOLERANCES] = {0.0, 0.0, s->rtol, s->rtol, 0.0};
  for (int i = first; i < first + n; i++) {
    const trb_tolerance kind = trb_state_tolerance(system, i);
    it->scale[i] = scale[kind];
    it->relative[i] = relative[kind];
  }
}

/* Quadratures and spin angles are integrated beside the motion but do not control the step. */
void trb_integrator_set_tolerances(trb_integrator *it)
{
  for (int i = it->n_main; i < it->n; i++) it->scale[i] = trb_tolerance_of_integrals, it->relative[i] = 0.0;
  for (int k = 0; k < it->assembly->n; k++) {
    const trb_system *system = &it->assembly->members[k];
    trb_drive         drive;
    trb_motion_at(it->members[k].motion, system->model, it->time, &drive);
    const double share = speed_share(it, system->model, trb_system_shaft_speed(system, &drive, it->y) - drive.carried_speed);
    set_entries(it, system, trb_state_roller(system, 0), system->model->n_rollers * TRB_ROLLER_SIZE, share);
    for (int b = 0; b < system->n_bodies; b++)
      if (system->bodies[b].size > 0 && !system->bodies[b].carried)
        set_entries(it, system, system->bodies[b].first, system->bodies[b].size, share);
  }
}

double trb_integrator_n_bodies(const trb_integrator *it)
{
  return it->assembly->members[0].layout.n_rollers + (it->assembly->members[0].layout.hub_width > 0);
}

int trb_integrator_is_driven(const trb_integrator *it)
{
  int driven = 0;
  for (int k = 0; k < it->assembly->n; k++) driven |= it->members[k].motion->n > 1;
  return driven;
}

void trb_integrator_look(trb_integrator *it, int member, double step, const int *chosen, int n)
{
  trb_member              *m = &it->members[member];
  const trb_impact_measure measure = {.share = it->settings.impact_share,
                                      .least = it->settings.impact_least,
                                      .velocity = it->settings.atol_velocity,
                                      .position = it->settings.atol_position};
  trb_impacts_look(&m->impacts, m->dynamics, m->motion, it->time, it->y, step, &measure, chosen, n);
}

double trb_integrator_stop(const trb_integrator *it)
{
  double stop = INFINITY;
  for (int k = 0; k < it->assembly->n; k++) stop = fmin(stop, trb_motion_stop(it->members[k].motion, it->time));
  return fmin(stop, trb_never);
}

double trb_integrator_longest_step(const trb_integrator *it)
{
  double longest = it->settings.max_step;
  for (int k = 0; k < it->assembly->n; k++)
    longest = fmin(longest, fmin(trb_motion_longest_step(it->members[k].motion, it->time, it->settings.max_step),
                                 trb_dynamics_longest_step(it->members[k].dynamics)));
  return longest;
}

int trb_integrator_worst(const trb_integrator *it, const double *error)
{
  int    worst = -1;
  double largest = 0.0;
  for (int i = 0; i < it->n_main; i++) {
    const double scaled = fabs(error[i]) / (it->relative[i] * fabs(it->y[i]) + it->scale[i]);
    if (scaled > largest || !isfinite(scaled)) {
      largest = scaled;
      worst = i;
    }
  }
  return worst;
}

int trb_integrator_finite(const trb_integrator *it, const double *rates)
{
  return trb_block_kernels_of(it->members[0].dynamics->work->variant)->finite(rates, it->n);
}

int trb_integrator_rates(trb_integrator *it, double time, const double *y, double *rates)
{
  for (int k = 0; k < it->assembly->n; k++) trb_rhs(it->members[k].dynamics, NULL, time, y, rates);
  return trb_integrator_finite(it, rates) ? 0 : 1;
}

/* Least factor of the bodies of all bearings that have the same entries: a carried ring is a part of the body that carries it. */
static double factor_at(const trb_integrator *it, int first)
{
  double least = 1.0;
  for (int k = 0; k < it->assembly->n; k++) {
    const trb_system *system = &it->assembly->members[k];
    for (int b = 0; b < system->n_bodies; b++)
      if (system->bodies[b].size > 0 && system->bodies[b].first == first)
        least = trb_min(least, it->members[k].impacts.factor[system->model->n_rollers + b]);
  }
  return least;
}

void trb_integrator_weights(const trb_integrator *it, const double *y, double *weights)
{
  trb_block_kernels_of(it->members[0].dynamics->work->variant)->weigh(it->relative, it->scale, y, it->n, weights);
  for (int k = 0; k < it->assembly->n; k++) {
    const trb_system *system = &it->assembly->members[k];
    const int         n_rollers = system->model->n_rollers;
    const double     *factor = it->members[k].impacts.factor;
    double           *own = weights + trb_state_roller(system, 0);
    for (int j = 0; j < n_rollers; j++)
      for (int i = 0; i < TRB_NR && factor[j] < 1.0; i++) own[j * TRB_NR + i] /= factor[j];
    for (int b = 0; b < system->n_bodies; b++) {
      const trb_body *body = &system->bodies[b];
      if (body->size == 0 || body->carried) continue;
      const double of_body = factor_at(it, body->first);
      for (int i = body->first; i < body->first + body->size && of_body < 1.0; i++) weights[i] /= of_body;
    }
  }
}
