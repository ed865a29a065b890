#include "motion/audit.h"

double trb_audit_kinetic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += trb_roller_kinetic(d->model, &d->rollers[j]);
  for (int b = 0; b < d->n_bodies; b++) energy += d->bodies[b].kind->kinetic(d->model, &d->bodies[b].pose);
  return energy;
}

double trb_audit_elastic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += d->loads[j].elastic;
  return energy + d->hub.elastic;
}
