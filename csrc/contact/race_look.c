#include "contact/race_look.h"

#include <math.h>

#include "contact/passes.h"
#include "laws/film.h"
#include "laws/line_contact.h"

/* Power of the interference with which the largest pressure of a line goes. */
#define PRESSURE_EXPONENT (0.5 * TRB_PALMGREN_EXPONENT)
/* Largest relative changes of speed and load along slopes of a film, whose third powers are left out, and of the damping with it. */
#define MOST_CHANGE 0.08
/* Damping over elastic load beyond which a part of a contact may not be pressed at all. */
#define MOST_DAMPING 0.7
/* Ways that are tried, over the largest interference: each half of the one before. */
#define LONGEST_WAY 0.25
enum { N_WAYS = 8 };
/* Of the share by which a value may be off: what slopes may leave out, and what a contact that hardly moves may change before it follows them. */
#define SHARE_OF_SLOPES 0.4
#define SHARE_OF_REST 0.4

void trb_looks_create(const trb_model *m, trb_memory *memory, trb_workspace *work)
{
  const size_t    contacts = (size_t)TRB_N_RACES * (size_t)m->n_rollers, lanes = (size_t)m->n_lanes;
  trb_races_held *held = trb_memory_zeros(memory, 1, sizeof *held);
  trb_race_held  *of = trb_memory_zeros(memory, contacts, sizeof *of);
  double         *share = trb_memory_zeros(memory, (TRB_N_STATIONS + 1) * lanes, sizeof *share);
  double         *node = trb_memory_zeros(memory, contacts * 2 * lanes, sizeof *node);
  if (memory->lacks) return;
  *held = (trb_races_held){.node = {0, m->n_nodes / 2, m->n_nodes - 1}, .share = share, .of = of};
  for (size_t i = 0; i < contacts; i++) of[i].node = node + i * 2 * lanes;
  /* the parabola through the stations, a line through two of them, or the same everywhere */
  const int first = held->node[0], middle = held->node[1], last = held->node[2];
  for (int i = 0; i < m->n_nodes; i++) {
    for (int e = 0; e < TRB_N_STATIONS; e++) {
      double part = 1.0;
      for (int o = 0; o < TRB_N_STATIONS; o++)
        if (held->node[o] != held->node[e])
          part *= (m->station[i] - m->station[held->node[o]]) / (m->station[held->node[e]] - m->station[held->node[o]]);
      share[(size_t)e * lanes + (size_t)i] = part;
    }
    if (last > first)
      share[TRB_N_STATIONS * lanes + (size_t)i] = (m->station[i] - m->station[first]) / (m->station[last] - m->station[first]);
    /* nodes that are the same station count once */
    if (middle == first || middle == last) share[lanes + (size_t)i] = 0.0;
    if (last == first) share[2 * lanes + (size_t)i] = 0.0;
  }
  work->held = held;
}

static const trb_race_nodes *nodes_of(const trb_pair *pair) { return pair->own; }

static trb_race_held *held_of(const trb_model *m, const trb_pair *pair, int roller, const trb_workspace *work)
{
  return &work->held->of[nodes_of(pair)->race * m->n_rollers + roller];
}

/* Velocity of a point of a body, from its reference point. */
static inline trb_vec3 velocity_at(trb_vec3 velocity, trb_vec3 omega, trb_vec3 from) { return trb_add(velocity, trb_cross(omega, from)); }

/* Rate of the interference where a roller and a ring meet. apart: of the roller's centre of mass from the ring's reference point; from: of the contact
 * point from that centre of mass. */
static inline double rate_at(const trb_roller_pose *r, const trb_ring_pose *ring, trb_vec3 apart, trb_vec3 from, trb_vec3 normal)
{
  return trb_dot(trb_sub(velocity_at(r->v, r->omega, from), velocity_at(ring->velocity, ring->omega, trb_add(apart, from))), normal);
}

