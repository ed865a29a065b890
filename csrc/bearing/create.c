#include "bearing/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bearing/losses.h"
#include "bearing/pockets.h"
#include "bearing/ribs.h"
#include "laws/line_contact.h"
#include "laws/profile.h"

/* Smallest half angle of a cup whose apex is near enough for coordinates that are counted from there, rad. */
#define TRB_LEAST_CONE 0.01
/* Largest drop of a profile that is given as a table, m. */
#define TRB_MOST_DROP 1e-3
/* Smallest height of a land's film over the clearance: the law of the film keeps eight digits. */
#define TRB_LEAST_CONTACT_FILM 1e-4

static trb_status check_params(const trb_params *params, trb_message *message)
{
  const double *values = (const double *)params;
  for (int i = 0; i < TRB_N_PARAMS; i++) {
    const trb_param_info *info = &trb_param_table[i];
    if (!(values[i] >= info->lower && values[i] <= info->upper))
      return trb_fail(message, TRB_ERR_INPUT, "%s = %g: must be from %g to %g %s", info->name, values[i], info->lower, info->upper,
                      info->unit);
    if ((strcmp(info->unit, "count") == 0 || strcmp(info->unit, "choice") == 0) && values[i] != floor(values[i]))
      return trb_fail(message, TRB_ERR_INPUT, "%s = %g: must be a whole number", info->name, values[i]);
  }
  if (!(params->bearing.cup_half_angle == 0.0 || params->bearing.cup_half_angle >= TRB_LEAST_CONE))
    return trb_fail(message, TRB_ERR_INPUT, "cup_half_angle = %g rad: must be 0, for cylindrical rollers, or at least %g rad",
                    params->bearing.cup_half_angle, TRB_LEAST_CONE);
  if (params->effects.rolling_resistance > 0.0 && !(params->oil.pressure_coefficient > 0.0))
    return trb_fail(message, TRB_ERR_INPUT, "pressure_coefficient = %g 1/Pa: must be > 0 for rolling resistance",
                    params->oil.pressure_coefficient);
  if (!(params->friction.lambda_full > params->friction.lambda_boundary))
    return trb_fail(message, TRB_ERR_INPUT, "lambda_full = %g: must be above lambda_boundary = %g", params->friction.lambda_full,
                    params->friction.lambda_boundary);
  if (!(params->rib.edge_high > params->rib.edge_low))
    return trb_fail(message, TRB_ERR_INPUT, "rib_edge_high = %g m: must be above rib_edge_low = %g m", params->rib.edge_high,
                    params->rib.edge_low);
  if (!(params->rib.front_high > params->rib.front_low))
    return trb_fail(message, TRB_ERR_INPUT, "front_rib_high = %g m: must be above front_rib_low = %g m", params->rib.front_high,
                    params->rib.front_low);
  if (!(params->land.contact_film >= TRB_LEAST_CONTACT_FILM * params->land.clearance &&
        params->land.contact_film <= 0.5 * params->land.clearance))
    return trb_fail(message, TRB_ERR_INPUT, "land_contact_film = %g m: must be from %g to 0.5 of land_clearance = %g m",
                    params->land.contact_film, TRB_LEAST_CONTACT_FILM, params->land.clearance);
  return TRB_OK;
}

static double profile_drop(const trb_model *m, double station)
{
  const trb_params *p = &m->params;
  if (p->roller.profile == TRB_PROFILE_CROWNED) return trb_profile_crowned(station, p->roller.crown_radius);
  if (p->roller.profile == TRB_PROFILE_LOGARITHMIC)
    return trb_profile_logarithmic(station, p->roller.effective_length, p->roller.profile_k1, p->roller.profile_k2, p->roller.profile_zm,
                                   p->roller.profile_load, m->geometry.effective_modulus);
  if (p->roller.profile == TRB_PROFILE_ISO)
    return trb_profile_iso(station, p->roller.profile_a * p->roller.diameter, p->roller.profile_c, p->roller.profile_d,
                           p->roller.profile_k);
  return 0.0;
}

