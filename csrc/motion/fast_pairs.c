#include "motion/fast_pairs.h"

#include <math.h>
#include <string.h>

void trb_bound_set(const trb_model *m, trb_bound *bound, const trb_gaps *gaps, const double *y_roller, const double *y_body)
{
  const double far = fabs(y_roller[TRB_ROLLER_r]) + fabs(y_roller[TRB_ROLLER_z]) + fabs(y_body[0]) + fabs(y_body[1]) + fabs(y_body[2]);
  /* a gap that is not a number (NaN) proves nothing */
  for (int g = 0; g < TRB_N_GAPS; g++)
    bound->length[g] = far < trb_bound_play(m) && gaps->of[g] > 0.0 ? trb_min(gaps->of[g], trb_bound_play(m)) : 0.0;
  memcpy(bound->roller, y_roller, sizeof bound->roller);
  memcpy(bound->body, y_body, sizeof bound->body);
}

/* Adds what has changed of each gap, at most. */
static inline void add_ways(const trb_bound *bound, const trb_arms *arms, const double *y_roller, const double *y_body,
                            double ways[TRB_N_GAPS])
{
  for (int i = 0; i < TRB_PLACE_OF_ROLLER; i++) {
    const double moved = fabs(y_roller[i] - bound->roller[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) ways[g] += arms[g].roller[i] * moved;
  }
  for (int i = 0; i < TRB_PLACE_OF_BODY; i++) {
    const double moved = fabs(y_body[i] - bound->body[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) ways[g] += arms[g].body[i] * moved;
  }
}

/* Whether ways leave something of every gap; where one is not a number (NaN) the comparisons are false: nothing is proven. */
static int holds(const trb_bound *bound, const double ways[TRB_N_GAPS])
{
  return ways[TRB_GAP_FLANK] < bound->length[TRB_GAP_FLANK] && ways[TRB_GAP_ENDS] < bound->length[TRB_GAP_ENDS];
}

int trb_bound_clear(const trb_bound *bound, const trb_arms *arms, const double *deformed, const double *y_roller, const double *y_body)
{
  double ways[TRB_N_GAPS] = {0};
  if (!holds(bound, ways)) return 0;
  if (deformed != NULL) memcpy(ways, deformed, sizeof ways);
  add_ways(bound, arms, y_roller, y_body, ways);
  return holds(bound, ways);
}

double trb_bound_left(const trb_bound *bound, const trb_arms *arms, const double *deformed, const double *y_roller, const double *y_body)
{
  double ways[TRB_N_GAPS] = {0};
  if (deformed != NULL) memcpy(ways, deformed, sizeof ways);
  add_ways(bound, arms, y_roller, y_body, ways);
  return fmin(bound->length[TRB_GAP_FLANK] - ways[TRB_GAP_FLANK], bound->length[TRB_GAP_ENDS] - ways[TRB_GAP_ENDS]);
}

/* The part of a state that belongs to the other body of a fast pair. */
static const double *part_of(const trb_dynamics *d, const trb_fast_pair *fast, const double *y)
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
  return trb_bound_clear(&fast->bounds[roller], fast->arms, deformed, y + trb_state_roller(d->system, roller), part_of(d, fast, y));
}

double trb_fast_gap_left(const trb_dynamics *d, int fast, int roller, const double *y)
{
  const trb_fast_pair *pair = &d->fast[fast];
  double               ways[TRB_N_GAPS];
  const double        *deformed = deformed_by(d, pair, roller, y, ways);
  return trb_bound_left(&pair->bounds[roller], pair->arms, deformed, y + trb_state_roller(d->system, roller), part_of(d, pair, y));
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
  unsigned near = 0;
  for (int f = 0; f < d->n_fast; f++) {
    const trb_fast_pair *fast = &d->fast[f];
    if (fast->surfaces[roller] == 0) continue;
    if (!is_clear(d, fast, roller, y)) {
      near |= 1U << f;
      continue;
    }
    d->work->counters.pocket_tests += fast->surfaces[roller];
    d->work->counters.pocket_culled += fast->surfaces[roller];
  }
  return near;
}

trb_gaps trb_fast_touch(trb_dynamics *d, int fast, int roller, const double *y, trb_load *load, trb_slopes *slopes, trb_detail *detail)
{
  const trb_instant at = trb_dynamics_instant(d, NULL, 0);
  trb_fast_pair    *pair = &d->fast[fast];
  const trb_gaps    gaps = pair->pair->kind->touch(d->model, pair->pair, &at, roller, &d->work->counters, load, slopes, detail);
  trb_bound_set(d->model, &pair->bounds[roller], &gaps, y + trb_state_roller(d->system, roller), part_of(d, pair, y));
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
