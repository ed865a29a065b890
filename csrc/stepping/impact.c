/* While a roller may meet its pocket within the next steps, or touches it, the tolerances of both bodies are multiplied by a share of the speed at
 * which they met over the absolute tolerance of velocities, or of the interference that follows from it over that of positions, whichever is less,
 * between a least factor and 1 (docs/theory/numerics.md#impacts). The same holds for pairs without a roller. */
#include "stepping/impact.h"

#include <math.h>

#include "motion/fast_pairs.h"
#include "stepping/constants.h"

trb_status trb_impacts_create(const trb_model *m, trb_impacts *impacts, trb_message *message)
{
  const size_t n = (size_t)m->n_rollers;
  *impacts = (trb_impacts){0};
  impacts->speed = trb_memory_zeros(&impacts->memory, n + TRB_MOST_PAIRS, sizeof *impacts->speed);
  impacts->factor = trb_memory_zeros(&impacts->memory, n + TRB_MOST_BODIES, sizeof *impacts->factor);
  if (impacts->memory.lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the impacts of %d rollers", m->n_rollers);
  trb_impacts_forget(m, impacts);
  return TRB_OK;
}

void trb_impacts_forget(const trb_model *m, trb_impacts *impacts)
{
  for (int j = 0; j < m->n_rollers + TRB_MOST_PAIRS; j++) impacts->speed[j] = INFINITY;
  for (int j = 0; j < m->n_rollers + TRB_MOST_BODIES; j++) impacts->factor[j] = 1.0;
}

/* Speed of a roller's centre of mass relative to the point of another body that is there. */
static double closing_speed(const trb_roller_pose *r, const trb_rigid_pose *body)
{
  const trb_vec3 arm = trb_sub(trb_turn_z(r->x, r->cosine, r->sine), body->x);
  const trb_vec3 there = trb_add(body->v, trb_cross(body->omega, arm));
  return trb_norm(trb_sub(r->v, trb_turn_z(there, r->cosine, -r->sine)));
}

/* Bound of that speed without angles: the speed of either against a turn with the frame R about the bearing's axis. */
static double closing_at_most(const trb_model *m, const trb_drive *drive, const double *y_roller, const trb_rigid_pose *body)
{
  const trb_geometry *g = &m->geometry;
  const double        w = drive->frame_speed, radius = g->roller_centre_radius + y_roller[TRB_ROLLER_r];
  const double        around = trb_pure_rolling(m, drive->rolling_speed, drive->carried_speed).v_t + y_roller[TRB_ROLLER_v_t] - w * radius;
  const double        along = g->roller_centre_height + y_roller[TRB_ROLLER_z] - body->x.z;
  const double        arm = fabs(radius) + fabs(body->x.x) + fabs(body->x.y) + fabs(along);
  const trb_vec3 moved = trb_add(body->v, trb_v(w * body->x.y, -w * body->x.x, 0.0)), turned = trb_sub(body->omega, trb_v(0.0, 0.0, w));
  return fabs(y_roller[TRB_ROLLER_v_r]) + fabs(around) + fabs(y_roller[TRB_ROLLER_v_z]) + trb_norm(moved) + trb_norm(turned) * arm;
}

/* Largest interference of a roller and another body that meet, over their speed: one over the natural frequency of both masses on a linear
 * spring, which is as stiff as the contact of a flank is at an interference of 1 um. */
static double rise_of(const trb_dynamics *d, const trb_pair *pair)
{
  const trb_model *m = d->model;
  const trb_body  *other = &d->system->bodies[pair->b];
  const double     roller = m->geometry.roller_mass, body = other->kind->mass(m, other);
  return sqrt(roller * body / ((roller + body) * pair->kind->stiffness(m, pair, trb_impact_interference)));
}

/* Where the bodies are that may be hit; those of the dynamics are at another instant. */
static void place(trb_impacts *impacts, const trb_dynamics *d, const trb_drive *drive, const double *y)
{
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    trb_body_at    *at = &impacts->bodies[b];
    at->rests = body->kind->rests;
    if (body->kind->place != NULL) body->kind->place(d->model, drive, &at->ring);
    if (body->size > 0) trb_body_pose(d->model, body, drive, y + body->first, at);
  }
}

