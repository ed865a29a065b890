/* Roller in its cage pocket: a list of bounded faces, in the frame of the pocket.
 *
 * A flank face meets the chain of inscribed spheres, a large-end face the end's sphere: interference = radius - distance of the centre
 * from the bounded polygon. A small-end face meets the roller's end plane with its vertices, each with its share of the stiffness.
 * All three depend on points fixed in their bodies, so edges and corners make no energy. */
#include <math.h>

#include "contact/contact.h"
#include "contact/friction.h"
#include "laws/interference.h"
#include "laws/line_contact.h"

/* Roller and cage as the pocket sees them. */
typedef struct pocket_view {
  trb_frame axes;     /* pocket axes, in the roller's cylindrical frame */
  trb_vec3  x;        /* roller's centre of mass, from the pocket's origin */
  trb_vec3  a;        /* roller's axis */
  trb_vec3  v, omega; /* roller's velocities */
  trb_vec3  cage;     /* cage's centre of mass, from the pocket's origin */
  trb_vec3  cage_v, cage_omega;
  trb_vec3  force, moment;           /* on the roller, about its centre of mass */
  trb_vec3  cage_force, cage_moment; /* on the cage, about its centre of mass */
} pocket_view;

/* What a face carries. */
typedef struct pocket_sums {
  double force, friction; /* magnitudes summed over the face's nodes, N */
  double deepest;         /* largest interference, m */
} pocket_sums;

static pocket_view view_pocket(const trb_model *m, const trb_roller_pose *r, const trb_cage_pose *cage, int roller)
{
  const trb_frame in_r = trb_compose(&cage->body, &m->pocket_axes[roller]);
  const trb_vec3  origin = trb_add(cage->x, trb_from_frame(&cage->body, m->pocket_origin[roller]));
  const trb_vec3  origin_here = trb_turn_z(origin, r->cosine, -r->sine), cage_here = trb_turn_z(cage->x, r->cosine, -r->sine);
  pocket_view     p = {0};
  p.axes = (trb_frame){trb_turn_z(in_r.n, r->cosine, -r->sine), trb_turn_z(in_r.t, r->cosine, -r->sine),
                       trb_turn_z(in_r.a, r->cosine, -r->sine)};
  p.x = trb_to_frame(&p.axes, trb_sub(r->x, origin_here));
  p.a = trb_to_frame(&p.axes, r->frame.a);
  p.v = trb_to_frame(&p.axes, r->v);
  p.omega = trb_to_frame(&p.axes, r->omega);
  p.cage = trb_to_frame(&p.axes, trb_sub(cage_here, origin_here));
  p.cage_v = trb_to_frame(&p.axes, trb_turn_z(cage->v, r->cosine, -r->sine));
  p.cage_omega = trb_to_frame(&p.axes, trb_turn_z(cage->omega, r->cosine, -r->sine));
  return p;
}

/* Normal from the roller into the face; adds the wrench of one point. */
static void push(const trb_model *m, const trb_pocket_face *f, pocket_view *p, trb_vec3 point, trb_vec3 normal, double elastic,
                 trb_counters *counters, trb_roller_load *load, pocket_sums *sums)
{
  const trb_vec3  arm = trb_sub(point, p->x), cage_arm = trb_sub(point, p->cage);
  const trb_touch touch =
      trb_touching(trb_add(p->v, trb_cross(p->omega, arm)), trb_add(p->cage_v, trb_cross(p->cage_omega, cage_arm)), normal);
  const double q = trb_damped(m, elastic, m->params.damping_cage, touch.rate);
  double       mu = 0.0;
  if (m->pocket_friction) mu = f->face.friction_factor[0] * trb_sliding_coefficient(m, touch.speed);
  const double   drag = q * mu / touch.speed;
  const trb_vec3 force = trb_axpy(trb_scale(-q, normal), -drag, touch.sliding);
  p->force = trb_add(p->force, force);
  p->moment = trb_add(p->moment, trb_cross(arm, force));
  p->cage_force = trb_sub(p->cage_force, force);
  p->cage_moment = trb_sub(p->cage_moment, trb_cross(cage_arm, force));
  load->power[TRB_POWER_POCKET] += drag * trb_dot(touch.sliding, touch.sliding);
  load->power[TRB_POWER_DAMPING] += (q - elastic) * touch.rate;
  sums->force += q;
  sums->friction += q * mu;
  counters->pocket_nodes++;
}

