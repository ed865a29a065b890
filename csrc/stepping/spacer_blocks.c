/* Orbit angle and tangential velocity of a roller are functions of the spacer's angle and speed and of the roller's radius: what depends on
 * the former depends on the latter, so columns are added to columns. The spacer's acceleration is a sum of the rollers' own, so rows are
 * added to its row. Columns and rows of what follows become zero. */
#include "stepping/spacer_blocks.h"

#include "motion/spacer.h"

static void move_columns(trb_arrow *arrow, int leaf, const trb_spaced *is, trb_spacer_at at)
{
  trb_arrow_block  *block = &arrow->rollers[leaf];
  trb_arrow_border *border = &arrow->borders[leaf];
  double           *to_turn = border->to_hub + at.turn * TRB_NR, *to_speed = border->to_hub + at.turning * TRB_NR;
  for (int i = 0; i < TRB_NR; i++) {
    to_turn[i] += block->own[TRB_ROLLER_psi][i];
    to_speed[i] += is->radius * block->own[TRB_ROLLER_v_t][i];
    block->own[TRB_ROLLER_r][i] += is->speed * block->own[TRB_ROLLER_v_t][i];
    block->own[TRB_ROLLER_psi][i] = block->own[TRB_ROLLER_v_t][i] = 0.0;
  }
  double *from_turn = border->from + TRB_ROLLER_psi * arrow->room, *from_speed = border->from + TRB_ROLLER_v_t * arrow->room;
  for (int i = 0; i < arrow->width; i++) {
    if (!(border->parts >> i / TRB_NP & 1U)) continue;
    arrow->hub[at.turn * arrow->room + i] += from_turn[i];
    arrow->hub[at.turning * arrow->room + i] += is->radius * from_speed[i];
    border->from[TRB_ROLLER_r * arrow->room + i] += is->speed * from_speed[i];
    from_turn[i] = from_speed[i] = 0.0;
  }
}

static void move_rows(trb_arrow *arrow, int leaf, const trb_spaced *is, double v_r, trb_spacer_at at)
{
  trb_arrow_block  *block = &arrow->rollers[leaf];
  trb_arrow_border *border = &arrow->borders[leaf];
  for (int c = 0; c < TRB_NR; c++) {
    border->from[c * arrow->room + at.turning] += is->share * block->own[c][TRB_ROLLER_v_t];
    block->own[c][TRB_ROLLER_psi] = block->own[c][TRB_ROLLER_v_t] = 0.0;
  }
  border->from[TRB_ROLLER_v_r * arrow->room + at.turning] -= is->share * is->speed;
  for (int c = 0; c < arrow->width; c++) {
    double *to = border->to_hub + c * TRB_NR;
    if (!(border->parts >> c / TRB_NP & 1U)) continue;
    arrow->hub[c * arrow->room + at.turning] += is->share * to[TRB_ROLLER_v_t];
    to[TRB_ROLLER_psi] = to[TRB_ROLLER_v_t] = 0.0;
  }
  arrow->hub[at.turning * arrow->room + at.turning] -= is->share * v_r;
}

void trb_spacer_blocks(const trb_dynamics *d, const double *y, trb_arrow *arrow)
{
  const trb_system *system = d->system;
  if (system->spacer < 0) return;
  const int           hub = trb_state_hub(system);
  const trb_spacer_at where = trb_spacer_where(system), at = {.turn = where.turn - hub, .turning = where.turning - hub};
  const double        inertia = trb_spacer_inertia(system, &d->drive, y);
  const double        alone = system->bodies[system->spacer].kind->spacing(&system->bodies[system->spacer]) / inertia;
  for (int c = 0; c < arrow->width; c++) arrow->hub[c * arrow->room + at.turning] *= alone;
  for (int j = 0; j < system->model->n_rollers; j++) {
    const int        leaf = system->layout.leaf + j;
    const trb_spaced is = trb_spacer_part(system, &d->drive, j, y, inertia);
    trb_arrow_add_parts(arrow, leaf, trb_hub_parts(at.turn, 1) | trb_hub_parts(at.turning, 1));
    move_columns(arrow, leaf, &is, at);
    move_rows(arrow, leaf, &is, y[trb_state_roller(system, j) + TRB_ROLLER_v_r], at);
  }
}
