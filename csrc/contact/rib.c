/* Roller large end on the inner ring's back-face rib: a sphere on a cone, one point of maximum interference
 * (docs/theory/contacts.md#large-end-on-the-back-face-rib). */
#include <math.h>

#include "contact/kernels.h"
#include "contact/pair.h"
#include "laws/smooth.h"

/* Height of a contact point above the inner raceway. */
static double height_of(const trb_model *m, const trb_ring_pose *ring, trb_vec3 point)
{
  const trb_cone *race = &m->surfaces.race[TRB_RACE_INNER];
  return -trb_cone_at(race, ring->axis, trb_sub(point, trb_cone_point(race, ring->centre, ring->axis))).beyond;
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

void trb_contact_rib(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                     trb_detail *detail)
{
  const int       row = batch->index[0];
  trb_race_output outputs[TRB_TILE_LANES];
  trb_kernel_variants[work->variant].rib(m, at, work->lanes, &work->counters, outputs);
  for (int k = 0; k < at->n; k++) {
    const int              j = at->chosen[k];
    const trb_race_output *out = &outputs[k];
    trb_loads             *to = &loads[j];
    if (detail != NULL) fill_detail(m, &at->rings[TRB_RING_INNER].in_frame[j], k, work->lanes, out, &detail->rib[j]);
    to->margin[row] = trb_min(to->margin[row], fabs(out->depth));
    if (!out->loaded) continue;
    const trb_load load = trb_load_of_output(out);
    trb_add_load(batch->pairs[0], &load, to);
  }
}

static int is_on(const trb_model *m) { return m->params.back_rib > 0.0; }

static trb_margin_arm margin_of(const trb_model *m)
{
  const trb_geometry *g = &m->geometry;
  const trb_sphere   *end = &m->surfaces.large_end;
  const double        arm = fabs(end->place);
  return (trb_margin_arm){.arm = arm,
                          .ring = arm + g->outer_race_radius + m->params.total_length,
                          .on_end = 1,
                          .normal_sine = fabs(m->surfaces.rib.cosine),
                          .normal_lean = fabs(sin(g->rib_normal_angle - g->roller_axis_angle)),
                          .sphere_offset = fabs(g->roller_centre_radius + end->place * m->axis_sine)};
}

/* The end's sphere turns about the roller's centre of mass: its centre moves nearly across the normal. */
static trb_hold_arms hold_of(const trb_model *m)
{
  const trb_geometry *g = &m->geometry;
  const trb_cone     *face = &m->surfaces.rib;
  const double        station = m->surfaces.large_end.place;
  const double        lean = fabs(face->cosine * m->axis_cosine + face->sine * m->axis_sine);
  return (trb_hold_arms){fabs(face->cosine),
                         fabs(face->sine),
                         lean * fabs(station),
                         fabs(station),
                         m->params.total_length + m->params.roller_diameter,
                         fabs(g->roller_centre_radius + station * m->axis_sine)};
}

static void look_at(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                    trb_detail *detail, double share, trb_contact_look *looks)
{
  trb_contact_rib(m, at, batch, work, loads, detail);
  for (int k = 0; k < at->n; k++) {
    const trb_point_detail *c = &detail->rib[at->chosen[k]];
    looks[k] = (trb_contact_look){.load = c->load,
                                  .pressure = c->pressure,
                                  .film_parameter = c->film_parameter,
                                  .way = trb_look_way(c, share),
                                  .speed = c->load > 0.0 ? trb_look_speed(m, c->mean_speed, share) : (double)INFINITY};
  }
}

static void view_of(const trb_model *m, const trb_detail *detail, int roller, trb_contact_view *view)
{
  const trb_point_detail *c = &detail->rib[roller];
  (void)m;
  *view = (trb_contact_view){.load = c->load,
                             .pressure = c->pressure,
                             .film = c->film,
                             .film_parameter = c->film_parameter,
                             .slide_roll = c->slide_roll,
                             .friction = c->friction,
                             .height = c->height,
                             .overhang = c->overhang};
}

const trb_pair trb_pair_rib = {.name = "rib",
                               .text = "roller's large end on the back-face rib",
                               .a = TRB_BODY_ROLLER,
                               .b = TRB_BODY_INNER_RING,
                               .pace = TRB_PACE_SLOW,
                               .seats = 1,
                               .is_on = is_on,
                               .evaluate = trb_contact_rib,
                               .margin = margin_of,
                               .hold = hold_of,
                               .look = look_at,
                               .view = view_of,
                               .books = {.loss = TRB_LOSES_BY_SLIDING(rib), .torque = TRB_TURNS_BY_SLIDING(rib)}};
