#include "stepping/jacobian.h"

#include <stdlib.h>
#include <string.h>

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

/* Loads between one roller and its pocket at the poses kept. */
static trb_roller_load pocket_load(trb_dynamics *d, int roller)
{
  const trb_instant at = trb_dynamics_instant(d);
  trb_roller_load   load;
  memset(&load, 0, sizeof load);
  (void)trb_contact_pocket_of(d->model, &at, roller, &d->work->counters, &load, NULL);
  return load;
}

/* What a load adds to the rates of a roller, and of the cage. */
static void roller_response(const trb_dynamics *d, int roller, const trb_roller_load *load, double *rates)
{
  double flow[TRB_FLOW_SIZE] = {0};
  trb_dynamics_roller_response(d, roller, load, flow);
  memcpy(rates, flow, TRB_NR * sizeof *rates);
}

static void cage_response(const trb_dynamics *d, const double *y_cage, trb_vec3 force, trb_vec3 moment, double *rates)
{
  double still[TRB_NC];
  trb_dynamics_cage_rates(d, y_cage, trb_v(0, 0, 0), trb_v(0, 0, 0), still);
  trb_dynamics_cage_rates(d, y_cage, force, moment, rates);
  for (int i = 0; i < TRB_NC; i++) rates[i] -= still[i];
}

/* What a pocket in contact adds to its roller's block and to the border from it. */
static void pocket_columns(trb_jacobian *jac, int j, const double *y, const trb_roller_load *base, trb_arrow_block *block,
                           trb_arrow_border *border)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  const double    *y_cage = y + trb_state_cage(m), *yj = y + trb_state_roller(j);
  double          *moved = jac->moved + trb_state_roller(j), was[TRB_NR];
  roller_response(d, j, base, was);
  for (int c = 0; c < TRB_NR; c++) {
    const double h = trb_difference[trb_state_tolerance(m, c)], per = 1.0 / h;
    double       now[TRB_NR], response[TRB_NC];
    moved[c] = yj[c] + h;
    trb_dynamics_pose_roller(d, j, moved);
    const trb_roller_load load = pocket_load(d, j);
    roller_response(d, j, &load, now);
    cage_response(d, y_cage, trb_sub(load.cage_force, base->cage_force), trb_sub(load.cage_moment, base->cage_moment), response);
    for (int i = 0; i < TRB_NR; i++) block->own[c][i] += per * (now[i] - was[i]);
    for (int i = 0; i < TRB_NC; i++) border->from[c][i] = per * response[i];
    moved[c] = yj[c];
  }
  trb_dynamics_pose_roller(d, j, yj);
}

/* Column c of the cage's block and of the border to the rollers that touch. base: pocket loads, with rollers' flags in `touch`. */
static void cage_column(trb_jacobian *jac, int c, const double *y, const trb_roller_load *base, const double *base_rates, trb_vec3 force,
                        trb_vec3 moment, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  const int        at = trb_state_cage(m) + c;
  const double     h = trb_difference[trb_state_tolerance(m, at)], per = 1.0 / h;
  double           rates[TRB_NC];
  jac->moved[at] = y[at] + h;
  trb_cage_pose_unpack(m, &d->drive, jac->moved + trb_state_cage(m), &d->cage);
  for (int j = 0; j < m->n_rollers; j++) {
    if (!arrow->borders[j].coupled) continue;
    const trb_roller_load now = pocket_load(d, j);
    trb_roller_load       change;
    double                response[TRB_NR];
    memset(&change, 0, sizeof change);
    change.force = trb_sub(now.force, base[j].force);
    change.moment = trb_sub(now.moment, base[j].moment);
    roller_response(d, j, &change, response);
    for (int i = 0; i < TRB_NR; i++) arrow->borders[j].to_cage[c][i] = per * response[i];
    force = trb_add(force, trb_sub(now.cage_force, base[j].cage_force));
    moment = trb_add(moment, trb_sub(now.cage_moment, base[j].cage_moment));
  }
  trb_dynamics_cage_rates(d, jac->moved + trb_state_cage(m), force, moment, rates);
  for (int i = 0; i < TRB_NC; i++) arrow->cage[c][i] = per * (rates[i] - base_rates[i]);
  jac->moved[at] = y[at];
}

static int touches(const trb_roller_load *load) { return trb_dot(load->cage_force, load->cage_force) > 0.0; }

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
  trb_vec3 force = {0, 0, 0}, moment = {0, 0, 0};
  double   cage_rates[TRB_NC];
  /* no pair of the rings runs from here on: their loads' place serves the pockets */
  trb_roller_load *base = d->loads;
  for (int j = 0; j < m->n_rollers; j++) {
    base[j] = pocket_load(d, j);
    arrow->borders[j].coupled = touches(&base[j]);
    if (!arrow->borders[j].coupled) continue;
    force = trb_add(force, base[j].cage_force);
    moment = trb_add(moment, base[j].cage_moment);
    pocket_columns(jac, j, y, &base[j], &arrow->rollers[j], &arrow->borders[j]);
  }
  trb_dynamics_cage_rates(d, y + trb_state_cage(m), force, moment, cage_rates);
  for (int c = 0; c < TRB_NC; c++) cage_column(jac, c, y, base, cage_rates, force, moment, arrow);
}
