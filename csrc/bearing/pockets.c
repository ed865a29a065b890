#include "bearing/pockets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "laws/line_contact.h"

static trb_status check_face(const trb_face *f, int index, int n_rollers, trb_message *message)
{
  const double *row = (const double *)f;
  for (int i = 0; i < TRB_N_FACE_COLUMNS; i++)
    if (!isfinite(row[i])) return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: column %d is not finite", index, i);
  const trb_vec3 u = trb_v(f->u[0], f->u[1], f->u[2]), v = trb_v(f->v[0], f->v[1], f->v[2]);
  if (fabs(trb_dot(u, u) - 1.0) > 1e-9 || fabs(trb_dot(v, v) - 1.0) > 1e-9 || fabs(trb_dot(u, v)) > 1e-9)
    return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: u and v must be unit vectors at right angles", index);
  if (f->pocket[0] != floor(f->pocket[0]) || f->pocket[0] < -1 || f->pocket[0] >= n_rollers)
    return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: pocket = %g: must be -1 (all) or 0 to %d", index, f->pocket[0], n_rollers - 1);
  if (f->part[0] != 0.0 && f->part[0] != 1.0 && f->part[0] != 2.0)
    return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: part = %g: must be 0 (flank), 1 (large end) or 2 (small end)", index,
                    f->part[0]);
  if (f->slot[0] != floor(f->slot[0]) || f->slot[0] < 0 || f->slot[0] >= TRB_MOST_SLOTS)
    return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: slot = %g: must be a whole number from 0 to %d", index, f->slot[0],
                    TRB_MOST_SLOTS - 1);
  if (!(f->stiffness_factor[0] > 0.0) || !(f->friction_factor[0] >= 0.0))
    return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: stiffness_factor = %g must be > 0, friction_factor = %g must be >= 0", index,
                    f->stiffness_factor[0], f->friction_factor[0]);
  if (f->n_vertices[0] != floor(f->n_vertices[0]) || f->n_vertices[0] < 3 || f->n_vertices[0] > TRB_MAX_VERTICES)
    return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: n_vertices = %g: must be 3 to %d", index, f->n_vertices[0], TRB_MAX_VERTICES);
  /* the nearest point is unique, and its distance differentiable, only for convex outlines */
  const int n = (int)f->n_vertices[0];
  double    turned = 0.0;
  for (int i = 0; i < n; i++) {
    const double *p = f->outline + 2 * i, *q = f->outline + 2 * ((i + 1) % n), *r = f->outline + 2 * ((i + 2) % n);
    const double  ax = q[0] - p[0], ay = q[1] - p[1], bx = r[0] - q[0], by = r[1] - q[1], cross = ax * by - ay * bx;
    if (!(cross > 0.0))
      return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: the outline must be convex and counter-clockwise (vertex %d)", index,
                      (i + 1) % n);
    turned += atan2(cross, ax * bx + ay * by);
  }
  if (fabs(turned - 2.0 * TRB_PI) > 1e-6) return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: the outline crosses itself", index);
  return TRB_OK;
}

static int face_in_pocket(const trb_face *f, int pocket) { return f->pocket[0] < 0.0 || (int)f->pocket[0] == pocket; }

/* Faces that the scene's effects leave out are not in the model, so no loop sees them. */
static int face_is_on(const trb_model *m, const trb_pockets *to, const trb_face *f)
{
  return trb_has_cage(m) && (f->part[0] == TRB_PART_FLANK ? to->given.bars > 0.0 : to->given.ends > 0.0);
}

static void measure(trb_pocket_face *f)
{
  const trb_polygon *p = &f->surface;
  f->middle = trb_polygon_middle(p);
  f->extent = 0.0;
  for (int i = 0; i < p->n; i++) f->extent = fmax(f->extent, trb_norm(trb_sub(trb_polygon_vertex(p, i), f->middle)));
}

static trb_polygon surface_of(const trb_face *f)
{
  trb_polygon p = {.origin = trb_v(f->origin[0], f->origin[1], f->origin[2]),
                   .u = trb_v(f->u[0], f->u[1], f->u[2]),
                   .v = trb_v(f->v[0], f->v[1], f->v[2]),
                   .n = (int)f->n_vertices[0]};
  p.normal = trb_cross(p.u, p.v);
  memcpy(p.outline, f->outline, sizeof p.outline);
  return p;
}

static int has_slot(const trb_pockets *to, int first, int end, int slot)
{
  for (int i = first; i < end; i++)
    if (to->faces[i].slot == slot) return 1;
  return 0;
}

/* Puts the planes of a surface side by side. */
static void fill_planes(const trb_pocket_face *first, trb_planes *planes)
{
  for (int group = 0; group * TRB_PLANES_TOGETHER < first->n_facets; group++)
    for (int i = 0; i < TRB_PLANES_TOGETHER; i++) {
      const int          number = group * TRB_PLANES_TOGETHER + i;
      const trb_polygon *p = &first[number < first->n_facets ? number : first->n_facets - 1].surface;
      trb_planes        *to = &planes[group];
      to->origin[0][i] = p->origin.x, to->origin[1][i] = p->origin.y, to->origin[2][i] = p->origin.z;
      to->normal[0][i] = p->normal.x, to->normal[1][i] = p->normal.y, to->normal[2][i] = p->normal.z;
    }
}

