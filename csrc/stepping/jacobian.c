#include "stepping/jacobian.h"

#include <stdlib.h>
#include <string.h>

#include "stepping/coupling.h"

trb_status trb_jacobian_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_jacobian **jacobian,
                               trb_message *message)
{
  trb_jacobian *j = calloc(1, sizeof *j);
  *jacobian = NULL;
  if (j == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian");
  trb_status status = trb_dynamics_create(m, motion, variant, &j->d, message);
  if (status == TRB_OK) {
    j->moved = calloc((size_t)trb_state_size(m), sizeof *j->moved);
    if (j->moved == NULL) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian");
    else status = trb_tangents_create(m, &j->tangents, message);
  }
  if (status != TRB_OK) {
    trb_jacobian_free(j);
    return status;
  }
  *jacobian = j;
  return TRB_OK;
}

void trb_jacobian_free(trb_jacobian *jacobian)
{
  if (jacobian == NULL) return;
  trb_dynamics_free(jacobian->d);
  trb_tangents_free(jacobian->tangents);
  free(jacobian->moved);
  free(jacobian);
}

/* Rates of a roller that a load gives. */
static void roller_response(const trb_dynamics *d, int roller, const trb_wrench *load, double *rates)
{
  memset(rates, 0, TRB_NR * sizeof *rates);
  trb_roller_response(d->model, &d->rollers[roller], load, rates);
}

static void cage_rates(const trb_dynamics *d, const double *y_cage, const trb_wrench *load, double *rates)
{
  trb_cage_rates(d->model, &d->drive, &d->cage, y_cage, load, rates);
}

/* Slopes of the cage's loads with each of its coordinates. */
typedef struct cage_loads {
  trb_wrench by[TRB_CAGE_SIZE];
} cage_loads;

/* Adds what a fast pair in contact gives to its roller's block, to both borders and to the slopes of the cage's loads. still: rates of the
 * cage without loads. */
static void add_fast(const trb_dynamics *d, int j, const trb_coupling *k, const double *y_cage, const double *still, trb_arrow *arrow,
                     cage_loads *sums)
{
  trb_arrow_block  *block = &arrow->rollers[j];
  trb_arrow_border *border = &arrow->borders[j];
  double            change[TRB_NR], rates[TRB_CAGE_SIZE];
  for (int c = 0; c < TRB_NR; c++) {
    const trb_load load = trb_coupling_of_roller(k, c);
    roller_response(d, j, &load.on_a, change);
    cage_rates(d, y_cage, &load.on_b, rates);
    for (int i = 0; i < TRB_NR; i++) block->own[c][i] += change[i];
    for (int i = 0; i < TRB_CAGE_SIZE; i++) border->from[c * arrow->room + i] += rates[i] - still[i];
  }
  for (int c = 0; c < TRB_CAGE_SIZE; c++) {
    const trb_load load = trb_coupling_of_cage(k, c);
    roller_response(d, j, &load.on_a, change);
    for (int i = 0; i < TRB_NR; i++) border->to_hub[c * TRB_NR + i] += change[i];
    trb_add_wrench(&sums->by[c], &load.on_b);
  }
}

/* Adds what pairs without a roller do to the cage at the poses kept. */
static void add_hub(trb_dynamics *d, trb_wrench *on_cage)
{
  const trb_instant at = trb_dynamics_instant(d);
  if (d->work->n_hub == 0) return;
  trb_contact_hub(d->model, &at, d->work, &d->hub, NULL);
  trb_add_wrench(on_cage, &d->hub.on[TRB_BODY_CAGE]);
}

/* The block of the cage, by differences of its rates. load: of the fast pairs, which changes with each coordinate as `changes` tells; pairs
 * without a roller are evaluated again. */
static void cage_block(trb_jacobian *jac, const double *y, const trb_wrench *load, const cage_loads *changes, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  double          *y_cage = jac->moved + trb_state_cage(m), base[TRB_CAGE_SIZE], rates[TRB_CAGE_SIZE];
  trb_wrench       here = *load;
  add_hub(d, &here);
  cage_rates(d, y + trb_state_cage(m), &here, base);
  for (int c = 0; c < TRB_CAGE_SIZE; c++) {
    const double was = y_cage[c], h = trb_difference[trb_state_tolerance(m, trb_state_cage(m) + c)], per = 1.0 / h;
    y_cage[c] = was + h;
    trb_cage_pose_unpack(m, &d->drive, y_cage, &d->cage);
    trb_wrench moved = {trb_axpy(load->force, h, changes->by[c].force), trb_axpy(load->moment, h, changes->by[c].moment)};
    add_hub(d, &moved);
    cage_rates(d, y_cage, &moved, rates);
    for (int i = 0; i < TRB_CAGE_SIZE; i++) arrow->hub[c * arrow->room + i] = per * (rates[i] - base[i]);
    y_cage[c] = was;
  }
}

void trb_jacobian_fill(trb_jacobian *jac, double time, const double *y, int fresh, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  memcpy(jac->moved, y, (size_t)trb_state_size(m) * sizeof *y);
  trb_dynamics_pose(d, time, y);
  if (fresh || !jac->tangents->has_slopes) {
    trb_tangents_differentiate(jac->tangents, d, y, jac->moved);
    jac->rings_evaluations++;
  }
  for (int j = 0; j < m->n_rollers; j++)
    for (int c = 0; c < TRB_NR; c++) memcpy(arrow->rollers[j].own[c], trb_tangents_column(jac->tangents, j, c), TRB_NR * sizeof(double));
  if (m->params.with_cage <= 0.0) return;
  const trb_instant at = trb_dynamics_instant(d);
  const double     *y_cage = y + trb_state_cage(m);
  trb_wrench        on_cage = {{0, 0, 0}, {0, 0, 0}};
  cage_loads        changes = {0};
  double            still[TRB_CAGE_SIZE];
  cage_rates(d, y_cage, &on_cage, still);
  for (int j = 0; j < m->n_rollers; j++) {
    trb_arrow_border *border = &arrow->borders[j];
    border->coupled = 0;
    for (int f = 0; f < d->n_fast; f++) {
      trb_coupling   k;
      trb_load       load;
      const trb_gaps gaps = d->fast[f].pair->touch(m, &at, j, &d->work->counters, &load, &k.slopes, NULL);
      if (trb_gaps_clear(&gaps) || !(trb_norm(load.on_b.force) > 0.0)) continue;
      if (!border->coupled) trb_arrow_clear_border(arrow, j);
      border->coupled = 1;
      trb_coupling_place(&k, &d->rollers[j], &d->cage, &load);
      trb_add_wrench(&on_cage, &load.on_b);
      add_fast(d, j, &k, y_cage, still, arrow, &changes);
    }
  }
  cage_block(jac, y, &on_cage, &changes, arrow);
}
