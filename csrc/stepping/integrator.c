#include "stepping/integrator.h"

#include <math.h>

#include "stepping/blocks.h"

const trb_setting_info trb_setting_table[TRB_N_SETTINGS] = {
#define TRB_SETTING_INFO(name, standard, lower, upper, text) {#name, standard, lower, upper, text},
    TRB_SETTINGS(TRB_SETTING_INFO)
#undef TRB_SETTING_INFO
};

const trb_integrator_kind *const trb_integrator_kinds[] = {&trb_integrator_bdf, &trb_integrator_erk};
const int                        trb_n_integrator_kinds = (int)(sizeof trb_integrator_kinds / sizeof trb_integrator_kinds[0]);

/* Share of a velocity's absolute tolerance that holds at a speed of the shaft: no more than a share of the rolling speed, so that slow
 * rotation, whose slip is a small share of a small speed, is followed as exactly as fast rotation. */
static double speed_share(const trb_integrator *it, double shaft_speed)
{
  const trb_model *m = it->dynamics->model;
  const double     rolling = 0.5 * m->params.roller_diameter * fabs(m->geometry.roller_spin_ratio * shaft_speed);
  return trb_min(1.0, it->settings.slow_share * it->settings.rtol * trb_max(rolling, m->params.speed_floor) / it->settings.atol_velocity);
}

/* Quadratures and spin angles are integrated beside the motion but do not control the step. */
void trb_integrator_set_tolerances(trb_integrator *it)
{
  const trb_settings *s = &it->settings;
  trb_drive           drive;
  trb_motion_at(it->motion, it->dynamics->model, it->time, &drive);
  const double share = speed_share(it, trb_system_shaft_speed(it->dynamics->system, &drive, it->y));
  const double scale[TRB_N_TOLERANCES] = {s->atol_position, s->atol_angle, share * s->atol_velocity, share * s->atol_spin, 1e30};
  const double relative[TRB_N_TOLERANCES] = {0.0, 0.0, s->rtol, s->rtol, 0.0};
  for (int i = 0; i < it->n; i++) {
    const trb_tolerance kind = trb_state_tolerance(it->dynamics->system, i);
    it->scale[i] = scale[kind];
    it->relative[i] = relative[kind];
  }
}

int trb_integrator_finite(const trb_integrator *it, const double *rates)
{
  return trb_block_kernels_of(it->dynamics->work->variant)->finite(rates, it->n);
}

int trb_integrator_rates(trb_integrator *it, double time, const double *y, double *rates)
{
  trb_rhs(it->dynamics, NULL, time, y, rates);
  return trb_integrator_finite(it, rates) ? 0 : 1;
}

void trb_integrator_weights(const trb_integrator *it, const double *y, double *weights)
{
  const int     n_rollers = it->dynamics->model->n_rollers;
  const double *factor = it->impacts.factor;
  trb_block_kernels_of(it->dynamics->work->variant)->weigh(it->relative, it->scale, y, it->n, weights);
  for (int j = 0; j < n_rollers; j++)
    for (int i = 0; i < TRB_NR && factor[j] < 1.0; i++) weights[trb_state_roller(j) + i] /= factor[j];
  for (int i = n_rollers * TRB_NR; i < it->n_main && factor[n_rollers] < 1.0; i++) weights[i] /= factor[n_rollers];
}
