#include "motion/fast_pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* What a fast pair with a body that deforms keeps of its modes. */
static int add_modes(const trb_dynamics *d, trb_fast_pair *fast)
{
  const trb_body *body = &d->system->bodies[fast->pair->b];
  const size_t    n = (size_t)body->modes->n, rollers = (size_t)d->model->n_rollers;
  fast->places = calloc(n, sizeof *fast->places);
  fast->ways = trb_zeros(rollers * n * TRB_N_GAPS, sizeof *fast->ways);
  fast->modal = trb_zeros(rollers * n, sizeof *fast->modal);
  if (fast->places == NULL || fast->ways == NULL || fast->modal == NULL) return 0;
  for (size_t j = 0; j < rollers; j++) fast->pair->kind->ways(d->model, (int)j, fast->ways + j * TRB_N_GAPS * n);
  for (size_t i = 0; i < n; i++) {
    double per[2];
    fast->places[i] = body->first + body->kind->amplitude(body, (int)i, per);
    for (size_t j = 0; j < rollers; j++)
      for (int g = 0; g < TRB_N_GAPS; g++) fast->ways[(j * n + i) * TRB_N_GAPS + (size_t)g] *= per[0];
  }
  return 1;
}

int trb_fast_create(trb_dynamics *d)
{
  for (int i = 0; i < d->work->n_batches; i++)
    for (int k = 0; k < d->work->batches[i].n; k++) {
      const trb_pair *pair = d->work->batches[i].pairs[k];
      if (pair->kind->pace != TRB_PACE_FAST) continue;
      trb_fast_pair *fast = &d->fast[d->n_fast];
      fast->pair = pair;
      fast->row = d->work->batches[i].index[k];
      fast->bounds = calloc((size_t)d->model->n_rollers, sizeof *fast->bounds);
      if (fast->bounds == NULL) return 0;
      d->n_fast++;
      pair->kind->arms(d->model, pair, fast->arms);
      if (d->system->bodies[pair->b].modes != NULL && !add_modes(d, fast)) return 0;
    }
  return 1;
}

void trb_fast_free(trb_dynamics *d)
{
  for (int f = 0; f < d->n_fast; f++) {
    free(d->fast[f].bounds);
    free(d->fast[f].places);
    free(d->fast[f].ways);
    free(d->fast[f].modal);
  }
}

/* The part of a state that belongs to the other body of a fast pair. */
static const double *of_body(const trb_dynamics *d, const trb_fast_pair *fast, const double *y)
{
  return y + d->system->bodies[fast->pair->b].first;
}

/* Ways by which a body's deformation has moved what a roller may touch since its gaps were found; NULL: the body is rigid. */
static const double *deformed_by(const trb_dynamics *d, const trb_fast_pair *fast, int roller, const double *y, double ways[TRB_N_GAPS])
{
  const trb_body *body = &d->system->bodies[fast->pair->b];
  if (body->modes == NULL) return NULL;
  const int     n = body->modes->n;
  const double *way = fast->ways + (size_t)roller * TRB_N_GAPS * (size_t)n, *from = fast->modal + (size_t)roller * (size_t)n;
  double        sum[2][TRB_N_GAPS] = {{0}}; /* side by side: one sum alone would wait for each of its additions */
  int           i = 0;
  for (; i + 2 <= n; i += 2, way += 2 * TRB_N_GAPS) {
    const double moved = fabs(y[fast->places[i]] - from[i]), next = fabs(y[fast->places[i + 1]] - from[i + 1]);
    for (int g = 0; g < TRB_N_GAPS; g++) sum[0][g] += way[g] * moved;
    for (int g = 0; g < TRB_N_GAPS; g++) sum[1][g] += way[TRB_N_GAPS + g] * next;
  }
  for (int g = 0; i < n && g < TRB_N_GAPS; g++) sum[0][g] += way[g] * fabs(y[fast->places[i]] - from[i]);
  for (int g = 0; g < TRB_N_GAPS; g++) ways[g] = sum[0][g] + sum[1][g];
  return ways;
}

