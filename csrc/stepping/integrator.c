#include "stepping/integrator.h"

#include "stepping/blocks.h"

const trb_setting_info trb_setting_table[TRB_N_SETTINGS] = {
#define TRB_SETTING_INFO(name, standard, lower, upper, text) {#name, standard, lower, upper, text},
    TRB_SETTINGS(TRB_SETTING_INFO)
#undef TRB_SETTING_INFO
};

const trb_integrator_kind *const trb_integrator_kinds[] = {&trb_integrator_bdf, &trb_integrator_erk};
const int                        trb_n_integrator_kinds = (int)(sizeof trb_integrator_kinds / sizeof trb_integrator_kinds[0]);

int trb_integrator_finite(const trb_integrator *it, const double *rates)
{
  return trb_block_kernels_of(it->dynamics->work->variant)->finite(rates, it->n);
}

int trb_integrator_rates(trb_integrator *it, double time, const double *y, double *rates)
{
  trb_dynamics_derivative(it->dynamics, time, y, rates);
  return trb_integrator_finite(it, rates) ? 0 : 1;
}

void trb_integrator_weights(const trb_integrator *it, const double *y, double *weights)
{
  trb_block_kernels_of(it->dynamics->work->variant)->weigh(it->relative, it->scale, y, it->n, weights);
}