/* As pass_geometry of the kernel has it for all nodes; velocities at both ends, which are those in the middle to first order. */
static inline trb_race_motion motion_of(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *ring, const trb_pair *pair,
                                        int roller, const int *node)
{
  const trb_cone  race = *nodes_of(pair)->cone;
  const trb_vec3  start = trb_sub(r->x, trb_cone_point(&race, ring->centre, ring->axis)), apart = trb_sub(r->x, ring->centre);
  const double   *along = m->centre + roller * m->n_lanes, *radius = m->sphere + roller * m->n_lanes;
  const double    floor = m->params.friction.speed_floor;
  trb_race_motion motion;
  trb_vec3        normal = trb_v(0, 0, 0), from = normal;
  for (int e = 0; e < TRB_N_STATIONS; e++) {
    const trb_vec3      centre = trb_scale(along[node[e]], r->frame.a);
    const trb_cone_foot foot = trb_cone_at(&race, ring->axis, trb_add(start, centre));
    motion.depth[e] = foot.beyond;
    if (e != 1) motion.rate[e == 2] = rate_at(r, ring, apart, trb_axpy(centre, radius[node[e]], foot.normal), foot.normal);
    else normal = foot.normal, from = trb_axpy(centre, radius[node[e]], foot.normal);
  }
  if (!m->film) return motion;
  const trb_vec3 u = velocity_at(r->v, r->omega, from), g = velocity_at(ring->velocity, ring->omega, trb_add(apart, from));
  const trb_vec3 orbit = trb_v(r->orbit_speed * (r->x.y + from.y), -r->orbit_speed * (r->x.x + from.x), 0.0);
  const trb_vec3 mean = trb_add(trb_scale(0.5, trb_add(u, g)), orbit), off = trb_sub(u, g);
  const double   across = trb_dot(mean, normal), rate = trb_dot(off, normal);
  motion.speed = sqrt(trb_dot(mean, mean) - across * across + floor * floor);
  motion.slide_roll = sqrt(trb_max(trb_dot(off, off) - rate * rate, 0.0)) / motion.speed;
  return motion;
}

/* Factor of a film by heat. */
static double thermal_of(const trb_model *m, double pressure, double log_speed, double slide_roll)
{
  const double log_lt = m->log_thermal + 2.0 * log_speed;
  if (!(m->params.effects.thermal > 0.0)) return 1.0;
  if (m->params.effects.thermal == TRB_THERMAL_AIHARA) return trb_film_thermal_aihara(log_lt);
  return trb_film_thermal(pressure / m->geometry.effective_modulus, log_lt, log(fmax(slide_roll, 1e-12)), m->params.friction.thermal_floor);
}

