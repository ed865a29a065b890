/* Roller on raceway (docs/theory/contacts.md#raceways), several contacts (a tile) at a time: the geometry of each contact, then one loop
 * for each law over all lanes, then the sums of each contact. The loop of a law that a scene leaves out does not run; inside the loops
 * nothing branches on effects. */
#include "contact/kernels.h"

#include <float.h>
#include <math.h>

#include "contact/loaded_part.h"
#include "contact/passes.h"
#include "contact/uneven.h"
#include "laws/profile.h"
#include "laws/rolling_resistance.h"
#include "surface/sphere.h"

#define TRB_KERNEL_NAME TRB_JOIN(trb_raceway_kernel_, TRB_KERNEL_VARIANT)

/* Interference, normal, contact point and velocities of a contact's nodes, from lane `first` on; gives the largest interference. */
static double pass_geometry(const trb_race_input *in, int n, trb_lanes *l, int first)
{
  const trb_roller_pose *r = in->roller;
  const trb_ring_pose   *g = in->ring;
  const trb_cone         race = *in->cone;
  const trb_vec3         x = r->x, a = r->frame.a, v = r->v, w = r->omega, k = g->axis, b = g->centre, rv = g->velocity, rw = g->omega;
  const trb_vec3         start = trb_sub(x, trb_cone_point(&race, b, k));
  const double           orbit = r->orbit_speed;
  double                 largest = -DBL_MAX;
  TRB_PADDED(n);
  for (int i = 0; i < n; i++) {
    /* the sphere's centre, from the roller's centre of mass, against the race's cone */
    const double        rho = in->sphere[i];
    const trb_vec3      centre = trb_scale(in->centre[i], a);
    const trb_cone_foot foot = trb_cone_at(&race, k, trb_add(start, centre));
    const double d = rho + foot.beyond - in->nodes->drop[i], reach = trb_sphere_reach(rho, d), nx = foot.normal.x, ny = foot.normal.y,
                 nz = foot.normal.z;
    /* the contact point, from the roller's centre of mass and from the origin */
    const double qx = centre.x + reach * nx, qy = centre.y + reach * ny, qz = centre.z + reach * nz;
    const double px = x.x + qx, py = x.y + qy, pz = x.z + qz, tx = px - b.x, ty = py - b.y, tz = pz - b.z;
    /* velocities of both surfaces at the contact point; the contact itself orbits */
    const double ux = v.x + w.y * qz - w.z * qy, uy = v.y + w.z * qx - w.x * qz, uz = v.z + w.x * qy - w.y * qx;
    const double gx = rv.x + rw.y * tz - rw.z * ty, gy = rv.y + rw.z * tx - rw.x * tz, gz = rv.z + rw.x * ty - rw.y * tx;
    const double dx = ux - gx, dy = uy - gy, dz = uz - gz;
    const double mx = 0.5 * (ux + gx) + orbit * py, my = 0.5 * (uy + gy) - orbit * px, mz = 0.5 * (uz + gz);
    const double rate = dx * nx + dy * ny + dz * nz, mean = mx * nx + my * ny + mz * nz;
    const int    at = first + i;
    l->interference[at] = d;
    l->approach[at] = rate;
    l->reach[at] = reach;
    l->nx[at] = nx, l->ny[at] = ny, l->nz[at] = nz;
    l->px[at] = px, l->py[at] = py, l->pz[at] = pz;
    l->sx[at] = dx - rate * nx, l->sy[at] = dy - rate * ny, l->sz[at] = dz - rate * nz;
    l->mx[at] = mx - mean * nx, l->my[at] = my - mean * ny, l->mz[at] = mz - mean * nz;
    l->weight[at] = in->nodes->weight[i];
    l->radius[at] = in->nodes->radius[i];
    l->log_radius[at] = in->nodes->log_radius[i];
    l->roller_share[at] = in->nodes->roller_share[i];
    largest = trb_max(largest, d);
  }
  return largest;
}

/* What depths of surfaces off their true form leave of the interference; gives the largest. */
static double pass_uneven(const trb_race_input *in, int n, trb_lanes *l, int first)
{
  double largest = -DBL_MAX;
  for (int i = 0; i < n; i++) {
    l->interference[first + i] -= in->uneven->depth[in->lane + i];
    l->approach[first + i] -= in->uneven->rate[in->lane + i];
    largest = trb_max(largest, l->interference[first + i]);
  }
  return largest;
}

