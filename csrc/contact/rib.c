/* Roller large end on the inner ring's back-face rib: a sphere on a cone, one point of maximum interference
 * (docs/theory/contacts.md#large-end-on-the-back-face-rib). */
#include <math.h>

#include "contact/kernels.h"
#include "laws/smooth.h"

/* Height of a contact point above the inner raceway. */
static double height_of(const trb_model *m, const trb_ring_pose *ring, trb_vec3 point)
{
  const trb_vec3 from = trb_sub(point, ring->apex);
  const double   along = trb_dot(from, ring->axis), radius = trb_norm(trb_axpy(from, -along, ring->axis));
  return radius * cos(m->geometry.cone_half_angle) - along * sin(m->geometry.cone_half_angle);
}

/* Share of the ellipse's axis across rolling that lies below the rib's lower or above its upper edge. */
static double overhang(const trb_model *m, double load, double height)
{
  const double semi = m->geometry.rib_semi_axis_across * cbrt(load);
  const double below = trb_clamp(m->params.rib_edge_low - (height - semi), 0.0, 2.0 * semi);
  const double above = trb_clamp(height + semi - m->params.rib_edge_high, 0.0, 2.0 * semi);
  return semi > 0.0 ? trb_min((below + above) / (2.0 * semi), 1.0) : 0.0;
}

static void fill_detail(const trb_model *m, const trb_ring_pose *ring, int lane, const trb_lanes *l, const trb_race_output *out,
                        trb_point_detail *c)
{
  *c =
      (trb_point_detail){.interference = l->interference[lane], .height = height_of(m, ring, trb_v(l->px[lane], l->py[lane], l->pz[lane]))};
  if (!out->loaded) return;
  c->load = -trb_dot(out->force, trb_v(l->nx[lane], l->ny[lane], l->nz[lane]));
  c->pressure = l->pressure[lane];
  c->mean_speed = l->mean_speed[lane];
  c->sliding_speed = l->sliding_speed[lane];
  c->slide_roll = l->slide_roll[lane];
  c->friction_coefficient = l->friction_coefficient[lane];
  c->friction = c->load * c->friction_coefficient;
  c->overhang = overhang(m, c->load, c->height);
  if (!m->film) return;
  c->film_elastic = l->film_elastic[lane];
  c->film_rigid = l->film_rigid[lane];
  c->thermal_factor = l->thermal_factor[lane];
  c->film = l->film[lane];
  c->film_parameter = l->film_parameter[lane];
}

void trb_contact_rib(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads, trb_detail *detail)
{
  trb_race_output outputs[TRB_TILE_LANES];
  trb_kernel_variants[work->variant].rib(m, at, work->lanes, &work->counters, outputs);
  for (int k = 0; k < at->n; k++) {
    const int              j = at->chosen[k];
    const trb_race_output *out = &outputs[k];
    trb_roller_load       *load = &loads[j];
    if (detail != NULL) fill_detail(m, &at->inner[j], k, work->lanes, out, &detail->rib[j]);
    load->margin[TRB_MARGIN_RIB] = trb_min(load->margin[TRB_MARGIN_RIB], fabs(out->depth));
    if (!out->loaded) continue;
    load->force = trb_add(load->force, out->force);
    load->moment = trb_add(load->moment, out->moment);
    load->ring_force = trb_add(load->ring_force, out->ring_force);
    load->ring_moment = trb_add(load->ring_moment, out->ring_moment);
    load->torque[TRB_TORQUE_RIB] += out->torque_traction;
    load->elastic += out->elastic;
    load->power[TRB_POWER_RIB] += out->power_traction;
    load->power[TRB_POWER_DAMPING] += out->power_damping;
  }
}