/* How the film of a contact follows speed, load and slip. */
static void hold_film(const trb_model *m, const trb_lanes *l, const double *share_of, double share, trb_race_held *h)
{
  const double step = 0.02, log_u = log(h->motion.speed), slip = h->motion.slide_roll, by_slip = 0.01 * slip + 1e-5;
  double       elastic = 0.0, load = 0.0, film = 0.0;
  int          top = 0;
  for (int k = 0; k < m->n_nodes; k++) {
    const double q = l->load[k];
    if (!(q > 0.0)) continue;
    if (q > l->load[top]) top = k;
    load += q;
    film += q * l->film_parameter[k];
    elastic += l->film_elastic[k] > l->film_rigid[k] ? q * l->film_parameter[k] : 0.0;
  }
  const double part = elastic / film, now = log(thermal_of(m, l->pressure[top], log_u, slip));
  const double by_heat = 0.5 * (log(thermal_of(m, l->pressure[top] * exp(step), log_u, slip)) - now) / step;
  h->by_speed = part * TRB_FILM_LINE_SPEED + (1.0 - part) + (log(thermal_of(m, l->pressure[top], log_u + step, slip)) - now) / step;
  h->by_load = by_heat - part * TRB_FILM_LINE_LOAD - (1.0 - part);
  h->faster = MOST_CHANGE;
  for (int e = 0; e < TRB_N_STATIONS; e++) h->by_way[e] = 0.0;
  h->by_rate[0] = h->by_rate[1] = 0.0;
  for (int k = 0; k < m->n_nodes; k++) {
    const double q = l->load[k], d = l->interference[k];
    /* the rigid film of a node that begins to carry goes with one over its load: the mean jumps there */
    h->way = fmin(h->way, fabs(d));
    if (!(q > 0.0)) continue;
    /* of the mean, weighted by load: the node's film, and its weight */
    const int    is_elastic = l->film_elastic[k] > l->film_rigid[k];
    const double by_load = by_heat - (is_elastic ? TRB_FILM_LINE_LOAD : 1.0), of_mean = l->film_parameter[k] / h->film_parameter;
    const double change = (of_mean * (1.0 + by_load) - 1.0) * TRB_PALMGREN_EXPONENT * q / (d * load);
    for (int e = 0; e < TRB_N_STATIONS; e++) h->by_way[e] += share_of[e * m->n_lanes + k] * change;
    const double c = trb_contact_damping(m, d), weighed = (of_mean - 1.0) * c * q / (load * fmax(1.0 + c * l->approach[k], 0.1));
    const double last = share_of[TRB_N_STATIONS * m->n_lanes + k];
    h->by_rate[0] += (1.0 - last) * weighed;
    h->by_rate[1] += last * weighed;
    /* half of the way, and of the change of speed, to where the other film is the thicker one; a node that is a small part may go beyond */
    const double margin = 0.5 * fabs(log(l->film_elastic[k] / l->film_rigid[k])) + 0.25 * share * load / (q * of_mean);
    h->way = fmin(h->way, d * margin / ((1.0 - TRB_FILM_LINE_LOAD) * TRB_PALMGREN_EXPONENT));
    h->faster = fmin(h->faster, margin / (1.0 - TRB_FILM_LINE_SPEED));
  }
  h->by_slip = (log(thermal_of(m, l->pressure[top], log_u, slip + by_slip)) - now) / by_slip;
  /* beyond, the factor of heat is taken again */
  h->slip = 2.0 * by_slip;
  h->top = l->pressure[top];
  h->log_speed = log_u;
  h->heat = exp(now);
}

/* The longest way along which the load stays within a share of a straight line: what its curve adds at a node that carries, and all of the load at one that
 * begins or ends to carry. */
static double way_of(const trb_model *m, const trb_race_nodes *nodes, const trb_lanes *l, double steepest, double allowed, double deepest)
{
  const double curve = 0.5 * TRB_PALMGREN_EXPONENT * (TRB_PALMGREN_EXPONENT - 1.0);
  double       way = LONGEST_WAY * deepest;
  for (int tried = 0; tried < N_WAYS; tried++, way *= 0.5) {
    double off = 0.0;
    for (int k = 0; k < m->n_nodes; k++) {
      const double d = l->interference[k], q = l->load_per_length[k] * nodes->weight[k];
      if (d > 2.0 * way) off += 2.0 * curve * q * (way / d) * (way / d);
      else if (d > -way) off += (d > way ? 0.15 : 1.0) * steepest * nodes->weight[k] * way;
    }
    if (off <= allowed) return way;
  }
  return 0.0;
}