/* Length of the contact line: the ISO profile drops without bound at c_p + d_p, which may lie within the effective length. */
static double line_length(const trb_params *p)
{
  return p->roller.profile == TRB_PROFILE_ISO ? fmin(p->roller.effective_length, p->roller.profile_c + p->roller.profile_d)
                                              : p->roller.effective_length;
}

/* Upper bound of n_slices in params.h. */
#define TRB_MAX_NODES 200

/* Nodes along the contact and, per roller, the chain of inscribed spheres (docs/theory/contacts.md#chain-of-spheres). */
static trb_status fill_nodes(trb_model *m, const double *drops, trb_message *message)
{
  const trb_params   *p = &m->params;
  const trb_geometry *g = &m->geometry;
  const trb_cone     *flank = &m->surfaces.flank;
  const double        nu = g->roller_half_angle, half = 0.5 * line_length(p);
  double              node[TRB_MAX_NODES], weight[TRB_MAX_NODES];
  if (m->n_nodes < 1 || m->n_nodes > TRB_MAX_NODES)
    return trb_fail(message, TRB_ERR_INPUT, "n_slices = %d: must be 1 to %d", m->n_nodes, TRB_MAX_NODES);
  trb_quadrature((int)p->effects.quadrature, m->n_nodes, node, weight);
  m->cell[0] = -half;
  for (int k = 0; k < m->n_nodes; k++) m->cell[k + 1] = m->cell[k] + half * weight[k];
  for (int k = 0; k < m->n_lanes; k++) {
    const int    used = k < m->n_nodes ? k : m->n_nodes - 1;
    const double station = half * node[used], nominal = trb_cone_radius(flank, station);
    const double middle = 0.5 * p->bearing.pitch_diameter + station * sin(g->roller_axis_angle); /* the roller's axis from the bearing's */
    m->station[k] = station;
    for (int race = 0; race < TRB_N_RACES; race++) {
      const double cosine = m->surfaces.race[race].cosine, side = race == TRB_RACE_OUTER ? 1.0 : -1.0;
      const double roller_curvature = cos(nu) / nominal, race_curvature = -cosine / (middle + side * nominal * cos(g->roller_axis_angle));
      const double radius = 1.0 / (roller_curvature + race_curvature);
      m->race[race].weight[k] = k < m->n_nodes ? half * weight[used] : 0.0;
      m->race[race].radius[k] = radius;
      m->race[race].log_radius[k] = log(radius);
      m->race[race].roller_share[k] = radius * roller_curvature;
      m->race[race].drop[k] = drops == NULL ? 0.0 : drops[(1 + race) * m->n_nodes + used];
    }
    for (int j = 0; j < m->n_rollers; j++) {
      const double radius = nominal + 0.5 * m->diameter_deviation[j] - profile_drop(m, station) - (drops == NULL ? 0.0 : drops[used]);
      if (!(radius > 0.0))
        return trb_fail(message, TRB_ERR_GEOMETRY, "roller %d: profile and diameter deviation leave no radius at station %g m", j, station);
      const trb_sphere sphere = trb_sphere_inscribed(flank, station, radius);
      m->centre[j * m->n_lanes + k] = sphere.place;
      m->sphere[j * m->n_lanes + k] = sphere.radius;
    }
  }
  return TRB_OK;
}

/* A flank without profile at both ends of the effective length; where a profile adds to the cone, as much thicker as it adds at most. */
static void fill_ends(trb_model *m, const double *drops)
{
  const trb_cone *flank = &m->surfaces.flank;
  double          added = 0.0;
  for (int k = 0; drops != NULL && k < m->n_nodes; k++) added = fmax(added, -drops[k] - profile_drop(m, m->station[k]));
  for (int j = 0; j < m->n_rollers; j++)
    for (int end = 0; end < 2; end++) {
      const double station = (end - 0.5) * m->params.roller.effective_length;
      m->end_spheres[2 * j + end] =
          trb_sphere_inscribed(flank, station, trb_cone_radius(flank, station) + 0.5 * m->diameter_deviation[j] + added);
    }
}

