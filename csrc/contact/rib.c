/* Roller large end on the inner ring's back-face rib: a sphere on a cone, one point of maximum interference (physics: section 4). */
#include <math.h>

#include "contact/contact.h"
#include "contact/friction.h"
#include "laws/film.h"
#include "laws/line_contact.h"
#include "laws/viscosity.h"

/* Keeps the direction of a sphere's centre on the bearing axis finite, m. */
#define TRB_AXIS_GUARD 1e-9

static double log_viscosity_ratio(const trb_model *m, double pressure)
{
  const trb_params *p = &m->params;
  if (p->viscosity_law == TRB_VISCOSITY_DICKE)
    return trb_viscosity_dicke(pressure, p->dicke_a + p->dicke_b * p->temperature, p->dicke_c + p->dicke_d * p->temperature);
  if (p->viscosity_law == TRB_VISCOSITY_ROELANDS)
    return trb_viscosity_roelands(pressure, p->pressure_coefficient, m->log_viscosity, p->viscosity_exponent_cap);
  return trb_viscosity_barus(pressure, p->pressure_coefficient, p->viscosity_exponent_cap);
}

/* (11) hc = phi_T max((12), (13)), or (12) alone. */
static void fill_film(const trb_model *m, trb_point_detail *c, trb_counters *counters)
{
  const trb_params   *p = &m->params;
  const trb_geometry *g = &m->geometry;
  const double        log_rx = log(g->rib_rx), log_speed = log(c->mean_speed);
  const double        log_u = m->log_viscosity + log_speed - m->log_modulus - log_rx, log_w = log(c->load) - m->log_modulus - 2.0 * log_rx;
  c->film_elastic = g->rib_rx * trb_film_point_elastic(log_w, log_u, m->log_g, m->rib_film_shape);
  c->film_rigid = g->rib_rx * m->rib_film_rigid * exp(2.0 * (log_u - log_w));
  c->thermal_factor = 1.0;
  if (p->thermal > 0.0) {
    c->thermal_factor = trb_film_thermal(c->pressure / g->effective_modulus, m->log_thermal + 2.0 * log_speed, log(c->slide_roll), p->thermal_floor);
    counters->thermal_nodes++;
  }
  const double thickest = p->rib_film > 0.0 ? c->film_elastic : trb_max(c->film_elastic, c->film_rigid);
  c->film = p->starvation_factor * c->thermal_factor * thickest;
  c->film_parameter = c->film / p->roughness_rib;
  counters->film_nodes++;
}

/* (7)-(9) with the mean pressure of an ellipse and its semi-axis along rolling. */
static double film_coefficient(const trb_model *m, const trb_point_detail *c, trb_counters *counters)
{
  const trb_params *p = &m->params;
  if (p->traction == TRB_TRACTION_NONE) return 0.0;
  if (p->traction == TRB_TRACTION_COULOMB) {
    counters->coulomb_nodes++;
    return trb_coulomb_coefficient(p, c->sliding_speed);
  }
  counters->traction_nodes++;
  const double mean_pressure = TRB_POINT_MEAN_PRESSURE * c->pressure, eta = p->viscosity * exp(log_viscosity_ratio(m, mean_pressure));
  const double semi = m->geometry.rib_semi_axis_rolling * cbrt(c->load);
  const double sigma = eta * c->sliding_speed / (p->eyring_stress * c->film);
  const double d = eta * c->mean_speed / (trb_shear_modulus(mean_pressure, p->temperature, p->shear_modulus_floor) * semi);
  return p->eyring_stress * trb_traction_muraki_kimura(sigma, d) / mean_pressure;
}

static double friction_coefficient(const trb_model *m, const trb_point_detail *c, trb_counters *counters)
{
  const trb_params *p = &m->params;
  if (p->lubrication == TRB_LUBRICATION_DRY) {
    counters->coulomb_nodes++;
    return trb_coulomb_coefficient(p, c->sliding_speed);
  }
  const double film = m->film ? film_coefficient(m, c, counters) : 0.0;
  const double share = p->lubrication == TRB_LUBRICATION_BOUNDARY ? 1.0
                       : p->lubrication == TRB_LUBRICATION_MIXED  ? trb_boundary_share(c->film_parameter, p->lambda_boundary, p->lambda_full)
                                                                  : 0.0;
  if (share <= 0.0) return film;
  counters->boundary_nodes++;
  return film + share * (trb_friction_boundary(c->slide_roll, p->boundary_limit, p->boundary_slope, p->boundary_decay) - film);
}

/* Share of the ellipse's axis across rolling that lies below the rib's lower or above its upper edge. */
static double overhang(const trb_model *m, const trb_point_detail *c)
{
  const double semi = m->geometry.rib_semi_axis_across * cbrt(c->load);
  const double below = trb_clamp(m->params.rib_edge_low - (c->height - semi), 0.0, 2.0 * semi);
  const double above = trb_clamp(c->height + semi - m->params.rib_edge_high, 0.0, 2.0 * semi);
  return semi > 0.0 ? trb_min((below + above) / (2.0 * semi), 1.0) : 0.0;
}

