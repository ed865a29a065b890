/* Rollers on both raceways: gives the contacts to the kernel in groups (tiles) and adds up what it returns. */
#include <math.h>
#include <string.h>

#include "contact/kernels.h"
#include "contact/pair.h"
#include "contact/race_look.h"
#include "contact/uneven.h"
#include "laws/line_contact.h"

static const trb_race_nodes *nodes_of(const trb_pair *pair) { return pair->own; }

static inline trb_race_input race_input(const trb_model *m, const trb_instant *at, int roller, const trb_pair *pair,
                                        const trb_workspace *work)
{
  trb_race_input in = {.roller = &at->rollers[roller],
                       .ring = &trb_pair_ring(pair, at)[roller],
                       .cone = nodes_of(pair)->cone,
                       .centre = m->centre + (size_t)roller * (size_t)m->n_lanes,
                       .sphere = m->sphere + (size_t)roller * (size_t)m->n_lanes,
                       .nodes = nodes_of(pair)};
  if (work->laws != NULL && work->laws_use != TRB_LAWS_EXACT) {
    in.laws = &work->laws[roller * TRB_N_RACES + in.nodes->race];
    in.linear = work->laws_use == TRB_LAWS_FOLLOWED;
    if (!in.linear) in.laws->loaded = 0;
  }
  return in;
}

/* What a surface off its true form does to a contact. first: of its lanes in a tile. */
static void add_uneven(const trb_model *m, const trb_instant *at, int roller, int first, trb_workspace *work, trb_race_input *in)
{
  const double azimuth = at->drive->frame_angle + at->rollers[roller].angle, spin = at->spin[roller];
  if (!trb_uneven_is_near(m, in->nodes->race, roller, azimuth, in->ring->angle, spin)) return;
  trb_uneven_fill(m, in, roller, azimuth, spin, first, work->uneven);
  work->counters.uneven_contacts++;
  in->uneven = work->uneven;
  in->lane = first;
}

/* Not with laws that join the nodes of a contact, as the load of the whole contact and gaps beside it, and not with hysteresis, which is no part of what
 * rolls: slopes are then differences of the whole evaluation. */
static int has_law_slopes(const trb_model *m)
{
  return !(m->params.effects.rolling_load > 0.0 || m->params.effects.flooded_gaps > 0.0 || m->params.effects.hysteresis > 0.0);
}

void trb_law_slopes_create(const trb_model *m, trb_memory *memory, trb_workspace *work)
{
  const size_t contacts = (size_t)TRB_N_RACES * (size_t)m->n_rollers, each = (size_t)TRB_N_LAW_SLOPES * (size_t)m->n_lanes;
  if (!has_law_slopes(m)) return;
  work->laws = trb_memory_zeros(memory, contacts, sizeof *work->laws);
  double *nodes = trb_memory_zeros(memory, contacts * each, sizeof *nodes);
  for (size_t i = 0; i < contacts && !memory->lacks; i++) work->laws[i].nodes = nodes + i * each;
}

static int is_uneven(const trb_model *m, const trb_pair *pair, int roller, double azimuth, double turned, double spin)
{
  return trb_uneven_is_near(m, nodes_of(pair)->race, roller, azimuth, turned, spin);
}

static void add_output(const trb_race_output *out, const trb_pair *pair, int row, trb_loads *loads)
{
  const trb_load load = trb_load_of_output(out);
  loads->margin[row] = trb_min(loads->margin[row], fabs(out->depth));
  trb_add_load(pair, &load, loads);
}

void trb_raceway_of(const trb_model *m, const trb_instant *at, int roller, const trb_pair *pair, trb_workspace *work,
                    trb_race_output *output)
{
  trb_race_input input = race_input(m, at, roller, pair, work);
  if (at->spin != NULL) add_uneven(m, at, roller, 0, work, &input);
  trb_kernel_variants[work->variant].raceway(m, &input, 1, work->lanes, &work->counters, output);
}

/* A ring passes a roller as fast as the roller's surface turns. */
static double change_of(const trb_model *m, const trb_pair *pair, double speed)
{
  const int            race = nodes_of(pair)->race;
  const trb_form_scale scale = trb_form_scale_of(&m->form, race);
  const double         rolling = nodes_of(pair)->cone->radius / (0.5 * m->params.roller.diameter) * speed;
  return fmin(scale.race / speed, scale.roller / rolling);
}

/* A contact of a roller with a race. */
typedef struct contact {
  int             roller, row;
  const trb_pair *pair;
} contact;

