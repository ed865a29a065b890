#include "motion/audit.h"

/* Of a body with axial symmetry; omega in (n, t, a). */
static double kinetic(double mass, double axial, double transverse, trb_vec3 v, trb_vec3 omega)
{
  return 0.5 * (mass * trb_dot(v, v) + transverse * (omega.x * omega.x + omega.y * omega.y) + axial * omega.z * omega.z);
}

double trb_audit_kinetic(const trb_dynamics *d)
{
  const trb_model    *m = d->model;
  const trb_geometry *g = &m->geometry;
  double              energy = 0.0;
  for (int j = 0; j < m->n_rollers; j++)
    energy += kinetic(g->roller_mass, g->roller_inertia_axial, g->roller_inertia_transverse, d->rollers[j].v, d->rollers[j].omega_frame);
  if (m->params.with_cage > 0.0)
    energy += kinetic(m->params.cage_mass, m->params.cage_inertia_axial, m->params.cage_inertia_transverse, d->cage.v, d->cage.omega_frame);
  return energy;
}

double trb_audit_elastic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += d->loads[j].elastic;
  return energy;
}