/* (1) Palmgren's load and the Hertz pressure of a line. */
static void pass_load(const trb_model *m, int n, trb_lanes *l)
{
  const double base = m->log_palmgren, modulus = m->geometry.effective_modulus;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double log_d = log(trb_max(l->interference[i], TRB_SMALLEST_INTERFERENCE));
    const double w = exp(base + TRB_PALMGREN_EXPONENT * log_d);
    l->log_d[i] = log_d;
    l->load_per_length[i] = w;
    l->load[i] = l->interference[i] > 0.0 ? w * l->weight[i] : 0.0;
    l->half_width[i] = trb_line_half_width(w, l->radius[i], modulus);
    l->pressure[i] = trb_line_pressure(w, l->radius[i], modulus);
  }
}

/* (4) and (5), before the thermal factor. */
static void pass_film(const trb_model *m, int n, trb_lanes *l)
{
  const double base_w = m->log_palmgren - m->log_modulus, base_u = m->log_viscosity - m->log_modulus, log_g = m->log_g;
  const double viscosity = m->params.oil.viscosity;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double log_w = base_w + TRB_PALMGREN_EXPONENT * l->log_d[i] - l->log_radius[i], log_u = base_u + l->log_u[i] - l->log_radius[i];
    l->film_elastic[i] = l->radius[i] * trb_film_line_elastic(log_w, log_u, log_g);
    l->film_rigid[i] = l->radius[i] * trb_film_line_rigid(viscosity * l->mean_speed[i] / l->load_per_length[i]);
    l->thermal_factor[i] = 1.0;
  }
}

/* h_PE/h_IR goes with these powers of the interference and of the mean speed. */
#define TRB_FILM_RATIO_EXPONENT ((1.0 - TRB_FILM_LINE_LOAD) * TRB_PALMGREN_EXPONENT)
#define TRB_FILM_RATIO_SPEED (TRB_FILM_LINE_SPEED - 1.0)

/* Interference from which on a contact has rolling resistance, m. The powers set in with h_PE/h_IR, the other law with the load. */
static double rolling_level(const trb_model *m, int first, const trb_lanes *l)
{
  const int law = (int)m->params.effects.rolling_resistance;
  if (law == TRB_ROLLING_BIBOULET_HOUPERT || law == TRB_ROLLING_LINE_SOLUTION || m->params.effects.rolling_load > 0.0) return 0.0;
  int deepest = first;
  for (int i = first; i < first + m->n_nodes; i++)
    if (l->interference[i] > l->interference[deepest]) deepest = i;
  const double ratio = l->film_elastic[deepest] / l->film_rigid[deepest];
  return l->interference[deepest] * pow((1.0 - m->params.friction.rolling_blend) / ratio, 1.0 / TRB_FILM_RATIO_EXPONENT);
}

/* Laws that were made for the load of a whole contact, over the length of the roller: every node gets the interference of this mean load, and
 * the lengths that carry stand for the whole length. */
static void pass_whole_load(const trb_model *m, int first, trb_lanes *l)
{
  const double length = m->params.roller.effective_length;
  double       load = 0.0, rolled = 0.0;
  for (int i = first; i < first + m->n_lanes; i++) {
    load += l->interference[i] > 0.0 ? l->load_per_length[i] * l->weight[i] : 0.0;
    rolled += l->rolled[i];
  }
  if (!(load > 0.0 && rolled > 0.0)) return;
  const double log_d = (log(load / length) - m->log_palmgren) / TRB_PALMGREN_EXPONENT, longer = length / rolled;
  for (int i = first; i < first + m->n_lanes; i++) {
    l->rolled_log_d[i] = log_d;
    l->rolled[i] *= longer;
  }
}

/* Lengths with rolling resistance, and their interference. */
static void pass_rolled(const trb_model *m, int first, trb_lanes *l)
{
  const int              is_gauss = (int)m->params.effects.quadrature == TRB_QUADRATURE_GAUSS; /* slices are those of the paper */
  const double           level = is_gauss ? rolling_level(m, first, l) : 0.0;
  const trb_contact_line line = {
      .n = m->n_nodes, .station = m->station, .cell = m->cell, .interference = l->interference + first, .level = level};
  trb_loaded_end ends[TRB_MOST_ENDS];
  for (int i = first; i < first + m->n_lanes; i++) {
    l->rolled[i] = l->interference[i] > level ? l->weight[i] : 0.0;
    l->rolled_log_d[i] = l->log_d[i];
  }
  const int n = is_gauss ? trb_loaded_part(&line, l->rolled + first, ends) : 0;
  for (int k = 0; k < n; k++) l->rolled_log_d[first + ends[k].lane] = log(trb_max(ends[k].interference, TRB_SMALLEST_INTERFERENCE));
  if (m->params.effects.rolling_load > 0.0) pass_whole_load(m, first, l);
}