static trb_vec3 array_vector(const double *v) { return trb_v(v[0], v[1], v[2]); }

/* Interference of a sphere with a bounded face; the normal points from the sphere's centre to the nearest point. Without contact it is
 * the plane's, which is no less, unless it is wanted exactly. */
static double sphere_on_face(const trb_model *m, const trb_pocket_face *f, trb_vec3 centre, double radius, int exact, trb_vec3 *normal)
{
  const trb_vec3 u = array_vector(f->face.u), v = array_vector(f->face.v), from = trb_sub(centre, array_vector(f->face.origin));
  const double   h = trb_dot(from, f->normal);
  if (m->params.pocket_edges <= 0.0 || (h >= radius && !exact)) {
    *normal = trb_scale(-1.0, f->normal);
    return radius - h;
  }
  const double cu = trb_dot(from, u), cv = trb_dot(from, v);
  double       nu, nv;
  trb_nearest_in_polygon(f->face.outline, f->n, cu, cv, &nu, &nv);
  const trb_vec3 to = trb_axpy(trb_axpy(trb_scale(-h, f->normal), nu - cu, u), nv - cv, v);
  const double   distance = trb_norm(to);
  *normal = trb_scale(1.0 / trb_max(distance, 1e-12), to);
  return radius - distance;
}

static void flank_on_face(const trb_model *m, const trb_pocket_face *f, pocket_view *p, int roller, int exact, trb_counters *counters,
                          trb_roller_load *load, pocket_sums *sums)
{
  const double *centre = m->centre + (size_t)roller * (size_t)m->n_lanes, *sphere = m->sphere + (size_t)roller * (size_t)m->n_lanes;
  const double  stiffness = m->palmgren * f->face.stiffness_factor[0], *weight = m->race[TRB_RACE_OUTER].weight;
  for (int k = 0; k < m->n_nodes; k++) {
    trb_vec3       normal;
    const trb_vec3 c = trb_axpy(p->x, centre[k], p->a);
    const double   d = sphere_on_face(m, f, c, sphere[k], exact, &normal);
    sums->deepest = trb_max(sums->deepest, d);
    if (!(d > 0.0)) continue;
    const double q = stiffness * weight[k] * pow(d, TRB_PALMGREN_EXPONENT);
    load->elastic += TRB_PALMGREN_ENERGY * q * d;
    push(m, f, p, trb_axpy(c, sphere[k] - 0.5 * d, normal), normal, q, counters, load, sums);
  }
}

static void large_end_on_face(const trb_model *m, const trb_pocket_face *f, pocket_view *p, int exact, trb_counters *counters,
                              trb_roller_load *load, pocket_sums *sums)
{
  const trb_geometry *g = &m->geometry;
  const trb_vec3      c = trb_axpy(p->x, g->sphere_centre - g->apex_to_mid - g->roller_mass_offset, p->a);
  trb_vec3            normal;
  const double        d = sphere_on_face(m, f, c, g->sphere_radius, exact, &normal);
  sums->deepest = d;
  if (!(d > 0.0)) return;
  const double q = m->params.end_stiffness * f->face.stiffness_factor[0] * d * sqrt(d);
  load->elastic += 0.4 * q * d;
  push(m, f, p, trb_axpy(c, g->sphere_radius - 0.5 * d, normal), normal, q, counters, load, sums);
}