static void hold(const trb_model *m, const trb_race_nodes *nodes, const trb_lanes *l, const double *share_of, double share,
                 trb_race_held *h)
{
  const double fade = m->damping_fade;
  double       steepest = 0.0;
  h->elastic = h->both = 0.0;
  h->damping[0] = h->damping[1] = 0.0;
  for (int e = 0; e < TRB_N_STATIONS; e++) h->stiffness[e] = 0.0;
  for (int k = 0; k < m->n_lanes; k++) {
    const double d = l->interference[k], weight = nodes->weight[k];
    h->node[k] = h->node[m->n_lanes + k] = 0.0;
    if (!(d > 0.0 && weight > 0.0)) continue;
    const double q = l->load_per_length[k] * weight, slope = TRB_PALMGREN_EXPONENT * q / d, c = trb_contact_damping(m, d);
    /* of q c (1 + c' / c): damping fades with the interference */
    const double faded = c * (slope - q * fade / (1.0 + fade * d)), stiffness = slope + faded * l->approach[k];
    h->elastic += q;
    h->both += faded;
    steepest = fmax(steepest, slope / weight);
    for (int e = 0; e < TRB_N_STATIONS; e++) h->stiffness[e] += share_of[e * m->n_lanes + k] * stiffness;
    h->damping[0] += (1.0 - share_of[TRB_N_STATIONS * m->n_lanes + k]) * q * c;
    h->damping[1] += share_of[TRB_N_STATIONS * m->n_lanes + k] * q * c;
    h->node[k] = l->pressure[k];
    h->node[m->n_lanes + k] = 1.0 / d;
  }
  h->way = way_of(m, nodes, l, steepest, SHARE_OF_SLOPES * share * h->elastic, h->deepest);
  if (m->film) hold_film(m, l, share_of, share, h);
}

static void look_at_race(const trb_model *m, const trb_instant *at, int roller, const trb_pair *pair, trb_workspace *work, double share,
                         trb_contact *look)
{
  const trb_lanes *l = work->lanes;
  double           parameter = 0.0, slope = 0.0, damping = 0.0, slowest = INFINITY;
  trb_race_output  out;
  trb_race_held   *h = held_of(m, pair, roller, work);
  *look = (trb_contact){.way = -1.0, .speed = INFINITY};
  trb_raceway_of(m, at, roller, pair, work, &out);
  for (int k = 0; out.loaded && k < m->n_nodes; k++) {
    const double q = l->load[k];
    if (!(q > 0.0)) continue;
    look->load += q;
    look->pressure = fmax(look->pressure, l->pressure[k]);
    slope += TRB_PALMGREN_EXPONENT * q / l->interference[k];
    damping += q * trb_contact_damping(m, l->interference[k]);
    slowest = fmin(slowest, l->mean_speed[k]);
    if (m->film) parameter += q * l->film_parameter[k];
  }
  if (look->load > 0.0) {
    look->film_parameter = parameter / look->load;
    look->way = SHARE_OF_REST * share * look->load / slope;
    look->speed = trb_look_speed(m, slowest, damping / look->load, SHARE_OF_REST * share);
  }
  h->motion = motion_of(m, &at->rollers[roller], &trb_pair_ring(pair, at)[roller], pair, roller, work->held->node);
  h->deepest = out.depth;
  h->load = look->load;
  h->pressure = look->pressure;
  h->film_parameter = look->film_parameter;
  if (look->load > 0.0) hold(m, nodes_of(pair), l, work->held->share, share, h);
  else h->way = out.loaded ? 0.0 : -out.depth;
}

void trb_races_look(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                    trb_detail *detail, double share)
{
  (void)loads;
  for (int k = 0; k < at->n; k++)
    for (int i = 0; i < batch->n; i++) {
      const int roller = at->chosen[k];
      look_at_race(m, at, roller, batch->pairs[i], work, share, &trb_pair_contacts(m, batch->pairs[i], detail)[roller]);
    }
}

static inline double largest_of(double a, double b) { return trb_max(fabs(a), fabs(b)); }