/* The loop of rolling resistance once per form of law, so that the choice is made outside; share and law may use log_w, log_u and
 * `deeper`, the logarithm of the interference over that of the node. */
#define TRB_ROLLING_LOOP(share, law) \
  TRB_PADDED(n); \
  TRB_LANES for (int i = 0; i < n; i++) \
  { \
    const double log_w = base_w + TRB_PALMGREN_EXPONENT * l->rolled_log_d[i] - l->log_radius[i]; \
    const double log_u = base_u + l->log_u[i] - l->log_radius[i], deeper = l->rolled_log_d[i] - l->log_d[i]; \
    (void)deeper; \
    const double force = (share) * l->radius[i] * l->rolled[i] * l->thermal_factor[i] * scale * (law); \
    l->rolling[i] = l->rolled[i] > 0.0 ? force : 0.0; \
  }

/* Rolling resistance (docs/theory/lubrication.md#rolling-resistance) of contacts whose inlets are full of oil, times the share that the supply
 * leaves. */
static void pass_rolling(const trb_model *m, int n, trb_lanes *l)
{
  const double base_w = m->log_palmgren - m->log_modulus, base_u = m->log_viscosity - m->log_modulus, log_g = m->log_g;
  const double supply = m->params.effects.supply;
  if (m->params.effects.rolling_resistance == TRB_ROLLING_LINE_SOLUTION) {
    const double scale = supply * m->geometry.effective_modulus;
    TRB_ROLLING_LOOP(1.0, trb_rolling_line_solution(log_w, log_u, log_g))
  } else if (m->params.effects.rolling_resistance == TRB_ROLLING_BIBOULET_HOUPERT) {
    const double scale = supply * m->geometry.effective_modulus;
    TRB_ROLLING_LOOP(1.0, trb_rolling_biboulet_houpert(log_w, log_u))
  } else {
    const trb_rolling_power power = trb_rolling_power_of((int)m->params.effects.rolling_resistance);
    const double            scale = supply / m->params.oil.pressure_coefficient, factor = power.factor * exp(power.material * log_g);
    const double            band = m->params.friction.rolling_blend;
    TRB_ROLLING_LOOP(trb_rolling_share(l->film_elastic[i] / l->film_rigid[i] * exp(TRB_FILM_RATIO_EXPONENT * deeper), band),
                     (factor * trb_rolling_power_at(power, log_w, log_u, log_g)))
  }
}

/* What is left of a full inlet: a starved one makes less rolling resistance, as it makes less film (Zhou & Hoeprich 1991, eq. 23); what fast
 * rollers push aside does not flow back in time (SKF's replenishment); a meniscus before the contact takes more of it than of the film. */
static void pass_supply(const trb_model *m, int n, trb_lanes *l)
{
  const double starvation = m->params.effects.starvation_factor, decline = m->replenishment;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++) l->supplied[i] = starvation * exp(-decline * l->mean_speed[i]);
}

static void pass_meniscus(const trb_model *m, int n, trb_lanes *l)
{
  const double base_w = m->log_palmgren - m->log_modulus, base_u = m->log_viscosity - m->log_modulus, log_g = m->log_g;
  const double height = m->params.effects.oil_height;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++)
  {
    const double log_d = l->rolled_log_d[i], rigid = l->film_rigid[i] * exp(TRB_PALMGREN_EXPONENT * (l->log_d[i] - log_d));
    const double log_w = base_w + TRB_PALMGREN_EXPONENT * log_d - l->log_radius[i], log_u = base_u + l->log_u[i] - l->log_radius[i];
    const double smallest = trb_max(l->radius[i] * trb_film_line_smallest(log_w, log_u, log_g), rigid);
    l->supplied[i] *= trb_rolling_meniscus(height / smallest);
  }
}

/* Heat and supply together. */
static void pass_supplied(int n, trb_lanes *l)
{
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++) l->rolling[i] *= trb_rolling_supplied(l->supplied[i], l->thermal_factor[i]);
}

