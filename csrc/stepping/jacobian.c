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
static void roller_response(const trb_dynamics *d, int roller, const trb_roller_load *load, double *rates)
{
  double flow[TRB_FLOW_SIZE] = {0};
  trb_dynamics_roller_response(d, roller, load, flow);
  memcpy(rates, flow, TRB_NR * sizeof *rates);
}

/* Slopes of the cage's loads with each of its coordinates. */
typedef struct cage_loads {
  trb_vec3 force[TRB_NC], moment[TRB_NC];
} cage_loads;

/* Adds what a pocket in contact gives to its roller's block, to both borders and to the slopes of the cage's loads. still: rates of the
 * cage without loads. */
static void add_pocket(const trb_dynamics *d, int j, const trb_coupling *k, const double *y_cage, const double *still,
                       trb_arrow_block *block, trb_arrow_border *border, cage_loads *sums)
{
  double change[TRB_NR], rates[TRB_NC];
  for (int c = 0; c < TRB_NR; c++) {
    const trb_roller_load load = trb_coupling_of_roller(k, c);
    roller_response(d, j, &load, change);
    trb_dynamics_cage_rates(d, y_cage, load.cage_force, load.cage_moment, rates);
    for (int i = 0; i < TRB_NR; i++) block->own[c][i] += change[i];
    for (int i = 0; i < TRB_NC; i++) border->from[c][i] = rates[i] - still[i];
  }
  for (int c = 0; c < TRB_NC; c++) {
    const trb_roller_load load = trb_coupling_of_cage(k, c);
    roller_response(d, j, &load, change);
    for (int i = 0; i < TRB_NR; i++) border->to_cage[c][i] = change[i];
    sums->force[c] = trb_add(sums->force[c], load.cage_force);
    sums->moment[c] = trb_add(sums->moment[c], load.cage_moment);
  }
}

/* The block of the cage, by differences of its rates under a force and a moment that themselves change with its coordinates. */
static void cage_block(trb_jacobian *jac, const double *y, trb_vec3 force, trb_vec3 moment, const cage_loads *changes, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  double          *y_cage = jac->moved + trb_state_cage(m), base[TRB_NC], rates[TRB_NC];
  trb_dynamics_cage_rates(d, y + trb_state_cage(m), force, moment, base);
  for (int c = 0; c < TRB_NC; c++) {
    const double was = y_cage[c], h = trb_difference[trb_state_tolerance(m, trb_state_cage(m) + c)], per = 1.0 / h;
    y_cage[c] = was + h;
    trb_cage_pose_unpack(m, &d->drive, y_cage, &d->cage);
    trb_dynamics_cage_rates(d, y_cage, trb_axpy(force, h, changes->force[c]), trb_axpy(moment, h, changes->moment[c]), rates);
    for (int i = 0; i < TRB_NC; i++) arrow->cage[c][i] = per * (rates[i] - base[i]);
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
  if (!arrow->with_cage) return;
  const trb_instant at = trb_dynamics_instant(d);
  const double     *y_cage = y + trb_state_cage(m);
  trb_vec3          force = {0, 0, 0}, moment = {0, 0, 0};
  cage_loads        changes = {0};
  double            still[TRB_NC];
  trb_dynamics_cage_rates(d, y_cage, force, moment, still);
  for (int j = 0; j < m->n_rollers; j++) {
    trb_coupling          k;
    trb_roller_load       load;
    const trb_pocket_gaps gaps = trb_contact_pocket_of(m, &at, j, &d->work->counters, &load, &k.slopes, NULL);
    arrow->borders[j].coupled = !trb_pocket_clear(&gaps) && trb_norm(load.cage_force) > 0.0;
    if (!arrow->borders[j].coupled) continue;
    trb_coupling_place(&k, &d->rollers[j], &d->cage, &load);
    force = trb_add(force, load.cage_force);
    moment = trb_add(moment, load.cage_moment);
    add_pocket(d, j, &k, y_cage, still, &arrow->rollers[j], &arrow->borders[j], &changes);
  }
  cage_block(jac, y, force, moment, &changes, arrow);
}
