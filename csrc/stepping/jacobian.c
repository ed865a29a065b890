#include "stepping/jacobian.h"

#include <stdlib.h>
#include <string.h>

#include "stepping/constants.h"
#include "stepping/coupling.h"
#include "stepping/spacer_blocks.h"

trb_status trb_jacobian_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_jacobian **jacobian,
                               trb_message *message)
{
  *jacobian = NULL;
  for (int k = 0; k < system->n_moving; k++)
    if (system->bodies[system->moving[k]].size > TRB_NP)
      return trb_fail(message, TRB_ERR_INPUT, "body %s: a ring has at most %d coordinates", system->bodies[system->moving[k]].name, TRB_NP);
  trb_jacobian *j = calloc(1, sizeof *j);
  if (j == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian");
  trb_status status = trb_dynamics_create(system, motion, variant, &j->d, message);
  if (status == TRB_OK) {
    const size_t width = (size_t)system->layout.hub_width;
    j->moved = trb_memory_zeros(&j->memory, (size_t)trb_state_size(system), sizeof *j->moved);
    j->rates = trb_memory_zeros(&j->memory, 3 * width, sizeof *j->rates);
    j->changes = trb_memory_zeros(&j->memory, width, sizeof *j->changes);
    j->response = trb_memory_zeros(&j->memory, 6 * width, sizeof *j->response);
    j->with = trb_memory_zeros(&j->memory, width, sizeof *j->with);
    j->ring_response = trb_memory_zeros(&j->memory, (size_t)system->n_moving, sizeof *j->ring_response);
    j->ring_reactions = trb_memory_zeros(&j->memory, (size_t)system->n_moving, sizeof *j->ring_reactions);
    trb_law_slopes_create(system->model, &j->memory, j->d->work);
    j->renewed = trb_memory_zeros(&j->memory, (size_t)system->model->n_rollers, sizeof *j->renewed);
    for (int b = 0; b < system->n_bodies; b++)
      if (system->bodies[b].modes != NULL) j->modal[b] = trb_modal_create(&j->memory, &system->bodies[b], system->layout.hub_width);
    if (j->memory.lacks) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for the Jacobian");
    else status = trb_tangents_create(system, &j->tangents, message);
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
  trb_memory_free(&jacobian->memory);
  free(jacobian);
}

/* Number of a roller among those of all systems. */
static int leaf_of(const trb_dynamics *d, int roller) { return d->system->layout.leaf + roller; }

/* Rates of a roller that a load gives. */
static void roller_response(const trb_dynamics *d, int roller, const trb_wrench *load, double *rates)
{
  memset(rates, 0, TRB_NR * sizeof *rates);
  trb_roller_response(d->model, &d->rollers[roller], load, rates);
}

/* Rates of a body, at its pose, under a load; hub: rates of the whole hub, where they are put. */
static void body_rates(const trb_dynamics *d, int body, const double *y, const trb_wrench *load, double *hub)
{
  const trb_body *is = &d->system->bodies[body];
  if (is->size == 0) return;
  trb_dynamics_body_rates(d, body, y, load, hub + is->first - trb_state_hub(d->system));
}

/* Adds what a fast pair in contact gives to its roller's block, to both borders and to the slopes of the loads of the other body. still:
 * rates of the hub without loads. */
static void add_fast(trb_jacobian *jac, int j, const trb_coupling *k, int other, const double *y, const double *still, trb_arrow *arrow)
{
  const trb_dynamics *d = jac->d;
  const trb_body     *body = &d->system->bodies[other];
  trb_arrow_block    *block = &arrow->rollers[leaf_of(d, j)];
  trb_arrow_border   *border = &arrow->borders[leaf_of(d, j)];
  const int           size = trb_rigid_coordinates(body), first = body->first - trb_state_hub(d->system);
  double             *rates = jac->rates, change[TRB_NR];
  for (int c = 0; c < TRB_NR; c++) {
    const trb_load load = trb_coupling_of_roller(k, c);
    double        *from = border->from + c * arrow->room + first;
    roller_response(d, j, &load.on_a, change);
    body_rates(d, other, y, &load.on_b, rates);
    for (int i = 0; i < TRB_NR; i++) block->own[c][i] += change[i];
    for (int i = 0; i < size; i++) from[i] += rates[first + i] - still[first + i];
  }
  for (int c = 0; c < size; c++) {
    const trb_load load = trb_coupling_of_body(k, c);
    double        *to = border->to_hub + (first + c) * TRB_NR;
    roller_response(d, j, &load.on_a, change);
    for (int i = 0; i < TRB_NR; i++) to[i] += change[i];
    trb_add_wrench(&jac->changes[first + c], &load.on_b);
  }
  if (k->slopes.modal != NULL) trb_modal_add(jac->modal[other], d, j, k, first, arrow, jac->changes);
}

/* Rates of the hub at the poses kept. Loads of the fast pairs are those of the bodies; that of body `moved` changes with its coordinate at, which was
 * moved by h; -1: none was. Pairs without a roller are evaluated; where there are none, only the rates of that body are written. */
static void hub_rates(trb_jacobian *jac, const double *y, int moved, int at, double h, double *rates)
{
  trb_dynamics *d = jac->d;
  if (d->work->n_hub > 0) trb_dynamics_hub(d, NULL);
  for (int b = 0; b < d->system->n_bodies; b++) {
    trb_wrench load = d->on_body[b];
    if (d->work->n_hub == 0 && b != moved) continue;
    if (b == moved) load = (trb_wrench){trb_axpy(load.force, h, jac->changes[at].force), trb_axpy(load.moment, h, jac->changes[at].moment)};
    if (d->work->n_hub > 0) trb_add_wrench(&load, &d->hub.on[b]);
    body_rates(d, b, y, &load, rates);
  }
}

/* What a wrench does to a body's rates, which is linear. still: rates of the hub without loads. */
static void respond(trb_jacobian *jac, int b, const double *y, const double *still)
{
  const trb_dynamics *d = jac->d;
  const trb_body     *body = &d->system->bodies[b];
  const int           first = body->first - trb_state_hub(d->system);
  const double        force = body->kind->mass(d->model, body), arm = 0.5 * d->model->params.bearing.pitch_diameter;
  for (int c = 0; c < 6; c++) {
    const double unit[6] = {c == 0, c == 1, c == 2, c == 3, c == 4, c == 5}, size = c < 3 ? force : force * arm * arm;
    trb_wrench   load = {trb_scale(size, trb_v(unit[0], unit[1], unit[2])), trb_scale(size, trb_v(unit[3], unit[4], unit[5]))};
    body_rates(d, b, y, &load, jac->rates);
    for (int i = 0; i < body->size; i++) jac->response[6 * first + c * body->size + i] = (jac->rates[first + i] - still[first + i]) / size;
  }
}

/* Adds the first rates of a body's response to a wrench: its force, then its moment. */
static void add_response(const trb_jacobian *jac, const trb_body *body, int n, const double *wrench, double *restrict rates)
{
  const double *of = jac->response + 6 * (body->first - trb_state_hub(jac->d->system));
  for (int q = 0; q < 6; q++, of += body->size)
    for (int i = 0; i < n; i++) rates[i] += wrench[q] * of[i];
}

/* Adds the columns of the hub that belong to the modes of a body, in closed form: they change loads, and themselves. */
static void modal_columns(trb_jacobian *jac, int b, const double *y, const double *still, trb_arrow *arrow)
{
  const trb_dynamics *d = jac->d;
  const trb_body     *body = &d->system->bodies[b];
  const int           first = body->first - trb_state_hub(d->system), rigid = trb_rigid_coordinates(body);
  respond(jac, b, y, still);
  for (int c = rigid; c < body->size; c++) {
    double *column = arrow->hub + (first + c) * arrow->room + first, change[TRB_RING_OUT];
    body->kind->slopes(body, &d->bodies[b].pose, c, column);
    trb_ring_reaction(&jac->changes[first + c], change);
    add_response(jac, body, rigid, change, column);
  }
}

/* Adds to the block of the hub, by differences of its rates but for modes. A body moves the rates of others by pairs without a roller alone, and never
 * those of bodies that other systems have. */
static void hub_block(trb_jacobian *jac, const double *y, const double *still, trb_arrow *arrow)
{
  trb_dynamics *d = jac->d;
  const int     hub = trb_state_hub(d->system);
  const int     alone = d->work->n_hub == 0;
  double       *rates = jac->rates, *base = rates + arrow->width;
  if (!alone) hub_rates(jac, y, -1, 0, 0.0, base);
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    double         *own = jac->moved + body->first;
    if (body->size == 0) continue;
    const int from = alone ? body->first - hub : 0, to = alone ? from + body->size : arrow->width;
    if (alone) hub_rates(jac, y, b, from, 0.0, base);
    if (body->modes != NULL) modal_columns(jac, b, y, still, arrow);
    for (int c = 0; c < trb_rigid_coordinates(body); c++) {
      const int    at = body->first - hub + c;
      const double was = own[c], h = trb_difference[body->coordinates[c].tolerance], per = 1.0 / h;
      own[c] = was + h;
      trb_dynamics_pose_body(d, b, own);
      hub_rates(jac, jac->moved, b, at, h, rates);
      for (int i = from; i < to; i++) arrow->hub[at * arrow->room + i] += per * (rates[i] - base[i]);
      own[c] = was;
    }
    trb_dynamics_pose_body(d, b, own);
  }
}

/* Parts of the hub in which a body's coordinates lie. */
static unsigned parts_of(const trb_dynamics *d, int body)
{
  const trb_body *is = &d->system->bodies[body];
  return trb_hub_parts(is->first - trb_state_hub(d->system), is->size);
}

static trb_ring_pose difference_of(const trb_ring_pose *to, const trb_ring_pose *from, double per)
{
  return (trb_ring_pose){trb_scale(per, trb_sub(to->axis, from->axis)), trb_scale(per, trb_sub(to->centre, from->centre)),
                         trb_scale(per, trb_sub(to->velocity, from->velocity)), trb_scale(per, trb_sub(to->omega, from->omega)),
                         per * (to->angle - from->angle)};
}

/* Of each ring with coordinates: what a wrench does to its rates, and what its coordinates do to its pose. */
static void prepare_rings(trb_jacobian *jac, const double *y, const double *still)
{
  trb_dynamics *d = jac->d;
  const int     hub = trb_state_hub(d->system);
  for (int k = 0; k < d->system->n_moving; k++) {
    const int       b = d->system->moving[k];
    const trb_body *body = &d->system->bodies[b];
    const int       first = body->first - hub;
    double         *own = jac->moved + body->first;
    respond(jac, b, y, still);
    for (int c = 0; c < TRB_WRENCH; c++)
      memcpy(jac->ring_response[k][c], jac->response + 6 * first + c * body->size, (size_t)body->size * sizeof *jac->response);
    memset(jac->ring_reactions[k], 0, sizeof jac->ring_reactions[k]);
    for (int c = 0; c < body->size; c++) {
      const double  was = own[c], h = trb_difference[body->coordinates[c].tolerance];
      trb_ring_pose moved;
      own[c] = was + h;
      body->kind->ring(d->model, body, &d->drive, own, &moved);
      own[c] = was;
      moved = difference_of(&moved, &d->bodies[b].ring, 1.0 / h);
      trb_ring_inputs(&moved, &d->drive, jac->with[first + c]);
    }
  }
}

/* Borders of a roller to the rings with coordinates, and its part of the slopes of their loads with these. */
static void fill_rings(trb_jacobian *jac, int j, trb_arrow *arrow)
{
  trb_dynamics            *d = jac->d;
  trb_arrow_border        *border = &arrow->borders[leaf_of(d, j)];
  const trb_block_kernels *kernels = trb_block_kernels_of(d->work->variant);
  for (int k = 0; k < d->system->n_moving; k++) {
    const int               b = d->system->moving[k];
    const trb_body         *body = &d->system->bodies[b];
    const int               first = body->first - trb_state_hub(d->system);
    const trb_ring_tangent *tangent = trb_tangents_ring(jac->tangents, j, k);
    const trb_ring_slopes  *slopes = trb_tangents_ring_slopes(jac->tangents, j, k);
    const trb_wrench        now = trb_ring_wrench(tangent->value);
    trb_add_wrench(&d->on_body[b], &now);
    trb_arrow_add_parts(arrow, leaf_of(d, j), parts_of(d, b));
    kernels->border_ring(slopes, (const double (*)[TRB_NP])jac->ring_response[k], (const double (*)[TRB_RING_IN])(jac->with + first),
                         body->size, arrow->room, border->from + first, border->to_hub + first * TRB_NR, jac->ring_reactions[k]);
  }
}

/* Slopes of the loads of rings with their own coordinates, which all rollers have given. */
static void react(trb_jacobian *jac)
{
  const trb_system *system = jac->d->system;
  for (int k = 0; k < system->n_moving; k++) {
    const trb_body *body = &system->bodies[system->moving[k]];
    for (int c = 0; c < body->size; c++) {
      const trb_wrench w = trb_ring_wrench(jac->ring_reactions[k][c]);
      trb_add_wrench(&jac->changes[body->first - trb_state_hub(system) + c], &w);
    }
  }
}

/* Blocks and borders of the fast pairs of a roller that touch. */
static void fill_fast(trb_jacobian *jac, int j, const double *y, const double *still, trb_arrow *arrow)
{
  trb_dynamics     *d = jac->d;
  const trb_instant at = trb_dynamics_instant(d, NULL, 0);
  trb_arrow_border *border = &arrow->borders[leaf_of(d, j)];
  border->parts = 0U;
  for (int f = 0; f < d->n_fast; f++) {
    const trb_pair *pair = d->fast[f].pair;
    trb_modal      *modal = jac->modal[pair->b];
    trb_coupling    k;
    trb_load        load;
    k.slopes.modal = modal != NULL ? &modal->slopes : NULL;
    const trb_gaps gaps = pair->kind->touch(d->model, pair, &at, j, &d->work->counters, &load, &k.slopes, NULL);
    if (trb_gaps_clear(&gaps)) continue;
    if (trb_norm(load.on_b.force) > 0.0) {
      trb_arrow_add_parts(arrow, leaf_of(d, j), parts_of(d, pair->b));
      trb_coupling_place(&k, &d->rollers[j], &d->system->bodies[pair->b], &d->bodies[pair->b].pose, &load);
      trb_add_wrench(&d->on_body[pair->b], &load.on_b);
      add_fast(jac, j, &k, pair->b, y, still, arrow);
    }
    if (modal != NULL) trb_modal_clear(modal);
  }
}

void trb_jacobian_renew(trb_jacobian *jacobian, int roller) { jacobian->renewed[jacobian->n_renewed++] = roller; }

/* Poses of the hub and of the chosen rollers. */
static void place(trb_jacobian *jac, double time, const double *y, const int *chosen, int n)
{
  memcpy(jac->moved, y, (size_t)trb_state_size(jac->d->system) * sizeof *y);
  trb_dynamics_pose_of(jac->d, time, y, chosen, n);
}

void trb_jacobian_slopes(trb_jacobian *jac, double time, const double *y, const int *chosen, int n)
{
  place(jac, time, y, chosen, n);
  trb_tangents_differentiate(jac->tangents, jac->d, chosen, n, y, jac->moved);
}

/* Takes slopes of raceways and ribs again: of all chosen rollers, or of those that were asked for. */
static void take_slopes(trb_jacobian *jac, const double *y, int fresh, const int *chosen, int n)
{
  trb_dynamics *d = jac->d;
  if (fresh || !jac->tangents->has_slopes) {
    trb_tangents_differentiate(jac->tangents, d, chosen, n, y, jac->moved);
    jac->rings_evaluations++;
  } else if (jac->n_renewed > 0) {
    trb_tangents_differentiate(jac->tangents, d, jac->renewed, jac->n_renewed, y, jac->moved);
  }
  jac->n_renewed = 0;
}

void trb_jacobian_fill(trb_jacobian *jac, double time, const double *y, int fresh, trb_arrow *arrow)
{
  trb_jacobian_fill_of(jac, time, y, fresh, jac->d->everyone, jac->d->model->n_rollers, arrow);
}

void trb_jacobian_fill_of(trb_jacobian *jac, double time, const double *y, int fresh, const int *chosen, int n, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  double          *still = jac->rates + 2 * arrow->width;
  const trb_wrench none = {{0, 0, 0}, {0, 0, 0}};
  y = trb_dynamics_held(d, time, y);
  place(jac, time, y, chosen, n);
  take_slopes(jac, y, fresh, chosen, n);
  for (int k = 0; k < n; k++)
    for (int c = 0; c < TRB_NR; c++)
      memcpy(arrow->rollers[leaf_of(d, chosen[k])].own[c], trb_tangents_column(jac->tangents, chosen[k], c), TRB_NR * sizeof(double));
  if (d->system->layout.leaf == 0) memset(arrow->hub, 0, (size_t)(arrow->width * arrow->room) * sizeof *arrow->hub);
  memset(jac->changes, 0, (size_t)arrow->width * sizeof *jac->changes);
  memset(d->on_body, 0, sizeof d->on_body);
  for (int b = 0; b < d->system->n_bodies; b++) {
    body_rates(d, b, y, &none, still);
    if (jac->modal[b] != NULL) trb_modal_start(jac->modal[b]);
  }
  prepare_rings(jac, y, still);
  for (int k = 0; k < n; k++) {
    fill_fast(jac, chosen[k], y, still, arrow);
    fill_rings(jac, chosen[k], arrow);
  }
  react(jac);
  hub_block(jac, y, still, arrow);
  for (int b = 0; b < d->system->n_bodies; b++)
    if (jac->modal[b] != NULL)
      trb_modal_finish(jac->modal[b], &d->system->bodies[b], d->system->bodies[b].first - trb_state_hub(d->system), arrow);
  trb_spacer_blocks(d, y, arrow);
}

void trb_jacobian_add(trb_jacobian *jac, double time, const double *y, int roller, trb_arrow *arrow)
{
  trb_dynamics    *d = jac->d;
  double          *still = jac->rates + 2 * arrow->width;
  const trb_wrench none = {{0, 0, 0}, {0, 0, 0}};
  place(jac, time, y, &roller, 1);
  for (int c = 0; c < TRB_NR; c++)
    memcpy(arrow->rollers[leaf_of(d, roller)].own[c], trb_tangents_column(jac->tangents, roller, c), TRB_NR * sizeof(double));
  memset(jac->changes, 0, (size_t)arrow->width * sizeof *jac->changes);
  for (int b = 0; b < d->system->n_bodies; b++) body_rates(d, b, y, &none, still);
  fill_fast(jac, roller, y, still, arrow);
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    const int       first = body->first - trb_state_hub(d->system);
    if (body->size == 0) continue;
    respond(jac, b, y, still);
    for (int c = first; c < first + body->size; c++) {
      double change[TRB_RING_OUT];
      trb_ring_reaction(&jac->changes[c], change);
      add_response(jac, body, body->size, change, arrow->hub + c * arrow->room + first);
    }
  }
}
