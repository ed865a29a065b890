/* A roller in the mixture of oil and air of the bearing, which rests: drag through the roller's centre of mass against its velocity
 * (docs/theory/contacts.md#drag-of-the-oil). How
 * much oil there is, is known in no bearing: the fill fraction is an input, and zero by default. */
#include <math.h>

#include "contact/pair.h"
#include "laws/drag.h"

static void evaluate(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                     trb_detail *detail)
{
  const trb_params *p = &m->params;
  const double      area = p->roller.diameter * p->roller.total_length;
  (void)detail;
  work->counters.drag_rollers += at->n * batch->n;
  for (int i = 0; i < batch->n; i++) {
    const trb_oil_inputs *oil = batch->pairs[i]->own;
    for (int k = 0; k < at->n; k++) {
      const trb_vec3 v = at->rollers[at->chosen[k]].v;
      const double   per = trb_drag_over_speed(p->effects.oil_fill, oil->density, p->effects.drag_coefficient, area, trb_norm(v));
      const trb_vec3 force = trb_scale(-per, v);
      const trb_load load = {
          .on_a = {force, {0, 0, 0}}, .on_b = {trb_scale(-1.0, force), {0, 0, 0}}, .lost = {[TRB_BY_SLIDING] = per * trb_dot(v, v)}};
      trb_add_load(batch->pairs[i], &load, &loads[at->chosen[k]]);
    }
  }
}

const trb_pair_kind trb_pair_drag = {.name = "drag",
                                     .shape = {TRB_SHAPE_NONE, TRB_SHAPE_NONE},
                                     .pace = TRB_PACE_SLOW,
                                     .mechanisms = TRB_LOSES(TRB_BY_SLIDING),
                                     .evaluate = evaluate};