typedef struct rib_geometry {
  double   interference; /* m */
  trb_vec3 normal;       /* from roller into rib */
  trb_vec3 point;        /* middle of the interference */
  double   height;       /* of the point above the raceway, m */
} rib_geometry;

static rib_geometry rib_deepest(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *ring)
{
  const trb_geometry *g = &m->geometry;
  const double        station = g->sphere_centre - g->apex_to_mid - g->roller_mass_offset;
  const trb_vec3      centre = trb_axpy(r->x, station, r->frame.a), from = trb_sub(centre, ring->apex);
  const double        along = trb_dot(from, ring->axis);
  const trb_vec3      across = trb_axpy(from, -along, ring->axis);
  const double        off = sqrt(trb_dot(across, across) + TRB_AXIS_GUARD * TRB_AXIS_GUARD);
  const double        sine = sin(g->rib_normal_angle), cosine = cos(g->rib_normal_angle);
  rib_geometry        deepest;
  deepest.interference = g->sphere_radius + sine * (off - g->rib_contact_radius) + cosine * (along - g->rib_contact_z);
  deepest.normal = trb_add(trb_scale(sine / off, across), trb_scale(cosine, ring->axis));
  deepest.point = trb_axpy(centre, g->sphere_radius - 0.5 * deepest.interference, deepest.normal);
  const trb_vec3 rel = trb_sub(deepest.point, ring->apex);
  const double   z = trb_dot(rel, ring->axis), radius = trb_norm(trb_axpy(rel, -z, ring->axis));
  deepest.height = radius * cos(g->cone_half_angle) - z * sin(g->cone_half_angle);
  return deepest;
}

static void rib_of_roller(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *ring, trb_counters *counters, trb_roller_load *load,
                          trb_point_detail *detail)
{
  const rib_geometry at = rib_deepest(m, r, ring);
  trb_point_detail   c = {0};
  c.interference = at.interference;
  c.height = at.height;
  counters->rib_tests++;
  if (at.interference > 0.0) {
    counters->rib_contacts++;
    const trb_vec3 arm = trb_sub(at.point, r->x), ring_arm = trb_sub(at.point, ring->centre);
    const trb_vec3 v1 = trb_add(r->v, trb_cross(r->omega, arm)), v2 = trb_add(ring->velocity, trb_cross(ring->omega, ring_arm));
    const trb_vec3 orbit = trb_v(-r->orbit_speed * at.point.y, r->orbit_speed * at.point.x, 0.0);
    const trb_touch touch = trb_touching(v1, v2, at.normal);
    const double    elastic = m->geometry.rib_stiffness * at.interference * sqrt(at.interference);
    c.load = trb_damped(m, elastic, m->params.damping_race, touch.rate);
    trb_vec3 mean = trb_sub(trb_scale(0.5, trb_add(v1, v2)), orbit);
    mean = trb_axpy(mean, -trb_dot(mean, at.normal), at.normal);
    c.mean_speed = sqrt(trb_dot(mean, mean) + m->params.speed_floor * m->params.speed_floor);
    c.sliding_speed = touch.speed;
    c.slide_roll = touch.speed / c.mean_speed;
    c.pressure = 1.5 * cbrt(trb_max(c.load, 1e-12)) / (TRB_PI * m->geometry.rib_semi_axis_rolling * m->geometry.rib_semi_axis_across);
    if (m->friction && c.load > 0.0) {
      if (m->film) fill_film(m, &c, counters);
      c.friction_coefficient = friction_coefficient(m, &c, counters);
    }
    const double   drag = c.load * c.friction_coefficient / touch.speed;
    const trb_vec3 force = trb_add(trb_scale(-c.load, at.normal), trb_scale(-drag, touch.sliding));
    const trb_vec3 torque = trb_cross(ring_arm, force);
    load->force = trb_add(load->force, force);
    load->moment = trb_add(load->moment, trb_cross(arm, force));
    load->ring_force = trb_sub(load->ring_force, force);
    load->ring_moment = trb_sub(load->ring_moment, torque);
    load->torque[TRB_TORQUE_RIB] -= trb_dot(torque, ring->axis);
    load->elastic += 0.4 * elastic * at.interference;
    load->power[TRB_POWER_RIB] += drag * trb_dot(touch.sliding, touch.sliding);
    load->power[TRB_POWER_DAMPING] += (c.load - elastic) * touch.rate;
    c.friction = c.load * c.friction_coefficient;
    c.overhang = overhang(m, &c);
  }
  if (detail != NULL) *detail = c;
}

void trb_contact_rib(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads, trb_detail *detail)
{
  for (int j = 0; j < m->n_rollers; j++)
    rib_of_roller(m, &at->rollers[j], &at->inner[j], &work->counters, &loads[j], detail != NULL ? &detail->rib[j] : NULL);
}
