/* Roller small end on the inner ring's front rib (docs/theory/contacts.md#small-end-on-the-front-rib).
 *
 * Two nearly parallel faces have no unique deepest point. The rib's face is bounded by two circles about the ring's axis; each meets the
 * roller's end plane in one point, the deepest of that circle, which moves smoothly with the pose. The circles carry half the stiffness
 * each. The force is along the roller's axis, the gradient of an energy. */
#include <math.h>

#include "contact/contact.h"
#include "contact/friction.h"

static void edge_on_end(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *ring, int edge, trb_counters *counters,
                        trb_roller_load *load, trb_point_detail *c)
{
  const trb_geometry *g = &m->geometry;
  const trb_vec3      a = r->frame.a, end = trb_axpy(r->x, g->small_end_station - g->roller_mass_offset, a);
  const trb_vec3      centre = trb_axpy(ring->apex, m->front_rib_z[edge], ring->axis);
  const trb_vec3      across = trb_axpy(a, -trb_dot(a, ring->axis), ring->axis);
  const double        lean = trb_norm(across);
  const double        d = trb_dot(trb_sub(centre, end), a) + m->front_rib_radius[edge] * lean;
  counters->front_rib_tests++;
  c->interference = edge == 0 ? d : trb_max(d, c->interference);
  load->margin[TRB_MARGIN_FRONT_RIB] = trb_min(load->margin[TRB_MARGIN_FRONT_RIB], fabs(d));
  if (!(d > 0.0)) return;
  counters->front_rib_contacts++;
  const trb_vec3  point = trb_axpy(centre, m->front_rib_radius[edge] / lean, across), arm = trb_sub(point, r->x),
                  ring_arm = trb_sub(point, ring->centre);
  const trb_vec3  normal = trb_scale(-1.0, a);
  const trb_touch touch =
      trb_touching(trb_add(r->v, trb_cross(r->omega, arm)), trb_add(ring->velocity, trb_cross(ring->omega, ring_arm)), normal);
  const double   elastic = 0.5 * m->params.end_stiffness * d * sqrt(d), q = trb_damped(m, elastic, m->params.damping_race, touch.rate);
  const double   mu = m->pocket_friction ? trb_sliding_coefficient(m, touch.speed) : 0.0, drag = q * mu / touch.speed;
  const trb_vec3 force = trb_axpy(trb_scale(-q, normal), -drag, touch.sliding), torque = trb_cross(ring_arm, force);
  load->force = trb_add(load->force, force);
  load->moment = trb_add(load->moment, trb_cross(arm, force));
  load->ring_force = trb_sub(load->ring_force, force);
  load->ring_moment = trb_sub(load->ring_moment, torque);
  load->torque[TRB_TORQUE_FRONT_RIB] -= trb_dot(torque, ring->axis);
  load->elastic += 0.4 * elastic * d;
  load->power[TRB_POWER_FRONT_RIB] += drag * trb_dot(touch.sliding, touch.sliding);
  load->power[TRB_POWER_DAMPING] += (q - elastic) * touch.rate;
  c->load += q;
  c->friction += q * mu;
  c->friction_coefficient = mu;
  c->sliding_speed = touch.speed;
}

void trb_contact_front_rib(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads, trb_detail *detail)
{
  for (int k = 0; k < at->n; k++) {
    const int        j = at->chosen[k];
    trb_point_detail c = {0};
    for (int edge = 0; edge < 2; edge++) edge_on_end(m, &at->rollers[j], &at->inner[j], edge, &work->counters, &loads[j], &c);
    if (detail != NULL) detail->front_rib[j] = c;
  }
}