static int is_far(double left, double step, double speed) { return left > trb_impact_steps_ahead * step * speed; }

/* Factor of the tolerances of two bodies. most: the largest speed since they met, which is kept. */
static double factor_of(const trb_approach *now, double step, const trb_impact_measure *measure, double *most)
{
  if (is_far(now->left, step, now->speed)) {
    *most = INFINITY;
    return 1.0;
  }
  *most = now->left <= 0.0 && isfinite(*most) ? trb_max(*most, now->speed) : now->speed;
  const double finer = trb_min(*most / measure->velocity, *most * now->rise / measure->position);
  return trb_clamp(measure->share * finer, measure->least, 1.0);
}

static void take_least(double *least, double factor) { *least = trb_min(*least, factor); }

/* Pairs without a roller: the factor is that of both bodies. */
static void look_at_hub(trb_impacts *impacts, const trb_dynamics *d, const trb_instant *at, double step, const trb_impact_measure *measure)
{
  double *const of_body = impacts->factor + d->model->n_rollers;
  for (int i = 0; i < d->work->n_hub; i++) {
    const trb_pair *pair = d->work->hub[i].pairs[0];
    if (pair->kind->approach == NULL) continue;
    const trb_approach now = pair->kind->approach(d->model, pair, at);
    const double       factor = factor_of(&now, step, measure, &impacts->speed[d->model->n_rollers + d->work->hub[i].index[0]]);
    take_least(&of_body[pair->a], factor);
    take_least(&of_body[pair->b], factor);
  }
}

/* No roller is near anything; of those that are not chosen (ascending) nothing is kept. */
static void begin(const trb_model *m, trb_impacts *impacts, const int *chosen, int n)
{
  int next = 0;
  for (int b = 0; b < TRB_MOST_BODIES; b++) impacts->factor[m->n_rollers + b] = 1.0;
  for (int j = 0; j < m->n_rollers; j++) {
    impacts->factor[j] = 1.0;
    if (next < n && chosen[next] == j) next++;
    else impacts->speed[j] = INFINITY;
  }
}

void trb_impacts_look(trb_impacts *impacts, const trb_dynamics *d, const trb_motion *motion, double time, const double *y, double step,
                      const trb_impact_measure *measure, const int *chosen, int n)
{
  const trb_model *m = d->model;
  trb_drive        drive;
  double           rise[TRB_MOST_PAIRS];
  if (d->n_fast > 0 || d->work->n_hub > 0) {
    trb_motion_at(motion, m, time, &drive);
    place(impacts, d, &drive, y);
  }
  for (int f = 0; f < d->n_fast; f++) rise[f] = rise_of(d, d->fast[f].pair);
  begin(m, impacts, chosen, n);
  for (int k = 0; k < n; k++) {
    const int     j = chosen[k];
    const double *y_roller = y + trb_state_roller(d->system, j);
    for (int f = 0; f < d->n_fast; f++) {
      const trb_fast_pair  *fast = &d->fast[f];
      const trb_rigid_pose *body = &impacts->bodies[fast->pair->b].pose;
      trb_roller_pose       r;
      if (fast->surfaces[j] == 0) continue;
      trb_approach now = {.left = trb_fast_gap_left(d, f, j, y), .speed = closing_at_most(m, &drive, y_roller, body), .rise = rise[f]};
      if (!is_far(now.left, step, now.speed)) {
        trb_roller_pose_unpack_centre(m, &drive, j, y_roller, &r);
        now.speed = closing_speed(&r, body);
      }
      const double factor = factor_of(&now, step, measure, &impacts->speed[j]);
      take_least(&impacts->factor[j], factor);
      take_least(&impacts->factor[m->n_rollers + fast->pair->b], factor);
    }
  }
  if (d->work->n_hub > 0) {
    const trb_instant at = {.drive = &drive, .bodies = impacts->bodies};
    look_at_hub(impacts, d, &at, step, measure);
  }
}