/* Where the front rib acts, its edges lie on the roller's small end, seen from there below the far side of its rim. */
static trb_status check_front_rib(const trb_model *m, trb_message *message)
{
  const trb_geometry *g = &m->geometry;
  const double        heights[2] = {m->params.rib.front_low, m->params.rib.front_high};
  if (m->params.effects.front_rib <= 0.0 || trb_has_cylinders(m)) return TRB_OK;
  for (int i = 0; i < 2; i++) {
    const double rim = trb_cone_radius(&m->surfaces.flank, g->small_end_station - m->params.rib.front_clearance);
    if (!(rim - heights[i] / cos(g->roller_half_angle) > -g->small_end_radius))
      return trb_fail(message, TRB_ERR_GEOMETRY, "front_rib_high = %g m: the rib would stand beyond the roller's small end (radius %g m)",
                      heights[i], g->small_end_radius);
  }
  return TRB_OK;
}

/* Strips of the cage's guiding surface: Gauss nodes along its width. */
void trb_guided_fill(const trb_model *m, const trb_land_inputs *land, const trb_cage_inputs *cage, trb_guided *to)
{
  const trb_params *p = &m->params;
  const double      modulus =
      trb_composite_modulus(cage->youngs_modulus, cage->poisson_ratio, p->bearing.youngs_modulus, p->bearing.poisson_ratio);
  to->given = *land;
  trb_quadrature(TRB_QUADRATURE_GAUSS, TRB_LAND_STRIPS, to->station, to->weight);
  for (int k = 0; k < TRB_LAND_STRIPS; k++) {
    to->station[k] *= 0.5 * land->width;
    to->weight[k] *= 0.5 * land->width;
  }
  to->place = land->offset - cage->offset;
  to->palmgren = exp(trb_line_log_load(0.0, modulus, land->width));
  to->film = m->film && land->fill > 0.0;
  to->damping = trb_damping_of_cage(m);
  to->mass = cage->mass;
}

static void fill_land(trb_model *m)
{
  m->guide[TRB_RACE_OUTER] = (trb_guide){m->params.land.outer_radius, 1};
  m->guide[TRB_RACE_INNER] = (trb_guide){m->params.land.inner_radius, 0};
  trb_guided_fill(m, &m->params.land, &m->params.cage, &m->guided);
}

static void fill_constants(trb_model *m)
{
  const trb_params   *p = &m->params;
  const trb_geometry *g = &m->geometry;
  m->log_modulus = log(g->effective_modulus);
  m->log_palmgren = trb_line_log_load(0.0, g->effective_modulus, p->roller.effective_length);
  m->axis_sine = sin(g->roller_axis_angle);
  m->axis_cosine = cos(g->roller_axis_angle);
  m->log_g = log(trb_max(p->oil.pressure_coefficient, 1e-30) * g->effective_modulus);
  m->log_viscosity = log(p->oil.viscosity);
  /* mean speed of the surfaces in pure rolling for a unit of the rings' relative speed */
  m->replenishment = p->effects.replenishment / (g->outer_race_radius * g->cage_speed_ratio);
  m->log_thermal = log(p->oil.viscosity * trb_max(p->oil.temperature_coefficient, 1e-30) / p->oil.conductivity);
  const int dry = p->effects.lubrication == TRB_LUBRICATION_DRY, full = p->effects.lubrication == TRB_LUBRICATION_FULL;
  m->friction = !(dry && p->friction.dry_friction <= 0.0) && !(full && p->effects.traction == TRB_TRACTION_NONE);
  m->pocket_friction = dry ? p->friction.dry_friction > 0.0 : !(full && p->effects.traction == TRB_TRACTION_NONE);
  m->film = !dry && (p->effects.lubrication != TRB_LUBRICATION_BOUNDARY) && (m->friction || p->effects.rolling_resistance > 0.0);
  m->contact_damping = p->effects.damping == TRB_DAMPING_FILM ? p->effects.film_damping / p->effects.film_damping_depth
                       : p->effects.damping > 0.0             ? p->effects.damping_race
                                                              : 0.0;
  m->damping_fade = p->effects.damping == TRB_DAMPING_FILM ? 1.0 / p->effects.film_damping_depth : 0.0;
}

