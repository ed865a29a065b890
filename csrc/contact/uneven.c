#include "contact/uneven.h"

#include <math.h>
#include <string.h>

/* Angle by which nodes of a contact line may stand elsewhere on a race than the roller's centre: what skew, and a ring that is displaced, do
 * to it, rad. */
static const double margin = 0.05;

/* Where either race meets a roller that has not turned. */
static double met_at(int race) { return race == TRB_RACE_OUTER ? 0.0 : TRB_PI; }

int trb_uneven_is_near(const trb_model *m, int race, int roller, double azimuth, double turned, double spin)
{
  return trb_form_is_near(&m->form, trb_form_of_race(race), azimuth - turned, margin) ||
         trb_form_is_near(&m->form, trb_form_of_roller(roller, race), met_at(race) - spin, 0.0);
}

/* A force per unit of load at a point, from the roller's centre of mass. */
static void add_force(const trb_race_input *in, trb_vec3 from_roller, trb_vec3 force, int at, trb_uneven *to)
{
  const trb_vec3 from_ring = trb_add(from_roller, trb_sub(in->roller->x, in->ring->centre));
  const trb_vec3 moment = trb_cross(from_roller, force), on_ring = trb_cross(force, from_ring);
  to->fx[at] += force.x, to->fy[at] += force.y, to->fz[at] += force.z;
  to->mx[at] += moment.x, to->my[at] += moment.y, to->mz[at] += moment.z;
  to->hx[at] += on_ring.x, to->hy[at] += on_ring.y, to->hz[at] += on_ring.z;
}

static void add_race(const trb_model *m, const trb_race_input *in, double azimuth, int node, int at, trb_uneven *to)
{
  const trb_roller_pose *r = in->roller;
  const trb_ring_pose   *g = in->ring;
  const trb_vec3         point = trb_scale(in->centre[node], r->frame.a), from_ring = trb_add(point, trb_sub(r->x, g->centre));
  const trb_vec3         across = trb_axpy(from_ring, -trb_dot(from_ring, g->axis), g->axis);
  const double           distance = trb_norm(across);
  const trb_vec3         along = trb_scale(1.0 / distance, trb_cross(g->axis, across));
  double                 depth = 0.0, slope = 0.0;
  if (!trb_form_at(&m->form, trb_form_of_race(in->nodes->race), azimuth + atan2(across.y, across.x) - g->angle, node, &depth, &slope))
    return;
  const trb_vec3 roller = trb_add(r->v, trb_cross(r->omega, point)), ring = trb_add(g->velocity, trb_cross(g->omega, from_ring));
  to->depth[at] += depth;
  to->rate[at] += slope * trb_dot(trb_sub(roller, ring), along) / distance;
  add_force(in, point, trb_scale(slope / distance, along), at, to);
}

static void add_roller(const trb_model *m, const trb_race_input *in, int roller, double spin, int node, int at, trb_uneven *to)
{
  const trb_roller_pose *r = in->roller;
  const int              race = in->nodes->race;
  double                 depth = 0.0, slope = 0.0;
  if (!trb_form_at(&m->form, trb_form_of_roller(roller, race), met_at(race) - spin, node, &depth, &slope)) return;
  to->depth[at] += depth;
  to->rate[at] -= slope * (r->omega_frame.z - r->orbit_speed * r->frame.a.z);
  add_force(in, trb_scale(-r->radius / r->frame.a.z, r->frame.n), trb_v(0.0, slope * r->frame.a.z / r->radius, 0.0), at, to);
}

void trb_uneven_fill(const trb_model *m, const trb_race_input *in, int roller, double azimuth, double spin, int first, trb_uneven *to)
{
  for (size_t f = 0; f < sizeof *to / sizeof to->depth; f++)
    memset((double *)to + f * TRB_LANE_STRIDE + first, 0, (size_t)m->n_lanes * sizeof(double));
  for (int i = 0; i < m->n_lanes; i++) {
    const int node = i < m->n_nodes ? i : m->n_nodes - 1;
    add_race(m, in, azimuth, node, first + i, to);
    add_roller(m, in, roller, spin, node, first + i, to);
  }
}