/* All of this over the lengths that roll. */
static void pass_rollings(const trb_model *m, int n, trb_lanes *l, trb_counters *counters)
{
  const int is_starved = m->params.effects.starvation_factor < 1.0 || m->replenishment > 0.0 || m->params.effects.oil_height > 0.0;
  pass_rolling(m, n, l);
  if (is_starved || m->params.effects.flooded_gaps > 0.0) pass_supply(m, n, l);
  if (m->params.effects.oil_height > 0.0) {
    pass_meniscus(m, n, l);
    counters->meniscus_nodes += n;
  }
  if (is_starved) pass_supplied(n, l);
}

/* Beside the part that carries, the gap is that of the undeformed surfaces and the film of the deepest node. A contact that begins to
 * carry gets this resistance with its interference over this film: an assumption that keeps forces continuous. */
static void pass_gaps(const trb_model *m, int first, trb_lanes *l)
{
  int deepest = first;
  for (int i = first; i < first + m->n_nodes; i++)
    if (l->interference[i] > l->interference[deepest]) deepest = i;
  const double film = l->film[deepest], depth = l->interference[deepest],
               scale = m->params.effects.supply * m->params.oil.viscosity * depth / (depth + film);
  for (int i = first; i < first + m->n_nodes; i++) {
    const double idle = trb_max(l->weight[i] - l->rolled[i], 0.0), gap = film + trb_max(-l->interference[i], 0.0);
    l->rolling[i] += scale * l->supplied[i] * l->mean_speed[i] * idle * trb_rolling_gap(l->radius[i] / gap);
  }
}

/* Where the speed is small it goes smoothly to zero with the mean velocity, as the film's force does with its direction. */
static void pass_hysteresis(const trb_model *m, int n, trb_lanes *l)
{
  const double factor = m->params.effects.hysteresis;
  TRB_PADDED(n);
  TRB_LANES for (int i = 0; i < n; i++) l->rolling[i] += l->load[i] * trb_rolling_hysteresis(factor, l->half_width[i], l->radius[i]);
}

/* F = q (1 + c d_dot), never pulling, with c of Hunt & Crossley or of a film. */
static double pass_damping(const trb_model *m, int first, int n, trb_lanes *l)
{
  double power = 0.0;
  TRB_PADDED(n);
  for (int i = first; i < first + n; i++) {
    const double damped = l->load[i] * trb_max(1.0 + trb_contact_damping(m, l->interference[i]) * l->approach[i], 0.0);
    power += (damped - l->load[i]) * l->approach[i];
    l->load[i] = damped;
  }
  return power;
}

static double sum_elastic(int first, int n, const trb_lanes *l)
{
  double sum = 0.0;
  TRB_PADDED(n);
  for (int i = first; i < first + n; i++) sum += l->load[i] * l->interference[i];
  return TRB_PALMGREN_ENERGY * sum;
}

/* Wrenches of normal load and friction on both surfaces. */
static void sum_contact(const trb_race_input *in, int first, int n, const trb_lanes *l, trb_race_output *out)
{
  const trb_vec3 x = in->roller->x, b = in->ring->centre, k = in->ring->axis;
  double         fx = 0, fy = 0, fz = 0, mx = 0, my = 0, mz = 0, hx = 0, hy = 0, hz = 0, lost = 0;
  TRB_PADDED(n);
  for (int i = first; i < first + n; i++) {
    const double q = l->load[i], drag = q * l->friction_coefficient[i] / l->sliding_speed[i];
    const double px = l->px[i], py = l->py[i], pz = l->pz[i];
    const double tx = -q * l->nx[i] - drag * l->sx[i], ty = -q * l->ny[i] - drag * l->sy[i], tz = -q * l->nz[i] - drag * l->sz[i];
    const double qx = px - x.x, qy = py - x.y, qz = pz - x.z, cx = px - b.x, cy = py - b.y, cz = pz - b.z;
    fx += tx, fy += ty, fz += tz;
    mx += qy * tz - qz * ty, my += qz * tx - qx * tz, mz += qx * ty - qy * tx;
    hx -= cy * tz - cz * ty, hy -= cz * tx - cx * tz, hz -= cx * ty - cy * tx;
    lost += drag * (l->sx[i] * l->sx[i] + l->sy[i] * l->sy[i] + l->sz[i] * l->sz[i]);
  }
  out->force = trb_v(fx, fy, fz);
  out->moment = trb_v(mx, my, mz);
  out->ring_force = trb_v(-fx, -fy, -fz);
  out->ring_moment = trb_v(hx, hy, hz);
  out->torque_traction = hx * k.x + hy * k.y + hz * k.z;
  out->power_traction = lost;
}