static void small_end_on_face(const trb_model *m, const trb_pocket_face *f, pocket_view *p, trb_counters *counters, trb_roller_load *load,
                              pocket_sums *sums)
{
  const trb_vec3 end = trb_axpy(p->x, m->geometry.small_end_station - m->geometry.roller_mass_offset, p->a), normal = trb_scale(-1.0, p->a);
  const double   stiffness = m->params.end_stiffness * f->face.stiffness_factor[0] / f->n;
  for (int i = 0; i < f->n; i++) {
    const double  *vertex = f->face.outline + 2 * i;
    const trb_vec3 point =
        trb_axpy(trb_axpy(array_vector(f->face.origin), vertex[0], array_vector(f->face.u)), vertex[1], array_vector(f->face.v));
    const double d = trb_dot(trb_sub(point, end), p->a);
    sums->deepest = trb_max(sums->deepest, d);
    if (!(d > 0.0)) continue;
    const double q = stiffness * d * sqrt(d);
    load->elastic += 0.4 * q * d;
    push(m, f, p, point, normal, q, counters, load, sums);
  }
}

/* Lower bound of the gap: a bounded face is no nearer than its plane, and the height over a plane less the sphere's radius is linear
 * along an undropped cone, so that its least value is at an end; a profile only takes material away. */
static double flank_gap(const trb_model *m, const trb_pocket_face *f, const pocket_view *p, int roller)
{
  const double   tangent = m->roller_tangent, cosine = m->roller_cosine, deviation = 0.5 * m->diameter_deviation[roller];
  const trb_vec3 origin = array_vector(f->face.origin);
  double         gap = INFINITY;
  for (int end = -1; end <= 1; end += 2) {
    const double   station = 0.5 * end * m->params.effective_length, radius = (m->geometry.apex_to_mid + station) * tangent + deviation;
    const trb_vec3 c = trb_axpy(p->x, station + radius * tangent - m->geometry.roller_mass_offset, p->a);
    gap = trb_min(gap, trb_dot(trb_sub(c, origin), f->normal) - radius / cosine);
  }
  return gap;
}

double trb_contact_pocket_of(const trb_model *m, const trb_instant *at, int roller, trb_counters *counters, trb_roller_load *load,
                             trb_detail *detail)
{
  const trb_roller_pose *r = &at->rollers[roller];
  const int              exact = detail != NULL;
  pocket_view            p = view_pocket(m, r, at->cage, roller);
  double                 gap = INFINITY;
  for (int i = m->first_face[roller]; i < m->first_face[roller + 1]; i++) {
    const trb_pocket_face *f = &m->faces[i];
    pocket_sums            sums = {0.0, 0.0, -INFINITY};
    counters->pocket_tests++;
    if (f->part == TRB_PART_FLANK) {
      const double flank = flank_gap(m, f, &p, roller);
      gap = trb_min(gap, flank);
      if (!exact && flank >= 0.0) {
        counters->pocket_culled++;
        continue;
      }
      flank_on_face(m, f, &p, roller, exact, counters, load, &sums);
    } else if (f->part == TRB_PART_LARGE_END) {
      large_end_on_face(m, f, &p, exact, counters, load, &sums);
      gap = trb_min(gap, -sums.deepest);
    } else {
      small_end_on_face(m, f, &p, counters, load, &sums);
      gap = trb_min(gap, -sums.deepest);
    }
    if (detail != NULL) {
      const int slot = roller * m->n_slots + f->slot;
      detail->pocket_force[slot] += sums.force;
      detail->pocket_friction[slot] += sums.friction;
      detail->pocket_interference[slot] = trb_max(detail->pocket_interference[slot], sums.deepest);
    }
  }
  if (gap > 0.0) return gap;
  load->force = trb_add(load->force, trb_from_frame(&p.axes, p.force));
  load->moment = trb_add(load->moment, trb_from_frame(&p.axes, p.moment));
  load->cage_force = trb_add(load->cage_force, trb_turn_z(trb_from_frame(&p.axes, p.cage_force), r->cosine, r->sine));
  load->cage_moment = trb_add(load->cage_moment, trb_turn_z(trb_from_frame(&p.axes, p.cage_moment), r->cosine, r->sine));
  return gap;
}

void trb_contact_pocket(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads, trb_detail *detail)
{
  for (int k = 0; k < at->n; k++) (void)trb_contact_pocket_of(m, at, at->chosen[k], &work->counters, &loads[at->chosen[k]], detail);
}
