#include "motion/clearance.h"

#include <math.h>
#include <string.h>

/* Farthest vertex of any face from its pocket's origin. */
static double pocket_size(const trb_model *m)
{
  double size = 0.0;
  for (int i = 0; i < m->first_face[m->n_rollers]; i++) {
    const trb_face *f = &m->faces[i].face;
    const double    origin = sqrt(f->origin[0] * f->origin[0] + f->origin[1] * f->origin[1] + f->origin[2] * f->origin[2]);
    for (int k = 0; k < m->faces[i].n; k++) size = fmax(size, origin + hypot(f->outline[2 * k], f->outline[2 * k + 1]));
  }
  return size;
}

/* Displacements and gaps within which the arms hold. */
static double play(const trb_model *m) { return 0.5 * m->params.roller_diameter; }

/* The gap is a distance between things fixed in either body: centres of spheres and the small end's plane here, outlines there. It changes
 * by no more than the arm of any of them about the axis of a turn. */
trb_clearance_arms trb_clearance_arms_of(const trb_model *m)
{
  const trb_geometry *g = &m->geometry;
  const double        offset = fabs(g->roller_mass_offset),
                      length = fmax(fabs(g->small_end_station), fabs(g->large_end_station)) + m->params.effective_length + offset;
  const double        sphere = fabs(g->sphere_centre - g->apex_to_mid) + offset, pocket = pocket_size(m) + offset + play(m);
  /* about the roller's centre; about the bearing's or the cage's axis; about the cage's centre */
  const double turn = fmax(fmax(length, sphere), pocket), orbit = g->roller_centre_radius + fmax(length, pocket) + 4.0 * play(m);
  const double lean = g->roller_centre_radius + turn + fabs(m->params.cage_offset) + 4.0 * play(m);
  return (trb_clearance_arms){{1.0, orbit, 1.0, turn, turn}, {1.0, 1.0, 1.0, lean, lean, orbit}};
}

void trb_clearance_set(const trb_model *m, trb_clearance *c, double gap, const double *y_roller, const double *y_cage)
{
  const double far = fabs(y_roller[TRB_ROLLER_r]) + fabs(y_roller[TRB_ROLLER_z]) + fabs(y_cage[TRB_CAGE_x]) + fabs(y_cage[TRB_CAGE_y]) +
                     fabs(y_cage[TRB_CAGE_z]);
  /* a gap that is not a number proves nothing */
  c->gap = far < play(m) && gap > 0.0 ? trb_min(gap, play(m)) : 0.0;
  memcpy(c->roller, y_roller, sizeof c->roller);
  memcpy(c->cage, y_cage, sizeof c->cage);
}

int trb_clearance_holds(const trb_clearance *c, const trb_clearance_arms *arms, const double *y_roller, const double *y_cage)
{
  double moved = 0.0;
  for (int i = 0; i < TRB_CLEARANCE_ROLLER; i++) moved += arms->roller[i] * fabs(y_roller[i] - c->roller[i]);
  for (int i = 0; i < TRB_CLEARANCE_CAGE; i++) moved += arms->cage[i] * fabs(y_cage[i] - c->cage[i]);
  /* not a number: nothing is proven */
  return moved < c->gap;
}