/* Up to the last one whose effect is on. */
static int losses_of(const trb_params *p)
{
  int last = 0;
#define LAST_ON(X, name, sense, is_on, text) \
  if (is_on) last = TRB_LOSS_##name;
  TRB_LOSSES(LAST_ON, 0)
#undef LAST_ON
  return last + 1;
}

static double *doubles(trb_model *m, size_t count) { return trb_memory_zeros(&m->memory, count, sizeof(double)); }

static void allocate(trb_model *m)
{
  const size_t lanes = (size_t)m->n_lanes, rollers = (size_t)m->n_rollers;
  m->diameter_deviation = doubles(m, rollers);
  m->station = doubles(m, lanes);
  m->cell = doubles(m, lanes + 1);
  m->centre = doubles(m, lanes * rollers);
  m->sphere = doubles(m, lanes * rollers);
  m->end_spheres = trb_memory_zeros(&m->memory, 2 * rollers, sizeof *m->end_spheres);
  m->nominal_angle = trb_memory_zeros(&m->memory, rollers, sizeof *m->nominal_angle);
  for (int race = 0; race < TRB_N_RACES; race++) {
    m->race[race].race = race;
    m->race[race].cone = &m->surfaces.race[race];
    m->race[race].weight = doubles(m, lanes);
    m->race[race].log_radius = doubles(m, lanes);
    m->race[race].radius = doubles(m, lanes);
    m->race[race].roller_share = doubles(m, lanes);
    m->race[race].drop = doubles(m, lanes);
  }
}

static void place_rollers(trb_model *m)
{
  for (int j = 0; j < m->n_rollers; j++) {
    const double angle = 2.0 * TRB_PI * j / m->n_rollers;
    m->nominal_angle[j] = (trb_angle){cos(angle), sin(angle)};
  }
}

static trb_status check_ring(const trb_params *p, trb_message *message)
{
  const double values[] = {p->inner_ring.mass, p->inner_ring.inertia_axial, p->inner_ring.inertia_transverse,
                           p->outer_ring.mass, p->outer_ring.inertia_axial, p->outer_ring.inertia_transverse};
  const char  *names[] = {"ring_mass",  "ring_inertia_axial",  "ring_inertia_transverse",
                          "outer_mass", "outer_inertia_axial", "outer_inertia_transverse"};
  for (int i = 0; i < 6; i++)
    if ((i < 3 ? p->inner_ring.free : p->outer_ring.free) > 0.0 && !(values[i] > 0.0))
      return trb_fail(message, TRB_ERR_INPUT, "%s = %g: must be above 0 for a free ring", names[i], values[i]);
  if (p->inner_ring.carried > 0.0 && !(p->inner_ring.free > 0.0))
    return trb_fail(message, TRB_ERR_INPUT, "ring_carried = %g: only a free ring can be part of a shaft", p->inner_ring.carried);
  if (p->inner_ring.turned > 0.0 && !(p->inner_ring.carried > 0.0))
    return trb_fail(message, TRB_ERR_INPUT,
                    "ring_turned = %g: only a ring that is carried can be turned: the first bearing has the shaft's axes",
                    p->inner_ring.turned);
  if (p->outer_ring.carried > 0.0 && !(p->outer_ring.free > 0.0))
    return trb_fail(message, TRB_ERR_INPUT, "outer_carried = %g: only an outer ring that moves can be part of a housing",
                    p->outer_ring.carried);
  if (p->outer_ring.turned > 0.0 && !(p->outer_ring.carried > 0.0))
    return trb_fail(message, TRB_ERR_INPUT,
                    "outer_turned = %g: only a ring that is carried can be turned: the first bearing has the housing's axes",
                    p->outer_ring.turned);
  return TRB_OK;
}