/* Forces along such surfaces. */
static void sum_uneven(const trb_race_input *in, int first, int n, const trb_lanes *l, trb_race_output *out)
{
  const trb_uneven *u = in->uneven;
  for (int i = 0; i < n; i++) {
    const double   q = l->load[first + i];
    const int      k = in->lane + i;
    const trb_vec3 force = trb_v(u->fx[k], u->fy[k], u->fz[k]);
    out->force = trb_axpy(out->force, q, force);
    out->moment = trb_axpy(out->moment, q, trb_v(u->mx[k], u->my[k], u->mz[k]));
    out->ring_force = trb_axpy(out->ring_force, -q, force);
    out->ring_moment = trb_axpy(out->ring_moment, q, trb_v(u->hx[k], u->hy[k], u->hz[k]));
  }
}

/* Rolling resistance drags both surfaces alike. */
static void sum_rolling(const trb_race_input *in, int first, int n, const trb_lanes *l, trb_race_output *out)
{
  const trb_vec3 x = in->roller->x, b = in->ring->centre;
  const double   orbit = in->roller->orbit_speed;
  double         ex = 0, ey = 0, ez = 0, mx = 0, my = 0, mz = 0, jx = 0, jy = 0, jz = 0, rolled = 0;
  TRB_PADDED(n);
  for (int i = first; i < first + n; i++) {
    const double roll = l->rolling[i] / l->mean_speed[i], px = l->px[i], py = l->py[i], pz = l->pz[i];
    const double rx = -roll * l->mx[i], ry = -roll * l->my[i], rz = -roll * l->mz[i];
    const double qx = px - x.x, qy = py - x.y, qz = pz - x.z, cx = px - b.x, cy = py - b.y, cz = pz - b.z;
    ex += rx, ey += ry, ez += rz;
    mx += qy * rz - qz * ry, my += qz * rx - qx * rz, mz += qx * ry - qy * rx;
    jx += cy * rz - cz * ry, jy += cz * rx - cx * rz, jz += cx * ry - cy * rx;
    /* both surfaces' inertial velocities: twice the mean, relative to the contact, plus the contact's own */
    rolled -= 2.0 * (rx * (l->mx[i] - orbit * py) + ry * (l->my[i] + orbit * px) + rz * l->mz[i]);
  }
  const trb_vec3 force = trb_v(ex, ey, ez), on_ring = trb_v(jx, jy, jz);
  out->force = trb_add(out->force, force);
  out->moment = trb_add(out->moment, trb_v(mx, my, mz));
  out->ring_force = trb_add(out->ring_force, force);
  out->ring_moment = trb_add(out->ring_moment, on_ring);
  out->torque_rolling = trb_dot(on_ring, in->ring->axis);
  out->power_rolling = rolled;
}

/* Pressure force of the rolling film: +2 F Re/R1 e through the roller's axis, +2 F Re/R2 e through the ring's, so that together with
 * the drag of both surfaces force and moment balance. */
static void sum_pressure_force(const trb_race_input *in, int first, int n, const trb_lanes *l, trb_race_output *out)
{
  const trb_roller_pose *r = in->roller;
  const trb_ring_pose   *g = in->ring;
  double                 power = 0.0;
  for (int i = first; i < first + n; i++) {
    const double   share = l->roller_share[i], scale = 2.0 * l->rolling[i] / l->mean_speed[i];
    const trb_vec3 normal = trb_v(l->nx[i], l->ny[i], l->nz[i]), point = trb_v(l->px[i], l->py[i], l->pz[i]),
                   mean = trb_v(l->mx[i], l->my[i], l->mz[i]);
    const trb_vec3 on_roller = trb_scale(scale * share, mean), on_ring = trb_scale(scale * (1.0 - share), mean);
    /* centres of curvature along the normal: R1 = Re/share inwards, R2 = Re/(1 - share) into the ring (negative: a cup) */
    const trb_vec3 from_roller = trb_sub(trb_axpy(point, -l->radius[i] / share, normal), r->x);
    const trb_vec3 from_ring = trb_sub(trb_axpy(point, l->radius[i] / (1.0 - share), normal), g->centre);
    out->force = trb_add(out->force, on_roller);
    out->moment = trb_add(out->moment, trb_cross(from_roller, on_roller));
    out->ring_force = trb_add(out->ring_force, on_ring);
    out->ring_moment = trb_add(out->ring_moment, trb_cross(from_ring, on_ring));
    power -= trb_dot(on_roller, trb_add(r->v, trb_cross(r->omega, from_roller))) +
             trb_dot(on_ring, trb_add(g->velocity, trb_cross(g->omega, from_ring)));
  }
  out->power_pressure = power;
}

