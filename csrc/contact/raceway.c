/* Rollers on both raceways: gives the contacts to the kernel in groups (tiles) and adds up what it returns. */
#include <math.h>
#include <string.h>

#include "contact/kernels.h"

static const trb_ring_pose fixed_ring = {{0, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

static trb_race_input race_input(const trb_model *m, const trb_instant *at, int contact)
{
  const int roller = at->chosen[contact / TRB_N_RACES], race = contact % TRB_N_RACES, outer = race == TRB_RACE_OUTER;
  return (trb_race_input){&at->rollers[roller],
                          outer ? &fixed_ring : &at->inner[roller],
                          m->centre + (size_t)roller * (size_t)m->n_lanes,
                          m->sphere + (size_t)roller * (size_t)m->n_lanes,
                          &m->race[race],
                          m->race[race].sine,
                          m->race[race].cosine,
                          outer ? 1.0 : -1.0};
}

static void add_output(const trb_race_output *out, int race, trb_roller_load *load)
{
  load->margin[TRB_MARGIN_RACES] = trb_min(load->margin[TRB_MARGIN_RACES], fabs(out->depth));
  load->force = trb_add(load->force, out->force);
  load->moment = trb_add(load->moment, out->moment);
  load->elastic += out->elastic;
  load->power[TRB_POWER_ROLLING] += out->power_rolling;
  load->power[TRB_POWER_ROLLING_PRESSURE] += out->power_pressure;
  load->power[TRB_POWER_DAMPING] += out->power_damping;
  if (race == TRB_RACE_OUTER) {
    load->outer_force = trb_add(load->outer_force, out->ring_force);
    load->outer_moment = trb_add(load->outer_moment, out->ring_moment);
    load->power[TRB_POWER_TRACTION_OUTER] += out->power_traction;
    return;
  }
  load->ring_force = trb_add(load->ring_force, out->ring_force);
  load->ring_moment = trb_add(load->ring_moment, out->ring_moment);
  load->torque[TRB_TORQUE_TRACTION] += out->torque_traction;
  load->torque[TRB_TORQUE_ROLLING] += out->torque_rolling;
  load->power[TRB_POWER_TRACTION_INNER] += out->power_traction;
}

void trb_contact_raceway_of(const trb_model *m, const trb_instant *at, int roller, int race, trb_workspace *work, trb_race_output *output)
{
  trb_instant one = *at;
  one.chosen = &roller;
  const trb_race_input input = race_input(m, &one, race);
  trb_kernel_variants[work->variant].raceway(m, &input, 1, work->lanes, &work->counters, output);
}

/* Lane fields of the tile's loaded contacts, in the order in which the kernel packed them. */
static void copy_detail(const trb_model *m, const int *chosen, const trb_lanes *lanes, const trb_race_output *outputs, int first, int n,
                        trb_detail *detail)
{
  const size_t  lane_count = (size_t)m->n_lanes, field_size = (size_t)(TRB_N_RACES * m->n_rollers) * lane_count;
  const double *from = (const double *)lanes;
  int           packed = 0;
  for (int c = 0; c < n; c++) {
    if (!outputs[c].loaded) continue;
    const int    roller = chosen[(first + c) / TRB_N_RACES], race = (first + c) % TRB_N_RACES;
    const size_t to = ((size_t)race * (size_t)m->n_rollers + (size_t)roller) * lane_count;
    for (int f = 0; f < TRB_N_LANE_FIELDS; f++)
      memcpy(detail->lanes + (size_t)f * field_size + to, from + (size_t)f * TRB_LANE_STRIDE + (size_t)packed * lane_count,
             lane_count * sizeof(double));
    packed++;
  }
}

void trb_contact_raceway(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads, trb_detail *detail)
{
  enum { MOST = TRB_TILE_LANES / TRB_LANE_PAD };
  const int       total = at->n * TRB_N_RACES, per_tile = m->n_lanes < TRB_TILE_FILL ? TRB_TILE_FILL / m->n_lanes : 1;
  trb_race_input  inputs[MOST];
  trb_race_output outputs[MOST];
  for (int first = 0; first < total; first += per_tile) {
    const int n = total - first < per_tile ? total - first : per_tile;
    for (int c = 0; c < n; c++) inputs[c] = race_input(m, at, first + c);
    trb_kernel_variants[work->variant].raceway(m, inputs, n, work->lanes, &work->counters, outputs);
    for (int c = 0; c < n; c++) add_output(&outputs[c], (first + c) % TRB_N_RACES, &loads[at->chosen[(first + c) / TRB_N_RACES]]);
    if (detail != NULL) copy_detail(m, at->chosen, work->lanes, outputs, first, n, detail);
  }
}
