#include "motion/dynamics.h"

#include <stdlib.h>

#include "contact/kernels.h"
#include "contact/uneven.h"

/* Bodies that rest have the same pose in the frames of all rollers, for good. */
static void make_bodies(trb_dynamics *d)
{
  const size_t rollers = (size_t)d->model->n_rollers;
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *is = &d->system->bodies[b];
    trb_body_at    *body = &d->bodies[b];
    body->rests = is->kind->rests;
    if (is->kind->place != NULL) is->kind->place(d->model, &d->drive, &body->ring);
    if (is->modes != NULL && (body->deformed = trb_memory_zeros(&d->memory, 1, sizeof *body->deformed)) != NULL) {
      const size_t n = (size_t)is->modes->n;
      body->deformed->modes = is->modes;
      body->deformed->amplitude = trb_memory_zeros(&d->memory, n, sizeof(double));
      body->deformed->rate = trb_memory_zeros(&d->memory, n, sizeof(double));
      body->deformed->force = trb_memory_zeros(&d->memory, n, sizeof(double));
      body->deformed->kernels = trb_kernel_variants[d->work->variant].modal;
    }
    if (trb_is_ring(is->kind)) body->in_frame = trb_memory_zeros(&d->memory, rollers, sizeof *body->in_frame);
    for (size_t j = 0; body->in_frame != NULL && j < rollers; j++) body->in_frame[j] = body->ring;
  }
}

/* What a fast pair with a body that deforms keeps of its modes. */
static void make_modes(trb_dynamics *d, trb_fast_pair *fast)
{
  const trb_body *body = &d->system->bodies[fast->pair->b];
  const size_t    n = (size_t)body->modes->n, rollers = (size_t)d->model->n_rollers;
  fast->places = trb_memory_zeros(&d->memory, n, sizeof *fast->places);
  fast->ways = trb_memory_zeros(&d->memory, rollers * n * TRB_N_GAPS, sizeof *fast->ways);
  fast->modal = trb_memory_zeros(&d->memory, rollers * n, sizeof *fast->modal);
  if (d->memory.lacks) return;
  for (size_t j = 0; j < rollers; j++) fast->pair->kind->ways(d->model, fast->pair, body->modes, (int)j, fast->ways + j * TRB_N_GAPS * n);
  for (size_t i = 0; i < n; i++) {
    double per[2];
    fast->places[i] = body->first + body->kind->amplitude(body, (int)i, per);
    for (size_t j = 0; j < rollers; j++)
      for (int g = 0; g < TRB_N_GAPS; g++) fast->ways[(j * n + i) * TRB_N_GAPS + (size_t)g] *= per[0];
  }
}

static void make_fast(trb_dynamics *d, const trb_pair *pair, int row)
{
  const int      n = d->model->n_rollers;
  trb_fast_pair *fast = &d->fast[d->n_fast++];
  fast->pair = pair;
  fast->row = row;
  fast->surfaces = trb_memory_zeros(&d->memory, (size_t)n, sizeof *fast->surfaces);
  fast->bounds = trb_memory_zeros(&d->memory, (size_t)n, sizeof *fast->bounds);
  for (int j = 0; j < n && !d->memory.lacks; j++) fast->surfaces[j] = pair->kind->surfaces(pair, j);
  pair->kind->arms(d->model, pair, fast->arms);
  if (d->system->bodies[pair->b].modes != NULL) make_modes(d, fast);
}

/* Of the system's bearing, after the workspace. */
static void make_arrays(trb_dynamics *d)
{
  trb_memory  *memory = &d->memory;
  const size_t n = (size_t)d->model->n_rollers;
  d->rollers = trb_memory_zeros(memory, n, sizeof *d->rollers);
  d->loads = trb_memory_zeros(memory, n, sizeof *d->loads);
  d->everyone = trb_memory_zeros(memory, n, sizeof *d->everyone);
  d->flows = trb_memory_zeros(memory, n, sizeof *d->flows);
  d->reactions = trb_memory_zeros(memory, n * (size_t)d->system->n_moving, sizeof *d->reactions);
  d->exact = trb_memory_zeros(memory, n, sizeof *d->exact);
  d->near = trb_memory_zeros(memory, n, sizeof *d->near);
  d->uneven = trb_memory_zeros(memory, n, sizeof *d->uneven);
  if (d->system->spacer >= 0) d->held = trb_memory_zeros(memory, (size_t)trb_state_size(d->system), sizeof *d->held);
  if (d->model->form.n > 0) {
    d->spin = trb_memory_zeros(memory, n, sizeof *d->spin);
    d->work->uneven = trb_memory_zeros(memory, 1, sizeof *d->work->uneven);
  }
  for (int j = 0; !memory->lacks && j < d->model->n_rollers; j++) d->everyone[j] = j;
  make_bodies(d);
  for (int i = 0; i < d->work->n_batches; i++)
    for (int k = 0; k < d->work->batches[i].n; k++)
      if (d->work->batches[i].pairs[k]->kind->pace == TRB_PACE_FAST)
        make_fast(d, d->work->batches[i].pairs[k], d->work->batches[i].index[k]);
}

trb_status trb_dynamics_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_dynamics **dynamics,
                               trb_message *message)
{
  *dynamics = NULL;
  trb_dynamics *d = calloc(1, sizeof *d);
  if (d == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  d->system = system;
  d->model = system->model;
  d->motion = motion;
  trb_status status = trb_workspace_create(system->pairs, system->n_pairs, variant, &d->work, message);
  if (status == TRB_OK) make_arrays(d);
  if (d->memory.lacks) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  if (status == TRB_OK) *dynamics = d;
  else trb_dynamics_free(d);
  return status;
}

void trb_dynamics_free(trb_dynamics *d)
{
  if (d == NULL) return;
  trb_workspace_free(d->work);
  trb_memory_free(&d->memory);
  free(d);
}