static void sum_outputs(const trb_model *m, const trb_race_input *inputs, const int *loaded, int n_loaded, int rolling, trb_lanes *l,
                        trb_counters *counters, trb_race_output *outputs)
{
  const int n = m->n_lanes;
  for (int c = 0; c < n_loaded; c++) {
    const trb_race_input *in = &inputs[loaded[c]];
    trb_race_output      *out = &outputs[loaded[c]];
    out->loaded = 1;
    sum_contact(in, c * n, n, l, out);
    if (in->uneven != NULL) sum_uneven(in, c * n, n, l, out);
    if (!rolling) continue;
    sum_rolling(in, c * n, n, l, out);
    if (m->params.effects.rolling_pressure_force > 0.0) {
      sum_pressure_force(in, c * n, n, l, out);
      counters->pressure_force_nodes += n;
    }
  }
}

#include "contact/law_slopes.h"

void TRB_KERNEL_NAME(const trb_model *m, const trb_race_input *inputs, int n_inputs, trb_lanes *l, trb_counters *counters,
                     trb_race_output *outputs)
{
  int       loaded[TRB_TILE_LANES / TRB_LANE_PAD], n_loaded = 0;
  const int n = m->n_lanes, rolling = m->params.effects.rolling_resistance > 0.0 && m->film;
  for (int c = 0; c < n_inputs; c++) {
    outputs[c] = (trb_race_output){0};
    /* a contact without interference leaves its lanes to the next */
    outputs[c].depth = pass_geometry(&inputs[c], n, l, n_loaded * n);
    if (inputs[c].uneven != NULL) outputs[c].depth = pass_uneven(&inputs[c], n, l, n_loaded * n);
    if (carries(&inputs[c], outputs[c].depth)) loaded[n_loaded++] = c;
    else counters->raceway_culled++;
  }
  const int           all = n_loaded * n;
  const trb_pass_kind kind = {.mean_pressure = TRB_LINE_MEAN_PRESSURE,
                              .roughness = m->params.roughness.raceway,
                              .boundary_limit = m->params.friction.boundary_limit,
                              .asperity_factor = m->params.friction.asperity_factor,
                              .asperity_exponent = m->params.friction.asperity_exponent};
  if (all == 0) return;
  if (inputs[0].laws != NULL && inputs[0].linear) {
    follow_laws(m, inputs, loaded, n_loaded, rolling, l, outputs);
    sum_outputs(m, inputs, loaded, n_loaded, rolling, l, counters, outputs);
    return;
  }
  counters->raceway_nodes += all;
  pass_load(m, all, l);
  for (int c = 0; c < n_loaded; c++) {
    trb_race_output *out = &outputs[loaded[c]];
    out->elastic = sum_elastic(c * n, n, l);
    if (m->contact_damping > 0.0) {
      out->power_damping = pass_damping(m, c * n, n, l);
      counters->damping_nodes += n;
    }
  }
  pass_speeds(m, all, l);
  if (m->film) pass_film(m, all, l);
  pass_oil(m, &kind, all, l, counters);
  if (rolling) {
    for (int c = 0; c < n_loaded; c++) pass_rolled(m, c * n, l);
    pass_rollings(m, all, l, counters);
    if (m->params.effects.flooded_gaps > 0.0) {
      for (int c = 0; c < n_loaded; c++) pass_gaps(m, c * n, l);
      counters->gap_nodes += all;
    }
    if (m->params.effects.hysteresis > 0.0) {
      pass_hysteresis(m, all, l);
      counters->hysteresis_nodes += all;
    }
    counters->rolling_nodes += all;
  }
  sum_outputs(m, inputs, loaded, n_loaded, rolling, l, counters, outputs);
  if (inputs[0].laws != NULL) keep_laws(m, &kind, inputs, loaded, n_loaded, rolling, l, counters);
}