static int is_clear(const trb_dynamics *d, const trb_fast_pair *fast, int roller, const double *y)
{
  double        ways[TRB_N_GAPS];
  const double *deformed = deformed_by(d, fast, roller, y, ways);
  return trb_bound_clear(&fast->bounds[roller], fast->arms, deformed, y + trb_state_roller(d->system, roller), of_body(d, fast, y));
}

double trb_fast_gap_left(const trb_dynamics *d, int fast, int roller, const double *y)
{
  const trb_fast_pair *pair = &d->fast[fast];
  double               ways[TRB_N_GAPS];
  const double        *deformed = deformed_by(d, pair, roller, y, ways);
  return trb_bound_left(&pair->bounds[roller], pair->arms, deformed, y + trb_state_roller(d->system, roller), of_body(d, pair, y));
}

int trb_fast_clear_within(const trb_dynamics *d, int fast, int roller, const double *y, const double *of_roller, const double *of_hub)
{
  const trb_fast_pair *pair = &d->fast[fast];
  const double        *ways = of_hub + d->system->bodies[pair->pair->b].first - trb_state_hub(d->system);
  return trb_bound_clear_within(&pair->bounds[roller], pair->arms, y + trb_state_roller(d->system, roller), of_body(d, pair, y), of_roller,
                                ways);
}

void trb_fast_apart(const trb_dynamics *d, const double *y, unsigned *apart)
{
  const trb_model *m = d->model;
  memset(apart, 0, (size_t)m->n_rollers * sizeof *apart);
  for (int f = 0; f < d->n_fast; f++) {
    const trb_fast_pair *fast = &d->fast[f];
    for (int j = 0; j < m->n_rollers; j++)
      if (is_clear(d, fast, j, y)) apart[j] |= 1U << fast->row;
  }
}

void trb_fast_forget(trb_dynamics *d)
{
  for (int f = 0; f < d->n_fast; f++) memset(d->fast[f].bounds, 0, (size_t)d->model->n_rollers * sizeof *d->fast[f].bounds);
}

unsigned trb_fast_near(const trb_dynamics *d, int roller, const double *y)
{
  const trb_model *m = d->model;
  unsigned         near = 0;
  for (int f = 0; f < d->n_fast; f++) {
    const trb_fast_pair *fast = &d->fast[f];
    if (fast->pair->kind->surfaces(m, roller) == 0) continue;
    if (is_clear(d, fast, roller, y)) fast->pair->kind->count_clear(m, roller, &d->work->counters);
    else near |= 1U << f;
  }
  return near;
}

trb_gaps trb_fast_touch(trb_dynamics *d, int fast, int roller, const double *y, trb_load *load, trb_slopes *slopes, trb_detail *detail)
{
  const trb_instant at = trb_dynamics_instant(d);
  trb_fast_pair    *pair = &d->fast[fast];
  const trb_gaps    gaps = pair->pair->kind->touch(d->model, pair->pair, &at, roller, &d->work->counters, load, slopes, detail);
  trb_bound_set(d->model, &pair->bounds[roller], &gaps, y + trb_state_roller(d->system, roller), of_body(d, pair, y));
  const trb_modes *modes = d->system->bodies[pair->pair->b].modes;
  for (int i = 0; modes != NULL && i < modes->n; i++) pair->modal[roller * modes->n + i] = y[pair->places[i]];
  return gaps;
}

void trb_fast_add(trb_dynamics *d, int roller, const double *y, double *flow)
{
  for (int f = 0; f < d->n_fast; f++) {
    const trb_pair *pair = d->fast[f].pair;
    trb_load        load;
    if (!(d->near[roller] >> f & 1U)) continue;
    const trb_gaps gaps = trb_fast_touch(d, f, roller, y, &load, NULL, NULL);
    if (trb_gaps_clear(&gaps)) continue;
    trb_roller_response(d->model, &d->rollers[roller], &load.on_a, flow);
    trb_book_losses(&pair->books, &load, flow + TRB_FLOW_quadrature + TRB_Q_losses);
    trb_add_wrench(&d->on_body[pair->b], &load.on_b);
  }
}
