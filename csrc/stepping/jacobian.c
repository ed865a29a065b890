#include "stepping/jacobian.h"

#include <stdlib.h>
#include <string.h>

/* Differences by kind of entry: small beside what curves the laws (micrometres of interference, 1e-4 of slip), large beside rounding. */
static const double difference[TRB_N_TOLERANCES] = {1e-10, 1e-8, 1e-7, 1e-5, 1.0};

trb_status trb_jacobian_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_jacobian **jacobian, trb_message *message)
{
  trb_jacobian *j = calloc(1, sizeof *j);
  *jacobian = NULL;
  if (j == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian");
  const size_t n = (size_t)m->n_rollers;
  trb_status   status = trb_dynamics_create(m, motion, variant, &j->d, message);
  if (status == TRB_OK) {
    j->base = calloc(n, sizeof *j->base);
    j->pocket = calloc(n, sizeof *j->pocket);
    j->rates = calloc(n * TRB_NR, sizeof *j->rates);
    j->moved = calloc((size_t)trb_state_size(m), sizeof *j->moved);
    if (!j->base || !j->pocket || !j->rates || !j->moved) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian");
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
  free(jacobian->base);
  free(jacobian->pocket);
  free(jacobian->rates);
  free(jacobian->moved);
  free(jacobian);
}

/* Rates of the cage are affine in what the rollers put on it: this is their linear part. */
static void cage_response(const trb_dynamics *d, const double *y_cage, trb_vec3 force, trb_vec3 moment, double *rates)
{
  double still[TRB_NC];
  trb_dynamics_cage_rates(d, y_cage, trb_v(0, 0, 0), trb_v(0, 0, 0), still);
  trb_dynamics_cage_rates(d, y_cage, force, moment, rates);
  for (int i = 0; i < TRB_NC; i++) rates[i] -= still[i];
}

/* Column c of every roller's block and of the border from the rollers. */
static void roller_column(trb_jacobian *jac, int c, const double *y, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  const double    *y_cage = y + trb_state_cage(m);
  const double     h = difference[trb_state_tolerance(m, c)], per = 1.0 / h;
  for (int j = 0; j < m->n_rollers; j++) {
    jac->moved[trb_state_roller(j) + c] = y[trb_state_roller(j) + c] + h;
    trb_dynamics_pose_roller(d, j, jac->moved + trb_state_roller(j));
  }
  trb_dynamics_loads(d, NULL);
  for (int j = 0; j < m->n_rollers; j++) {
    double rates[TRB_NR], response[TRB_NC];
    trb_dynamics_roller_rates(d, j, jac->moved + trb_state_roller(j), &d->loads[j], rates);
    for (int i = 0; i < TRB_NR; i++) arrow->rollers[j].own[i][c] = per * (rates[i] - jac->rates[j * TRB_NR + i]);
    jac->moved[trb_state_roller(j) + c] = y[trb_state_roller(j) + c];
    if (!arrow->with_cage) continue;
    cage_response(d, y_cage, trb_sub(d->loads[j].cage_force, jac->base[j].cage_force), trb_sub(d->loads[j].cage_moment, jac->base[j].cage_moment), response);
    for (int i = 0; i < TRB_NC; i++) arrow->rollers[j].from[i][c] = per * response[i];
  }
}

/* Column c of the cage's block and of the border to the rollers; the rollers stand at the state. */
static void cage_column(trb_jacobian *jac, int c, const double *y, const double *base_rates, trb_vec3 force, trb_vec3 moment, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  const int        at = trb_state_cage(m) + c;
  const double     h = difference[trb_state_tolerance(m, at)], per = 1.0 / h;
  double           rates[TRB_NC];
  jac->moved[at] = y[at] + h;
  trb_cage_pose_unpack(m, &d->drive, jac->moved + trb_state_cage(m), &d->cage);
  const trb_instant here = trb_dynamics_instant(d);
  trb_contact_cage_only(m, &here, d->work, d->loads);
  for (int j = 0; j < m->n_rollers; j++) {
    const trb_roller_load *now = &d->loads[j], *was = &jac->pocket[j];
    trb_roller_load        change = {.force = trb_sub(now->force, was->force), .moment = trb_sub(now->moment, was->moment)}, none = {0};
    double                 with[TRB_NR], without[TRB_NR];
    trb_dynamics_roller_rates(d, j, y + trb_state_roller(j), &change, with);
    trb_dynamics_roller_rates(d, j, y + trb_state_roller(j), &none, without);
    for (int i = 0; i < TRB_NR; i++) arrow->rollers[j].to_cage[i][c] = per * (with[i] - without[i]);
    force = trb_add(force, trb_sub(now->cage_force, was->cage_force));
    moment = trb_add(moment, trb_sub(now->cage_moment, was->cage_moment));
  }
  trb_dynamics_cage_rates(d, jac->moved + trb_state_cage(m), force, moment, rates);
  for (int i = 0; i < TRB_NC; i++) arrow->cage[i][c] = per * (rates[i] - base_rates[i]);
  jac->moved[at] = y[at];
}

void trb_jacobian_fill(trb_jacobian *jac, double time, const double *y, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  const trb_model *m = d->model;
  trb_vec3         force = {0, 0, 0}, moment = {0, 0, 0};
  double           cage_rates[TRB_NC];
  trb_arrow_zero(arrow);
  memcpy(jac->moved, y, (size_t)trb_state_size(m) * sizeof *y);
  trb_dynamics_pose(d, time, y);
  trb_dynamics_loads(d, NULL);
  memcpy(jac->base, d->loads, (size_t)m->n_rollers * sizeof *jac->base);
  for (int j = 0; j < m->n_rollers; j++) {
    trb_dynamics_roller_rates(d, j, y + trb_state_roller(j), &d->loads[j], jac->rates + j * TRB_NR);
    force = trb_add(force, d->loads[j].cage_force);
    moment = trb_add(moment, d->loads[j].cage_moment);
  }
  for (int c = 0; c < TRB_NR; c++) {
    roller_column(jac, c, y, arrow);
  }
  if (!arrow->with_cage) return;
  trb_dynamics_pose(d, time, y);
  trb_dynamics_cage_rates(d, y + trb_state_cage(m), force, moment, cage_rates);
  const trb_instant here = trb_dynamics_instant(d);
  trb_contact_cage_only(m, &here, d->work, d->loads);
  memcpy(jac->pocket, d->loads, (size_t)m->n_rollers * sizeof *jac->pocket);
  for (int c = 0; c < TRB_NC; c++) cage_column(jac, c, y, cage_rates, force, moment, arrow);
}