/* What goes together with an elastic cage. */
static trb_status check_elastic(const trb_params *p, trb_message *message)
{
  if (p->cage.n_modes <= 0.0) return TRB_OK;
  if (p->effects.with_cage != 1.0 || p->effects.planar > 0.0 || p->effects.guidance != TRB_GUIDANCE_ROLLERS)
    return trb_fail(message, TRB_ERR_INPUT, "cage_modes = %g: must be 0 without a cage, in planar motion, and where a land guides the cage",
                    p->cage.n_modes);
  return TRB_OK;
}

static void make_rings(trb_model *m)
{
  const trb_params *p = &m->params;
  const double      plane = m->geometry.centre_plane;
  m->ring[TRB_RACE_INNER] = (trb_ring_body){.mass = p->inner_ring.mass,
                                            .inertia_axial = p->inner_ring.inertia_axial,
                                            .inertia_transverse = p->inner_ring.inertia_transverse,
                                            .reference = plane,
                                            .offset = p->inner_ring.offset,
                                            .unbalance = p->inner_ring.unbalance,
                                            .unbalance_angle = p->inner_ring.unbalance_angle,
                                            .damping = p->inner_ring.damping,
                                            .damping_turns = p->inner_ring.damping_turns,
                                            .support_radial = p->inner_ring.support_radial,
                                            .support_axial = p->inner_ring.support_axial,
                                            .support_tilt = p->inner_ring.support_tilt,
                                            .support_position = p->inner_ring.support_position,
                                            .shift = p->inner_ring.shift,
                                            .sense = p->inner_ring.turned > 0.0 ? -1.0 : 1.0,
                                            .keeps_speed = p->inner_ring.free < 2.0};
  m->ring[TRB_RACE_OUTER] = (trb_ring_body){.mass = p->outer_ring.mass,
                                            .inertia_axial = p->outer_ring.inertia_axial,
                                            .inertia_transverse = p->outer_ring.inertia_transverse,
                                            .offset = plane + p->outer_ring.offset,
                                            .damping = p->outer_ring.damping,
                                            .damping_turns = p->outer_ring.damping_turns,
                                            .support_radial = p->outer_ring.support_radial,
                                            .support_axial = p->outer_ring.support_axial,
                                            .support_tilt = p->outer_ring.support_tilt,
                                            .support_position = plane + p->outer_ring.support_position,
                                            .sense = p->outer_ring.turned > 0.0 ? -1.0 : 1.0,
                                            .keeps_speed = 1,
                                            .is_outer = 1};
}