/* Sums over the nodes of a contact, which are the lanes from `first` on; means are weighted by load. */
static trb_contact sum_of(const trb_model *m, const trb_lanes *l, int first)
{
  trb_contact out = {0};
  for (int k = first; k < first + m->n_nodes; k++) {
    const double q = l->load[k], mean = l->mean_speed[k];
    if (l->rolling[k] > 0.0) out.traction -= l->rolling[k] / mean * l->my[k];
    if (!(q > 0.0)) continue;
    out.load += q;
    out.pressure = trb_max(out.pressure, l->pressure[k]);
    if (m->film) {
      out.film += q * l->film[k];
      out.film_parameter += q * l->film_parameter[k];
    }
    /* sliding along rolling: the mean velocity's direction */
    const double along = l->sx[k] * l->mx[k] + l->sy[k] * l->my[k] + l->sz[k] * l->mz[k];
    out.slide_roll += q * along / (mean * mean);
    out.traction -= q * l->friction_coefficient[k] / l->sliding_speed[k] * l->sy[k];
  }
  if (out.load > 0.0) {
    out.film /= out.load;
    out.film_parameter /= out.load;
    out.slide_roll /= out.load;
  }
  return out;
}

/* All fields of a contact's nodes, which are the lanes from `first` on. place: of the contact in the detail. */
static void copy_lanes_of(const trb_model *m, const trb_lanes *lanes, int first, size_t place, trb_detail *detail)
{
  const size_t  n = (size_t)m->n_lanes, field_size = (size_t)(TRB_N_RACES * m->n_rollers) * n;
  const double *from = (const double *)lanes + first;
  for (size_t f = 0; f < TRB_N_LANE_FIELDS; f++)
    memcpy(detail->lanes + f * field_size + place * n, from + f * TRB_LANE_STRIDE, n * sizeof(double));
}

/* What is seen of a tile's loaded contacts, in the order in which the kernel packed them. */
static void fill_detail(const trb_model *m, const contact *contacts, const trb_lanes *lanes, const trb_race_output *outputs, int n,
                        trb_detail *detail)
{
  int first = 0;
  for (int c = 0; c < n; c++) {
    if (!outputs[c].loaded) continue;
    const size_t place = (size_t)nodes_of(contacts[c].pair)->race * (size_t)m->n_rollers + (size_t)contacts[c].roller;
    trb_pair_contacts(m, contacts[c].pair, detail)[contacts[c].roller] = sum_of(m, lanes, first);
    if (detail->lanes != NULL) copy_lanes_of(m, lanes, first, place, detail);
    first += m->n_lanes;
  }
}

/* The races of a roller follow each other, so that a tile has both. */
static void evaluate(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                     trb_detail *detail)
{
  enum { MOST = TRB_TILE_LANES / TRB_LANE_PAD };
  const int       total = at->n * batch->n, per_tile = m->n_lanes < TRB_TILE_FILL ? TRB_TILE_FILL / m->n_lanes : 1;
  contact         contacts[MOST];
  trb_race_input  inputs[MOST];
  trb_race_output outputs[MOST];
  for (int first = 0; first < total; first += per_tile) {
    const int n = total - first < per_tile ? total - first : per_tile;
    for (int c = 0; c < n; c++) {
      const int side = (first + c) % batch->n;
      contacts[c] = (contact){at->chosen[(first + c) / batch->n], batch->index[side], batch->pairs[side]};
      inputs[c] = race_input(m, at, contacts[c].roller, contacts[c].pair, work);
      if (at->spin != NULL) add_uneven(m, at, contacts[c].roller, c * m->n_lanes, work, &inputs[c]);
    }
    /* who looks at lanes sees zeros where a law was not asked, and not what another contact has left there */
    if (detail != NULL && detail->lanes != NULL) memset(work->lanes, 0, sizeof *work->lanes);
    trb_kernel_variants[work->variant].raceway(m, inputs, n, work->lanes, &work->counters, outputs);
    for (int c = 0; c < n; c++) add_output(&outputs[c], contacts[c].pair, contacts[c].row, &loads[contacts[c].roller]);
    if (detail != NULL) fill_detail(m, contacts, work->lanes, outputs, n, detail);
  }
}

static void arms_of(const trb_model *m, const trb_pair *pair, trb_arms *arms)
{
  const trb_cone *race = nodes_of(pair)->cone;
  const double    chain = trb_chain_length(m);
  *arms = trb_arms_on_cone(m, race, -chain, chain, fabs(race->place + m->geometry.roller_mass_offset * m->axis_cosine) + chain);
}

/* Its own parameters: trb_race_nodes. */
const trb_pair_kind trb_pair_raceway = {.name = "flank on a raceway",
                                        .shape = {TRB_SHAPE_FLANK, TRB_SHAPE_RACE},
                                        .pace = TRB_PACE_SLOW,
                                        .mechanisms = TRB_LOSES(TRB_BY_SLIDING) | TRB_LOSES(TRB_BY_ROLLING) |
                                                      TRB_LOSES(TRB_BY_ROLLING_PRESSURE) | TRB_LOSES(TRB_BY_DAMPING),
                                        .contact = TRB_CONTACT_LINE,
                                        .evaluate = evaluate,
                                        .arms = arms_of,
                                        .look = trb_races_look,
                                        .follow = trb_race_follow,
                                        .uneven = is_uneven,
                                        .change = change_of};
