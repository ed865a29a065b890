/* The cage on the land of a ring (docs/theory/contacts.md#cage-on-a-rings-land): an oil film, and below a stated height of the film an
 * elastic contact with friction. The guiding surface of the cage is cut into strips along its width; in each strip the two axes lie
 * `apart` from each other, across the ring's axis. A film force acts midway between the axes, where the relative velocity is the one that
 * the law asks for: so the power that both bodies lose is exactly that of the law, tilted or not. */
#include <math.h>

#include "contact/friction.h"
#include "contact/pair.h"
#include "laws/journal.h"
#include "laws/line_contact.h"
#include "surface/land.h"

/* Both bodies, and what is summed. */
typedef struct meeting {
  const trb_model      *m;
  const trb_guided     *guided;
  const trb_rigid_pose *cage;
  trb_ring_pose         ring;   /* in R; centre: the point about which its moment is taken */
  int                   inside; /* 1: the cage runs inside the land */
  double                radius; /* of the land, m */
  trb_counters         *counters;
  trb_load             *load;
  trb_land_detail       seen;
  trb_vec3              film, contact; /* forces on the cage, N */
} meeting;

static trb_land_strip strip_at(const meeting *w, double station)
{
  return trb_land_strip_at(trb_axpy(w->cage->x, w->guided->place + station, w->cage->frame.a), w->ring.centre, w->ring.axis);
}

static trb_vec3 cage_velocity(const meeting *w, trb_vec3 at)
{
  return trb_add(w->cage->v, trb_cross(w->cage->omega, trb_sub(at, w->cage->x)));
}

static trb_vec3 ring_velocity(const meeting *w, trb_vec3 at)
{
  return trb_add(w->ring.velocity, trb_cross(w->ring.omega, trb_sub(at, w->ring.centre)));
}

/* A force on the cage at a point and a couple about the ring's axis, with their opposites on the ring. by: of the mechanism that makes torque. */
static void act(meeting *w, trb_vec3 at, trb_vec3 force, double couple, trb_mechanism by)
{
  const trb_vec3 about = trb_scale(couple, w->ring.axis);
  const trb_vec3 on_cage = trb_add(trb_cross(trb_sub(at, w->cage->x), force), about);
  const trb_vec3 on_ring = trb_scale(-1.0, trb_add(trb_cross(trb_sub(at, w->ring.centre), force), about));
  trb_add_wrench(&w->load->on_a, &(trb_wrench){force, on_cage});
  trb_add_wrench(&w->load->on_b, &(trb_wrench){trb_scale(-1.0, force), on_ring});
  w->load->torque[by] += trb_dot(on_ring, w->ring.axis);
  w->seen.torque -= trb_dot(on_ring, w->ring.axis);
}

/* Largest distance of the axes of a strip at which nothing touches. */
static double room(const trb_guided *guided) { return guided->given.clearance - guided->given.contact_film; }

static void film_on_strip(meeting *w, double station, double width)
{
  const trb_land_inputs *land = &w->guided->given;
  const double           viscosity = w->m->params.oil.viscosity;
  const trb_land_strip   s = strip_at(w, station);
  const double c = land->clearance, held = s.size > room(w->guided) ? room(w->guided) / s.size : 1.0, half = 0.5 * land->fill * land->width;
  const trb_vec3 at = trb_axpy(s.x, -0.5, s.apart), apart = trb_scale(held / c, s.apart);
  const trb_vec3 relative = trb_sub(cage_velocity(w, at), ring_velocity(w, at));
  const trb_vec3 v = trb_axpy(relative, -trb_dot(relative, w->ring.axis), w->ring.axis), around = trb_cross(w->ring.axis, v);
  const double   speed = trb_norm(v), turning = trb_dot(trb_sub(w->ring.omega, w->cage->omega), w->ring.axis);
  const double   shear = trb_journal_shear(viscosity, w->radius, width, c, trb_norm(apart));
  trb_vec3       force = {0, 0, 0};
  w->counters->land_films++;
  if (speed > 0.0) {
    const trb_journal_film film = trb_journal_short(trb_dot(apart, v) / speed, trb_dot(apart, around) / speed);
    const double           scale = -6.0 * viscosity * w->radius * width * (half * half - station * station) / (c * c * c);
    force = trb_axpy(trb_scale(scale * film.along, v), scale * film.across, around);
  }
  act(w, at, force, shear * turning, TRB_BY_FILM);
  w->load->lost[TRB_BY_FILM] += shear * turning * turning - trb_dot(force, v);
  w->film = trb_add(w->film, force);
}

