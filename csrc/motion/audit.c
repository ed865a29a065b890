#include "motion/audit.h"

double trb_audit_kinetic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += trb_roller_kinetic(d->model, &d->rollers[j]);
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    if (body->size > 0 && !body->carried) energy += body->kind->kinetic(d->model, body, &d->bodies[b].pose) + d->bodies[b].pose.moving;
  }
  return energy;
}

double trb_audit_elastic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += d->loads[j].elastic;
  for (int b = 0; b < d->system->n_bodies; b++) energy += d->system->bodies[b].carried ? 0.0 : d->bodies[b].pose.stored;
  return energy + d->hub.elastic;
}
