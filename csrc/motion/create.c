/* How the dynamics of a system are made and freed. */
#include <stdlib.h>

#include "base/memory.h"
#include "contact/kernels.h"
#include "contact/uneven.h"
#include "motion/fast_pairs.h"

static trb_deformed *deformed_of(const trb_modes *modes)
{
  const size_t  n = (size_t)modes->n;
  trb_deformed *to = calloc(1, sizeof *to);
  if (to == NULL) return NULL;
  to->modes = modes;
  to->amplitude = trb_zeros(3 * n, sizeof *to->amplitude);
  if (to->amplitude == NULL) {
    free(to);
    return NULL;
  }
  to->rate = to->amplitude + n;
  to->force = to->rate + n;
  return to;
}

static void free_deformed(trb_deformed *deformed)
{
  if (deformed != NULL) free(deformed->amplitude);
  free(deformed);
}

/* Bodies that rest have the same pose in the frames of all rollers, for good. */
static int make_bodies(trb_dynamics *d)
{
  for (int b = 0; b < d->system->n_bodies; b++) d->bodies[b].rests = d->system->bodies[b].kind->rests;
  trb_dynamics_place(d);
  for (int b = 0; b < d->system->n_bodies; b++) {
    trb_body_at     *body = &d->bodies[b];
    const trb_modes *modes = d->system->bodies[b].modes;
    if (modes != NULL && (body->deformed = deformed_of(modes)) == NULL) return 0;
    if (!trb_is_ring(d->system->bodies[b].kind)) continue;
    body->in_frame = calloc((size_t)d->model->n_rollers, sizeof *body->in_frame);
    if (body->in_frame == NULL) return 0;
    for (int j = 0; j < d->model->n_rollers; j++) body->in_frame[j] = body->ring;
  }
  return 1;
}

/* Of the workspace's variant. */
static void choose_kernels(const trb_dynamics *d)
{
  for (int b = 0; b < d->system->n_bodies; b++)
    if (d->bodies[b].deformed != NULL) d->bodies[b].deformed->kernels = trb_kernel_variants[d->work->variant].modal;
}

static int make_uneven(trb_dynamics *d)
{
  d->spin = trb_zeros((size_t)d->model->n_rollers, sizeof *d->spin);
  d->work->uneven = trb_zeros(1, sizeof *d->work->uneven);
  return d->spin != NULL && d->work->uneven != NULL;
}

trb_status trb_dynamics_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_dynamics **dynamics,
                               trb_message *message)
{
  const trb_model *m = system->model;
  *dynamics = NULL;
  trb_dynamics *d = calloc(1, sizeof *d);
  if (d == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  const size_t n = (size_t)m->n_rollers;
  d->system = system;
  d->model = m;
  d->motion = motion;
  d->spin_at = trb_state_spin(system);
  d->quadrature = trb_state_quadrature(system);
  d->rollers = calloc(n, sizeof *d->rollers);
  d->loads = calloc(n, sizeof *d->loads);
  d->everyone = calloc(n, sizeof *d->everyone);
  d->flows = trb_zeros(n, sizeof *d->flows);
  d->reactions = calloc(n * (size_t)system->n_moving + 1, sizeof *d->reactions);
  d->exact = calloc(n, sizeof *d->exact);
  d->near = calloc(n, sizeof *d->near);
  d->uneven = calloc(n, sizeof *d->uneven);
  if (system->spacer >= 0) d->held = calloc((size_t)trb_state_size(system), sizeof *d->held);
  trb_status status = TRB_OK;
  if (!make_bodies(d) || d->rollers == NULL || d->loads == NULL || d->everyone == NULL || d->flows == NULL || d->exact == NULL ||
      d->near == NULL || d->uneven == NULL || d->reactions == NULL || (system->spacer >= 0 && d->held == NULL)) {
    status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  } else {
    for (int j = 0; j < m->n_rollers; j++) d->everyone[j] = j;
    status = trb_workspace_create(system->pairs, system->n_pairs, variant, &d->work, message);
    if (status == TRB_OK) choose_kernels(d);
    if (status == TRB_OK && m->form.n > 0 && !make_uneven(d)) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
    if (status == TRB_OK && !trb_fast_create(d)) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  }
  if (status != TRB_OK) {
    trb_dynamics_free(d);
    return status;
  }
  *dynamics = d;
  return TRB_OK;
}

void trb_dynamics_free(trb_dynamics *d)
{
  if (d == NULL) return;
  trb_workspace_free(d->work);
  free(d->rollers);
  for (int b = 0; b < d->system->n_bodies; b++) {
    free(d->bodies[b].in_frame);
    free_deformed(d->bodies[b].deformed);
  }
  free(d->loads);
  free(d->everyone);
  trb_fast_free(d);
  free(d->flows);
  free(d->reactions);
  free(d->exact);
  free(d->spin);
  free(d->near);
  free(d->uneven);
  free(d->held);
  free(d);
}