static trb_status fill(trb_model *m, const double *deviation, const trb_face *faces, int n_faces, trb_message *message)
{
  trb_status status = trb_geometry_derive(&m->params, &m->geometry, message);
  if (status == TRB_OK) status = check_ring(&m->params, message);
  if (status == TRB_OK) status = check_elastic(&m->params, message);
  if (status != TRB_OK) return status;
  make_rings(m);
  trb_surfaces_build(&m->params, &m->geometry, &m->surfaces);
  if ((status = check_front_rib(m, message)) != TRB_OK) return status;
  m->n_rollers = (int)m->params.bearing.n_rollers;
  m->n_slots = 1;
  m->n_nodes = (int)m->params.effects.n_slices;
  m->n_lanes = (m->n_nodes + TRB_LANE_PAD - 1) / TRB_LANE_PAD * TRB_LANE_PAD;
  allocate(m);
  if (m->memory.lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for %d rollers of %d nodes", m->n_rollers, m->n_nodes);
  for (int j = 0; j < m->n_rollers; j++) {
    if (!(fabs(deviation[j]) < 0.1 * m->params.roller.diameter))
      return trb_fail(message, TRB_ERR_INPUT, "diameter deviation of roller %d = %g m: must be within a tenth of the diameter", j,
                      deviation[j]);
    m->diameter_deviation[j] = deviation[j];
  }
  if ((status = fill_nodes(m, NULL, message)) != TRB_OK) return status;
  if ((status = trb_pockets_fill(m, &m->params.pocket, &m->params.cage, faces, n_faces, &m->pockets, message)) != TRB_OK) return status;
  m->n_losses = losses_of(&m->params);
  fill_ends(m, NULL);
  fill_constants(m);
  fill_land(m);
  place_rollers(m);
  return trb_ribs_fill(m, message);
}

trb_status trb_model_create(const trb_params *params, const double *deviation, int n_deviations, const trb_face *faces, int n_faces,
                            trb_model **model, trb_message *message)
{
  *model = NULL;
  trb_status status = check_params(params, message);
  if (status != TRB_OK) return status;
  if (n_deviations != (int)params->bearing.n_rollers)
    return trb_fail(message, TRB_ERR_INPUT, "diameter deviation: %d values given, n_rollers = %g needed", n_deviations,
                    params->bearing.n_rollers);
  trb_model *m = calloc(1, sizeof *m);
  if (m == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a model");
  m->params = *params;
  status = fill(m, deviation, faces, n_faces, message);
  if (status != TRB_OK) {
    trb_model_free(m);
    return status;
  }
  *model = m;
  return TRB_OK;
}

trb_status trb_model_set_drops(trb_model *m, const double *rows, int n_rows, int n_columns, trb_message *message)
{
  if (n_rows == 0) return TRB_OK;
  if (n_rows != 1 + TRB_N_RACES || n_columns != m->n_nodes)
    return trb_fail(message, TRB_ERR_INPUT, "drops: %d rows of %d values needed, %d of %d given", 1 + TRB_N_RACES, m->n_nodes, n_rows,
                    n_columns);
  for (int i = 0; i < n_rows * n_columns; i++)
    if (!(rows[i] >= -TRB_MOST_DROP && rows[i] <= TRB_MOST_DROP))
      return trb_fail(message, TRB_ERR_INPUT, "drops, row %d: %g m: must be from %g to %g m", i / n_columns, rows[i], -TRB_MOST_DROP,
                      TRB_MOST_DROP);
  fill_ends(m, rows);
  return fill_nodes(m, rows, message);
}

trb_status trb_model_set_modes(trb_model *m, const double *rows, int n_modes, int n_columns, trb_message *message)
{
  trb_modes *to = &m->modes;
  if (n_modes != (int)m->params.cage.n_modes)
    return trb_fail(message, TRB_ERR_INPUT, "cage_modes = %g: %d modes are given", m->params.cage.n_modes, n_modes);
  if (n_modes <= 0) return TRB_OK;
  const trb_status status =
      trb_modes_read(to, &m->memory, m->n_rollers * m->n_slots, m->pockets.first_face[m->n_rollers], rows, n_modes, n_columns, message);
  if (status != TRB_OK) return status;
  for (int j = 0, leader = 0; j < m->n_rollers; j++)
    for (int f = m->pockets.first_face[j]; f < m->pockets.first_face[j + 1]; f++) {
      if (m->pockets.faces[f].n_facets > 0) leader = f;
      const int at = TRB_MODE_shapes + TRB_SHAPE * (j * m->n_slots + m->pockets.faces[f].slot);
      double   *shapes = to->shapes + (size_t)f * (size_t)n_modes * TRB_SHAPE_ROOM;
      to->middle[f] = m->pockets.faces[leader].middle; /* a surface moves as one */
      for (int i = 0; i < n_modes; i++)
        memcpy(shapes + (size_t)i * TRB_SHAPE_ROOM, rows + (size_t)i * (size_t)n_columns + at, TRB_SHAPE * sizeof *shapes);
    }
  return TRB_OK;
}

trb_status trb_model_set_form(trb_model *m, const double *rows, int n_rows, int n_columns, trb_message *message)
{
  return trb_form_read(&m->form, &m->memory, m->n_rollers, m->n_nodes, rows, n_rows, n_columns, message);
}

void trb_model_free(trb_model *model)
{
  if (model == NULL) return;
  trb_memory_free(&model->memory);
  free(model);
}

double trb_chain_length(const trb_model *m)
{
  double length = 0.0;
  for (int j = 0; j < m->n_rollers; j++)
    for (int k = 0; k < m->n_nodes; k++) length = fmax(length, fabs(m->centre[j * m->n_lanes + k]));
  return length;
}
