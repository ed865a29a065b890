/* The kind of a roller in its pocket, and what bounds the change of its gaps. */
#include <math.h>

#include "contact/pair.h"
#include "laws/line_contact.h"

/* Bound of the distance of any vertex of one kind of faces from the origin of its pocket. */
static double pocket_size(const trb_model *m, const trb_pockets *row, int flanks)
{
  double size = 0.0;
  for (int i = 0; i < row->first_face[m->n_rollers]; i++) {
    const trb_polygon *f = &row->faces[i].surface;
    const double       origin = trb_norm(f->origin);
    if ((row->faces[i].part == TRB_PART_FLANK) != flanks) continue;
    for (int k = 0; k < f->n; k++) size = fmax(size, origin + hypot(f->outline[2 * k], f->outline[2 * k + 1]));
  }
  return size;
}

/* roller: largest distance of what may touch, from the roller's centre of mass; pocket: the same of its faces, from the pocket's origin;
 * ring: the same of either, from the place of the roller, across the bearing axis. */
static trb_arms arms_from(const trb_model *m, const trb_pockets *row, double roller, double pocket, double ring)
{
  const trb_geometry *g = &m->geometry;
  /* turn: about the roller's centre; orbit: about the bearing's or the cage's axis; lean: about the cage's centre */
  const double turn = fmax(roller, pocket), orbit = g->roller_centre_radius + ring + 4.0 * trb_bound_play(m);
  const double lean = g->roller_centre_radius + turn + fabs(row->offset) + 4.0 * trb_bound_play(m);
  return (trb_arms){.roller = {1.0, orbit, 1.0, turn, turn}, .body = {1.0, 1.0, 1.0, lean, lean, orbit}};
}

/* A gap is a distance between things that are fixed in either body: centres of spheres and the plane of the small end in the roller,
 * outlines of faces in the cage. When a body turns it changes by no more than the angle times the largest distance of any of them from
 * the axis. */
static void arms_of(const trb_model *m, const trb_pair *pair, trb_arms *arms)
{
  const trb_pockets  *row = pair->own;
  const trb_geometry *g = &m->geometry;
  const double        offset = fabs(g->roller_mass_offset), chain = trb_chain_length(m);
  const double        length = fmax(fabs(g->small_end_station), fabs(g->large_end_station)) + offset;
  const double        sphere = fabs(m->surfaces.end[TRB_END_LARGE].place);
  const double flanks = pocket_size(m, row, 1) + offset + trb_bound_play(m), ends = pocket_size(m, row, 0) + offset + trb_bound_play(m);
  arms[TRB_GAP_FLANK] = arms_from(m, row, chain, flanks, fmax(chain, flanks));
  arms[TRB_GAP_ENDS] = arms_from(m, row, fmax(length, sphere), ends, fmax(length, ends));
}

/* A gap between points of a roller and a face that moves by u and turns by r about its middle changes by no more than |u| + |r| times the
 * largest distance from the middle of any point of the face, or of the roller along the face. Where the roller's point is the distant centre of
 * a sphere, its distance from the face enters times |r| only, so a twentieth of it is enough for turns below a tenth. A tenth more of all for
 * turns that are not small. */
static void ways_of(const trb_model *m, const trb_pair *pair, const trb_modes *modes, int roller, double *ways)
{
  const trb_pockets *row = pair->own;
  const double       extent[TRB_N_GAPS] = {trb_chain_length(m), 0.05 * fabs(m->surfaces.end[TRB_END_LARGE].place)};
  for (int i = 0; i < TRB_N_GAPS * modes->n; i++) ways[i] = 0.0;
  for (int f = row->first_face[roller]; f < row->first_face[roller + 1]; f++) {
    const trb_polygon *p = &row->faces[f].surface;
    const trb_vec3     middle = modes->middle[f], aside = trb_axpy(middle, -trb_dot(middle, p->normal), p->normal);
    const int          gap = row->faces[f].part == TRB_PART_FLANK ? TRB_GAP_FLANK : TRB_GAP_ENDS;
    const double      *shape = trb_shapes_of(modes, f);
    double             reach = extent[gap] + trb_bound_play(m) + trb_norm(aside);
    for (int k = 0; k < p->n; k++) reach = fmax(reach, trb_norm(trb_sub(trb_polygon_vertex(p, k), middle)));
    for (int i = 0; i < modes->n; i++, shape += TRB_SHAPE_ROOM) {
      const double way = trb_norm(trb_v(shape[0], shape[1], shape[2])) + reach * trb_norm(trb_v(shape[3], shape[4], shape[5]));
      ways[i * TRB_N_GAPS + gap] = fmax(ways[i * TRB_N_GAPS + gap], 1.1 * way);
    }
  }
}

static int faces_of(const trb_pair *pair, int roller)
{
  const trb_pockets *row = pair->own;
  return row->first_face[roller + 1] - row->first_face[roller];
}

/* Of the flank. */
static double stiffness_of(const trb_model *m, const trb_pair *pair, double depth)
{
  return ((const trb_pockets *)pair->own)->palmgren * m->params.roller.effective_length * pow(depth, TRB_PALMGREN_EXPONENT - 1.0);
}

#define POCKET(is, film) \
  {.name = is, \
   .shape = {TRB_SHAPE_NONE, TRB_SHAPE_POCKETS}, \
   .pace = TRB_PACE_FAST, \
   .mechanisms = TRB_LOSES(TRB_BY_SLIDING) | TRB_LOSES(TRB_BY_DAMPING) | (film), \
   .evaluate = trb_contact_pocket, \
   .touch = trb_contact_pocket_of, \
   .surfaces = faces_of, \
   .arms = arms_of, \
   .ways = ways_of, \
   .stiffness = stiffness_of}

const trb_pair_kind trb_pair_pocket = POCKET("roller in a pocket", 0);
const trb_pair_kind trb_pair_pocket_with_film = POCKET("roller in a pocket with oil", TRB_LOSES(TRB_BY_FILM));
