#include "motion/bound.h"

#include <math.h>
#include <string.h>

/* Across the bearing's axis. */
static double across(trb_vec3 v) { return fabs(v.x) + fabs(v.y); }

static double apart(trb_vec3 a, trb_vec3 b) { return trb_norm(trb_sub(a, b)); }

/* Longest distance of what meets a ring from its reference point, m: that of an outer ring is the apex. */
static double outside_of(const trb_model *m)
{
  return 2.0 * m->geometry.roller_centre_radius + fabs(m->geometry.centre_plane) + m->params.roller.total_length;
}

void trb_ring_offsets_of(const trb_system *system, const trb_body_at *bodies, trb_ring_offset *offsets)
{
  const double outside = outside_of(system->model);
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_ring_pose *ring = &bodies[b].ring;
    offsets[b] = (trb_ring_offset){.lean = 0.0};
    if (!trb_is_ring(system->bodies[b].kind)) continue;
    offsets[b].lean = apart(ring->axis, trb_v(0, 0, 1));
    offsets[b].aside = sqrt(ring->centre.x * ring->centre.x + ring->centre.y * ring->centre.y);
    offsets[b].speed = across(ring->velocity) + outside * across(ring->omega);
  }
}

trb_ring_arms trb_ring_arms_of(const trb_system *system)
{
  trb_ring_arms arms = {.n = 0};
  for (int i = 0; i < system->n_pairs; i++) {
    const trb_pair *pair = &system->pairs[i];
    if (pair->kind->contact == TRB_CONTACT_NONE || pair->kind->pace != TRB_PACE_SLOW || !pair->on) continue;
    pair->kind->arms(system->model, pair, &arms.of[arms.n]);
    arms.body[arms.n] = pair->b;
    arms.row[arms.n++] = i;
  }
  return arms;
}

unsigned trb_bounds_open(const trb_ring_arms *arms, const trb_ring_offset *rings, const double *interference, double share,
                         const double *place, const double *step, double turn)
{
  const double around = fabs(step[TRB_ROLLER_psi]) + fabs(turn);
  unsigned     open = 0U;
  for (int i = 0; i < arms->n; i++) {
    const double length = share * fabs(interference[arms->row[i]]);
    if (!(trb_way_on_ring(&arms->of[i], &rings[arms->body[i]], place, step, around, length) <= length)) open |= 1U << i;
  }
  return open;
}

void trb_bound_set_on_ring(trb_bound *bound, double length, const trb_ring_pose *ring, const double *y_roller, double angle)
{
  *bound = (trb_bound){.length = {length}};
  memcpy(bound->roller, y_roller, sizeof bound->roller);
  bound->roller[TRB_ROLLER_psi] = angle;
  memcpy(bound->body, &ring->centre, sizeof ring->centre);
  memcpy(bound->body + 3, &ring->axis, sizeof ring->axis);
}

int trb_bound_holds_on_ring(const trb_bound *bound, const trb_arms *arms, const trb_ring_offset *offset, const trb_ring_pose *ring,
                            const double *y_roller, double angle)
{
  const double   *from = bound->body, length = bound->length[0], around = fabs(angle - bound->roller[TRB_ROLLER_psi]);
  trb_ring_offset now = *offset;
  double          step[TRB_PLACE_OF_ROLLER];
  if (!(length >= 0.0)) return 0;
  for (int i = 0; i < TRB_PLACE_OF_ROLLER; i++) step[i] = y_roller[i] - bound->roller[i];
  if (ring != NULL) {
    now.shifted = apart(ring->centre, trb_v(from[0], from[1], from[2]));
    now.leaned = apart(ring->axis, trb_v(from[3], from[4], from[5]));
  }
  return trb_way_on_ring(arms, &now, bound->roller, step, around, length) <= length;
}

void trb_speed_bound_set(trb_speed_bound *bound, double length, const trb_system *system, const trb_body_at *bodies, const double *y_roller,
                         double angle)
{
  bound->length = length;
  bound->angle = angle;
  memcpy(bound->roller, y_roller, sizeof bound->roller);
  for (int k = 0; k < system->n_moving; k++) bound->ring[k] = bodies[system->moving[k]].ring;
}

int trb_speed_bound_holds(const trb_speed_bound *bound, const trb_system *system, const trb_ring_offset *offsets, const trb_body_at *bodies,
                          const double *y_roller, double angle)
{
  const trb_model *m = system->model;
  /* distances of what meets from the roller's centre of mass, and from a ring's reference point */
  const double reach = m->params.roller.total_length + m->params.roller.diameter, far = outside_of(m);
  double       passed = 0.0, speed = 0.0;
  for (int b = 0; b < system->n_bodies; b++) passed = trb_max(passed, offsets[b].speed);
  speed = passed * fabs(angle - bound->angle);
  for (int k = 0; k < system->n_moving; k++) {
    const trb_ring_pose *to = &bodies[system->moving[k]].ring, *from = &bound->ring[k];
    speed += apart(to->velocity, from->velocity) + far * apart(to->omega, from->omega);
  }
  for (int i = TRB_ROLLER_v_r; i <= TRB_ROLLER_v_z; i++) speed += fabs(y_roller[i] - bound->roller[i]);
  for (int i = TRB_ROLLER_omega_n; i <= TRB_ROLLER_omega_a; i++) speed += reach * fabs(y_roller[i] - bound->roller[i]);
  return speed <= bound->length;
}