/* The largest pressure of the nodes, each by its power law to the second order. */
static double pressure_of(const trb_model *m, const trb_race_held *h, const double *share_of, const double *moved)
{
  const double  a = PRESSURE_EXPONENT, b = 0.5 * a * (1.0 - a), first = moved[0], middle = moved[1], last = moved[2];
  const int     n = m->n_lanes;
  const double *pressure = h->node, *per_depth = h->node + n;
  double        largest[2] = {0.0, 0.0};
  TRB_PADDED(n);
  for (int k = 0; k < n; k++) {
    const double by = (first * share_of[k] + middle * share_of[n + k] + last * share_of[2 * n + k]) * per_depth[k];
    largest[k % 2] = trb_max(largest[k % 2], pressure[k] * (1.0 + by * (a - b * by)));
  }
  return trb_max(largest[0], largest[1]);
}

/* The film parameter into the contact; gives whether it is right. */
static int follow_film(const trb_model *m, const trb_race_held *h, const trb_race_motion *now, const double *moved, double by_load,
                       trb_contact *look)
{
  const double by_speed = (now->speed - h->motion.speed) / h->motion.speed, slip = now->slide_roll - h->motion.slide_roll;
  const double u = h->by_speed, q = h->by_load;
  if (!(fabs(by_speed) <= h->faster && fabs(by_load) <= MOST_CHANGE)) return 0;

  const double heat = fabs(slip) <= h->slip ? 1.0 + h->by_slip * slip : thermal_of(m, h->top, h->log_speed, now->slide_roll) / h->heat;
  const double way = h->by_way[0] * moved[0] + h->by_way[1] * moved[1] + h->by_way[2] * moved[2] + 0.5 * q * (q - 1.0) * by_load * by_load;
  const double rate = h->by_rate[0] * (now->rate[0] - h->motion.rate[0]) + h->by_rate[1] * (now->rate[1] - h->motion.rate[1]);

  look->film_parameter = h->film_parameter * (1.0 + u * by_speed * (1.0 + 0.5 * (u - 1.0) * by_speed)) * (1.0 + way + rate) * heat;
  return 1;
}

int trb_race_follow(const trb_model *m, const trb_instant *at, const trb_pair *pair, int roller, const trb_workspace *work, double share,
                    trb_detail *detail)
{
  const trb_race_held  *h = held_of(m, pair, roller, work);
  const trb_race_motion now = motion_of(m, &at->rollers[roller], &trb_pair_ring(pair, at)[roller], pair, roller, work->held->node);
  double                moved[TRB_N_STATIONS], by_way = 0.0, by_rate = 0.0, damping = 0.0, spring = 0.0;
  trb_contact          *look = &trb_pair_contacts(m, pair, detail)[roller];
  for (int e = 0; e < TRB_N_STATIONS; e++) moved[e] = now.depth[e] - h->motion.depth[e];
  const double way = trb_max(fabs(moved[1]), largest_of(moved[0], moved[2]));
  if (!(way <= h->way)) return 0;
  if (!(h->load > 0.0)) return way < h->way;
  for (int e = 0; e < TRB_N_STATIONS; e++) {
    by_way += h->stiffness[e] * moved[e];
    spring += h->stiffness[e];
  }
  double both = 0.0;
  if (m->contact_damping > 0.0) {
    const double rate = trb_max(largest_of(now.rate[0], now.rate[1]), largest_of(h->motion.rate[0], h->motion.rate[1]));
    for (int e = 0; e < 2; e++) {
      by_rate += h->damping[e] * (now.rate[e] - h->motion.rate[e]);
      damping += h->damping[e];
    }
    if (!(m->contact_damping * rate <= MOST_DAMPING)) return 0;
    /* the product of both changes, each the mean over the load; nodes apart from the mean are a part of it */
    both = h->both * (by_way / spring) * (by_rate / damping);
    if (!(fabs(h->both) * way * 2.0 * rate <= 4.0 * share * h->elastic)) return 0;
  }
  look->load = h->load + by_way + by_rate + both;
  look->pressure = pressure_of(m, h, work->held->share, moved);
  return !m->film || follow_film(m, h, &now, moved, by_way / h->elastic, look);
}
