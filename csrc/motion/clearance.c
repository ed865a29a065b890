#include "motion/clearance.h"

#include <math.h>
#include <string.h>

/* Bound of the distance of any vertex of one kind of faces from the origin of its pocket. */
static double pocket_size(const trb_model *m, int flanks)
{
  double size = 0.0;
  for (int i = 0; i < m->first_face[m->n_rollers]; i++) {
    const trb_face *f = &m->faces[i].face;
    const double    origin = sqrt(f->origin[0] * f->origin[0] + f->origin[1] * f->origin[1] + f->origin[2] * f->origin[2]);
    if ((m->faces[i].part == TRB_PART_FLANK) != flanks) continue;
    for (int k = 0; k < m->faces[i].n; k++) size = fmax(size, origin + hypot(f->outline[2 * k], f->outline[2 * k + 1]));
  }
  return size;
}

/* Farthest sphere of the flank from the roller's centre of mass. */
static double chain_length(const trb_model *m)
{
  double length = 0.0;
  for (int j = 0; j < m->n_rollers; j++)
    for (int k = 0; k < m->n_nodes; k++) length = fmax(length, fabs(m->centre[j * m->n_lanes + k]));
  return length;
}

/* Displacements and gaps up to which the arms are proven, m. */
static double play(const trb_model *m) { return 0.5 * m->params.roller_diameter; }

/* roller: largest distance of what may touch, from the roller's centre of mass; pocket: the same of its faces, from the pocket's origin;
 * ring: the same of either, from the place of the roller, across the bearing axis. */
static trb_clearance_arms arms_from(const trb_model *m, double roller, double pocket, double ring)
{
  const trb_geometry *g = &m->geometry;
  /* turn: about the roller's centre; orbit: about the bearing's or the cage's axis; lean: about the cage's centre */
  const double turn = fmax(roller, pocket), orbit = g->roller_centre_radius + ring + 4.0 * play(m);
  const double lean = g->roller_centre_radius + turn + fabs(m->params.cage_offset) + 4.0 * play(m);
  return (trb_clearance_arms){{1.0, orbit, 1.0, turn, turn}, {1.0, 1.0, 1.0, lean, lean, orbit}};
}

/* A gap is a distance between things that are fixed in either body: centres of spheres and the plane of the small end in the roller,
 * outlines of faces in the cage. When a body turns it changes by no more than the angle times the largest distance of any of them from
 * the axis. */
void trb_clearance_arms_of(const trb_model *m, trb_clearance_arms *arms)
{
  const trb_geometry *g = &m->geometry;
  const double        offset = fabs(g->roller_mass_offset), chain = chain_length(m);
  const double        length = fmax(fabs(g->small_end_station), fabs(g->large_end_station)) + offset;
  const double        sphere = fabs(g->sphere_centre - g->apex_to_mid) + offset;
  const double        flanks = pocket_size(m, 1) + offset + play(m), ends = pocket_size(m, 0) + offset + play(m);
  arms[TRB_GAP_FLANK] = arms_from(m, chain, flanks, fmax(chain, flanks));
  arms[TRB_GAP_ENDS] = arms_from(m, fmax(length, sphere), ends, fmax(length, ends));
}

void trb_clearance_set(const trb_model *m, trb_clearance *c, const trb_pocket_gaps *gaps, const double *y_roller, const double *y_cage)
{
  const double far = fabs(y_roller[TRB_ROLLER_r]) + fabs(y_roller[TRB_ROLLER_z]) + fabs(y_cage[TRB_CAGE_x]) + fabs(y_cage[TRB_CAGE_y]) +
                     fabs(y_cage[TRB_CAGE_z]);
  /* a gap that is not a number (NaN) proves nothing */
  for (int i = 0; i < TRB_N_GAPS; i++) c->gaps.of[i] = far < play(m) && gaps->of[i] > 0.0 ? trb_min(gaps->of[i], play(m)) : 0.0;
  memcpy(c->roller, y_roller, sizeof c->roller);
  memcpy(c->cage, y_cage, sizeof c->cage);
}

double trb_clearance_left(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage)
{
  double left[TRB_N_GAPS];
  for (int g = 0; g < TRB_N_GAPS; g++) {
    left[g] = c->gaps.of[g];
    for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) left[g] -= arms[g].roller[i] * fabs(y_roller[i] - c->roller[i]);
    for (int i = 0; i < TRB_CLEARANCE_CAGE; i++) left[g] -= arms[g].cage[i] * fabs(y_cage[i] - c->cage[i]);
  }
  return fmin(left[TRB_GAP_FLANK], left[TRB_GAP_ENDS]);
}

int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage)
{
  double moved[TRB_N_GAPS] = {0};
  if (!trb_pocket_clear(&c->gaps)) return 0;
  for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) {
    const double way = fabs(y_roller[i] - c->roller[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) moved[g] += arms[g].roller[i] * way;
  }
  for (int i = 0; i < TRB_CLEARANCE_CAGE; i++) {
    const double way = fabs(y_cage[i] - c->cage[i]);
    for (int g = 0; g < TRB_N_GAPS; g++) moved[g] += arms[g].cage[i] * way;
  }
  /* where a coordinate is not a number (NaN) both comparisons are false: nothing is proven */
  return moved[TRB_GAP_FLANK] < c->gaps.of[TRB_GAP_FLANK] && moved[TRB_GAP_ENDS] < c->gaps.of[TRB_GAP_ENDS];
}