/* Adds the facets of the slot of a face, which is the first one of them. */
static trb_status add_surface(const trb_model *m, trb_pockets *row, const trb_face *faces, int n_faces, int pocket, int first, int *count,
                              trb_message *message)
{
  trb_pocket_face *leader = &row->faces[*count];
  for (int i = first; i < n_faces; i++) {
    const trb_face *f = &faces[i];
    if (f->slot[0] != faces[first].slot[0] || !face_in_pocket(f, pocket) || !face_is_on(m, row, f)) continue;
    if (f->part[0] != faces[first].part[0])
      return trb_fail(message, TRB_ERR_INPUT, "pocket face %d: part = %g: must be that of face %d, which has the same slot", i, f->part[0],
                      first);
    trb_pocket_face *to = &row->faces[(*count)++];
    to->surface = surface_of(f);
    to->stiffness_factor = f->stiffness_factor[0];
    to->friction_factor = f->friction_factor[0];
    to->part = (int)f->part[0];
    to->slot = (int)f->slot[0];
    measure(to);
    leader->n_facets++;
  }
  fill_planes(leader, row->planes + (leader - row->faces));
  return TRB_OK;
}

static trb_status fill_faces(trb_model *m, const trb_face *faces, int n_faces, trb_pockets *to, trb_message *message)
{
  size_t total = 0;
  for (int i = 0; i < n_faces; i++) {
    const trb_status status = check_face(&faces[i], i, m->n_rollers, message);
    if (status != TRB_OK) return status;
    if ((int)faces[i].slot[0] + 1 > m->n_slots) m->n_slots = (int)faces[i].slot[0] + 1;
    total += faces[i].pocket[0] < 0.0 ? (size_t)m->n_rollers : 1;
  }
  to->faces = trb_memory_zeros(&m->memory, total, sizeof *to->faces);
  to->first_face = trb_memory_zeros(&m->memory, (size_t)m->n_rollers + 1, sizeof *to->first_face);
  to->planes = trb_memory_zeros(&m->memory, total, sizeof *to->planes);
  if (m->memory.lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for %zu pocket faces", total);
  int count = 0;
  for (int pocket = 0; pocket < m->n_rollers; pocket++) {
    to->first_face[pocket] = count;
    for (int i = 0; i < n_faces; i++) {
      if (!face_in_pocket(&faces[i], pocket) || !face_is_on(m, to, &faces[i])) continue;
      if (has_slot(to, to->first_face[pocket], count, (int)faces[i].slot[0])) continue;
      const trb_status status = add_surface(m, to, faces, n_faces, pocket, i, &count, message);
      if (status != TRB_OK) return status;
    }
  }
  to->first_face[m->n_rollers] = count;
  return TRB_OK;
}

static trb_status place_pockets(trb_model *m, trb_pockets *to, trb_message *message)
{
  const trb_geometry *g = &m->geometry;
  const double        sm = sin(g->roller_axis_angle), cm = cos(g->roller_axis_angle), radius = 0.5 * m->params.bearing.pitch_diameter;
  to->axes = trb_memory_zeros(&m->memory, (size_t)m->n_rollers, sizeof *to->axes);
  to->origin = trb_memory_zeros(&m->memory, (size_t)m->n_rollers, sizeof *to->origin);
  if (m->memory.lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for %d pockets", m->n_rollers);
  for (int j = 0; j < m->n_rollers; j++) {
    const double angle = 2.0 * TRB_PI * j / m->n_rollers, cosine = cos(angle), sine = sin(angle);
    to->axes[j] = (trb_frame){{cm * cosine, cm * sine, -sm}, {-sine, cosine, 0.0}, {sm * cosine, sm * sine, cm}};
    to->origin[j] = trb_v(radius * cosine, radius * sine, -to->offset);
  }
  return TRB_OK;
}

trb_status trb_pockets_fill(trb_model *m, const trb_pocket_inputs *given, const trb_cage_inputs *cage, const trb_face *faces, int n_faces,
                            trb_pockets *to, trb_message *message)
{
  const trb_params *p = &m->params;
  const int         has_oil = p->effects.lubrication != TRB_LUBRICATION_DRY && p->effects.lubrication != TRB_LUBRICATION_BOUNDARY;
  const double      modulus =
      trb_composite_modulus(p->roller.youngs_modulus, p->roller.poisson_ratio, cage->youngs_modulus, cage->poisson_ratio);
  to->given = *given;
  to->film = has_oil ? given->film : 0.0;
  to->damping = p->effects.damping > 0.0 ? given->damping : 0.0;
  to->palmgren = exp(trb_line_log_load(0.0, modulus, p->roller.effective_length));
  to->wall_stiffness = p->roller.end_stiffness * (modulus / m->geometry.effective_modulus);
  to->offset = cage->offset;
  const trb_status status = fill_faces(m, faces, n_faces, to, message);
  return status == TRB_OK ? place_pockets(m, to, message) : status;
}
