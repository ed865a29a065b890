/* The end faces of the cage in the mixture of oil and air of the bearing, which rests: the torque of a disc that turns in it, less that of
 * the disc inside of the faces (docs/theory/contacts.md#drag-of-the-oil). */
#include <math.h>

#include "contact/pair.h"
#include "laws/drag.h"

static void between(const trb_model *m, const trb_pair *pair, const trb_instant *at, trb_counters *counters, trb_load *load,
                    trb_detail *detail)
{
  const trb_cage_inputs *faces = pair->own_a;
  const trb_oil_inputs  *oil = pair->own;
  const trb_rigid_pose  *cage = &at->bodies[pair->a].pose;
  const double           speed = trb_dot(cage->omega, cage->frame.a), viscosity = oil->viscosity / oil->density;
  const double           density = m->params.effects.oil_fill * oil->density;
  const double           per = trb_disc_over_speed(density, viscosity, faces->face_outer, fabs(speed)) -
                               trb_disc_over_speed(density, viscosity, faces->face_inner, fabs(speed));
  (void)detail;
  counters->drag_cages++;
  load->on_a.moment = trb_scale(-per * speed, cage->frame.a);
  load->on_b.moment = trb_scale(per * speed, cage->frame.a);
  load->lost[TRB_BY_SLIDING] += per * speed * speed;
}

const trb_pair_kind trb_pair_cage_drag = {
    .name = "drag of the cage", .shape = {TRB_SHAPE_NONE, TRB_SHAPE_NONE}, .mechanisms = TRB_LOSES(TRB_BY_SLIDING), .between = between};
