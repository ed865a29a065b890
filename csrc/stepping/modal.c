#include "stepping/modal.h"

#include <string.h>

trb_modal *trb_modal_create(trb_memory *memory, const trb_body *body, int hub_width)
{
  const size_t n = (size_t)body->modes->n, six = 6;
  trb_modal   *to = trb_memory_zeros(memory, 1, sizeof *to);
  if (to == NULL) return NULL;
  to->n = (int)n;
  to->room[0] = 4 * six * n + 2 * n * n;
  to->room[1] = (size_t)hub_width * n;
  to->rows = trb_memory_zeros(memory, to->room[0], sizeof *to->rows);
  to->pulls = trb_memory_zeros(memory, to->room[1], sizeof *to->pulls);
  if (memory->lacks) return NULL;
  to->slopes.place = (trb_wrench *)to->rows;
  to->slopes.rate = to->slopes.place + n;
  to->slopes.pull_place = (double (*)[6])(to->slopes.rate + n);
  to->slopes.pull_rate = to->slopes.pull_place + n;
  to->slopes.own_place = (double *)(to->slopes.pull_rate + n);
  to->slopes.own_rate = to->slopes.own_place + n * n;
  return to;
}

void trb_modal_start(trb_modal *modal) { memset(modal->pulls, 0, modal->room[1] * sizeof *modal->pulls); }

void trb_modal_clear(trb_modal *modal) { memset(modal->rows, 0, modal->room[0] * sizeof *modal->rows); }

/* Adds the force on each mode with a motion of the roller. */
static void pull(const trb_modal *modal, int is_place, const double along[6], double *force)
{
  const double (*columns)[6] = (const double (*)[6])(is_place ? modal->slopes.pull_place : modal->slopes.pull_rate);
  for (int i = 0; i < modal->n; i++)
    for (int c = 0; c < 6; c++) force[i] += columns[i][c] * along[c];
}

/* Of the roller's coordinates on the modes. */
static void add_from(const trb_modal *modal, const trb_coupling *k, int first, int room, double *from)
{
  for (int c = 0; c < TRB_NR; c++) {
    double along[6], force[TRB_MOST_MODES] = {0};
    trb_coupling_along(k, 0, c, along);
    pull(modal, c < TRB_ROLLER_v_r, along, force);
    k->other->kind->pushed(k->other, force, from + c * room + first);
  }
}

/* Of the body's coordinates as a rigid one on the modes. */
static void add_rigid(const trb_modal *modal, const trb_coupling *k, int first)
{
  for (int c = 0; c < trb_rigid_coordinates(k->other); c++) {
    double along[6];
    trb_coupling_along(k, 1, c, along);
    pull(modal, trb_is_place(&k->other->coordinates[c]), along, modal->pulls + (size_t)(first + c) * (size_t)modal->n);
  }
}

/* Of an amplitude, or its rate, on everything; per: of it for a unit of its coordinate. */
static void add_mode(const trb_modal *modal, const trb_dynamics *d, int roller, const trb_coupling *k, int mode, int is_place, double per,
                     int at, double *to_hub, trb_wrench *changes)
{
  const trb_load load = trb_coupling_of_mode(k, mode, is_place, per);
  const double  *own = (is_place ? modal->slopes.own_place : modal->slopes.own_rate) + (size_t)mode * (size_t)modal->n;
  double        *pulls = modal->pulls + (size_t)at * (size_t)modal->n;
  trb_roller_response(d->model, &d->rollers[roller], &load.on_a, to_hub + at * TRB_NR);
  trb_add_wrench(&changes[at], &load.on_b);
  for (int i = 0; i < modal->n; i++) pulls[i] += per * own[i];
}

void trb_modal_add(trb_modal *modal, const trb_dynamics *d, int roller, const trb_coupling *k, int first, trb_arrow *arrow,
                   trb_wrench *changes)
{
  trb_arrow_border *border = &arrow->borders[d->system->layout.leaf + roller];
  add_from(modal, k, first, arrow->room, border->from);
  add_rigid(modal, k, first);
  for (int i = 0; i < modal->n; i++) {
    double    per[2];
    const int at = first + k->other->kind->amplitude(k->other, i, per);
    add_mode(modal, d, roller, k, i, 1, per[0], at, border->to_hub, changes);
    add_mode(modal, d, roller, k, i, 0, per[1], at + 1, border->to_hub, changes);
  }
}

void trb_modal_finish(const trb_modal *modal, const trb_body *body, int first, trb_arrow *arrow)
{
  for (int c = 0; c < arrow->width; c++)
    body->kind->pushed(body, modal->pulls + (size_t)c * (size_t)modal->n, arrow->hub + c * arrow->room + first);
}