static void contact_on_strip(meeting *w, double station, double width)
{
  const trb_model     *m = w->m;
  const trb_land_strip s = strip_at(w, station);
  const double         d = s.size - room(w->guided);
  w->seen.gap = trb_min(w->seen.gap, w->guided->given.clearance - s.size);
  if (!(d > 0.0)) return;
  w->counters->land_contacts++;
  const trb_vec3  normal = trb_scale(1.0 / s.size, s.apart), at = trb_land_nearest(&s, normal, w->radius, w->inside);
  const trb_touch touch = trb_touching(cage_velocity(w, at), ring_velocity(w, at), normal);
  const double    elastic = w->guided->palmgren * width * pow(d, TRB_PALMGREN_EXPONENT);
  const trb_push  push = trb_push_at(m, &touch, normal, elastic, w->guided->damping, 1.0, w->load->lost);
  act(w, at, push.force, 0.0, TRB_BY_SLIDING);
  w->load->elastic += TRB_PALMGREN_ENERGY * elastic * d;
  w->contact = trb_axpy(w->contact, -push.load, normal);
  w->seen.friction += push.load * push.mu;
}

static meeting meeting_of(const trb_model *m, const trb_pair *pair, const trb_instant *at)
{
  const trb_guide *guide = pair->own;
  return (meeting){.m = m,
                   .guided = pair->own_a,
                   .cage = &at->bodies[pair->a].pose,
                   .ring = trb_body_in(&at->bodies[pair->b], at->drive->cosine, at->drive->sine),
                   .inside = guide->inside,
                   .radius = guide->radius,
                   .seen = {.gap = INFINITY}};
}

static void meet(const trb_model *m, const trb_pair *pair, const trb_instant *at, trb_counters *counters, trb_load *load,
                 trb_detail *detail)
{
  const trb_guided *guided = pair->own_a;
  meeting           w = meeting_of(m, pair, at);
  w.counters = counters;
  w.load = load;
  for (int k = 0; k < TRB_LAND_STRIPS; k++) {
    const double station = guided->station[k], width = guided->weight[k];
    if (guided->film) film_on_strip(&w, guided->given.fill * station, guided->given.fill * width);
    contact_on_strip(&w, station, width);
  }
  if (detail == NULL) return;
  w.seen.eccentricity = strip_at(&w, 0.0).size / guided->given.clearance;
  w.seen.film_force = trb_norm(w.film);
  w.seen.contact_force = trb_norm(w.contact);
  w.seen.force = trb_norm(trb_add(w.film, w.contact));
  detail->land = w.seen;
}

/* Of the strip that is nearest to the land. A hit deepens as that of the cage's mass on a spring that is as stiff as the contact is at an
 * interference of 1 um. */
static trb_approach approach_of(const trb_model *m, const trb_pair *pair, const trb_instant *at)
{
  const meeting w = meeting_of(m, pair, at);
  const double  stiffness = w.guided->palmgren * w.guided->given.width * pow(1e-6, TRB_PALMGREN_EXPONENT - 1.0);
  trb_approach  found = {.left = INFINITY, .rise = sqrt(w.guided->mass / stiffness)};
  for (int k = 0; k < TRB_LAND_STRIPS; k++) {
    const trb_land_strip s = strip_at(&w, w.guided->station[k]);
    const double         left = room(w.guided) - s.size;
    if (!(left < found.left)) continue;
    found.left = left;
    found.speed =
        fabs(trb_dot(trb_sub(cage_velocity(&w, s.x), ring_velocity(&w, trb_sub(s.x, s.apart))), s.apart)) / trb_max(s.size, 1e-12);
  }
  return found;
}

/* Its own parameters: trb_guide. */
const trb_pair_kind trb_pair_land = {.name = "cage on a land",
                                     .shape = {TRB_SHAPE_CYLINDER, TRB_SHAPE_LAND},
                                     .mechanisms = TRB_LOSES(TRB_BY_SLIDING) | TRB_LOSES(TRB_BY_DAMPING) | TRB_LOSES(TRB_BY_FILM),
                                     .between = meet,
                                     .approach = approach_of};
