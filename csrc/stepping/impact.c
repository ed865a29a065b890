/* An impact is followed well if the errors of a step are small beside the speed at which the bodies meet and beside the interference
 * that follows from it, and not beside numbers that are the same for all impacts (docs/theory/numerics.md#impacts). So while a roller
 * may meet its pocket within the next steps, or touches it, the tolerances of roller and cage are multiplied by a factor: a share of
 * that speed over the absolute tolerance of velocities, or of that interference over the absolute tolerance of positions, whichever is
 * less, between a least factor and 1. The speed is the largest since they met, as it passes through zero during contact. The same holds
 * for the cage and a land. */
#include "stepping/impact.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Steps ahead in which a gap may close. */
static const double ahead = 3.0;

trb_status trb_impacts_create(const trb_model *m, trb_impacts *impacts, trb_message *message)
{
  const size_t n = (size_t)m->n_rollers;
  impacts->speed = trb_zeros(n + TRB_N_PAIRS, sizeof *impacts->speed);
  impacts->factor = trb_zeros(n + 1, sizeof *impacts->factor);
  if (impacts->speed == NULL || impacts->factor == NULL) {
    trb_impacts_free(impacts);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the impacts of %d rollers", m->n_rollers);
  }
  trb_impacts_forget(m, impacts);
  return TRB_OK;
}

void trb_impacts_free(trb_impacts *impacts)
{
  free(impacts->speed);
  free(impacts->factor);
  *impacts = (trb_impacts){NULL, NULL};
}

void trb_impacts_forget(const trb_model *m, trb_impacts *impacts)
{
  for (int j = 0; j < m->n_rollers + TRB_N_PAIRS; j++) impacts->speed[j] = INFINITY;
  for (int j = 0; j <= m->n_rollers; j++) impacts->factor[j] = 1.0;
}

/* Speed of a roller's centre of mass relative to its pocket. */
static double closing_speed(const trb_roller_pose *r, const trb_rigid_pose *cage)
{
  const trb_vec3 arm = trb_sub(trb_turn_z(r->x, r->cosine, r->sine), cage->x);
  const trb_vec3 pocket = trb_add(cage->v, trb_cross(cage->omega, arm));
  return trb_norm(trb_sub(r->v, trb_turn_z(pocket, r->cosine, -r->sine)));
}

/* Largest interference of a roller and the cage that meet, over their speed: one over the natural frequency of both masses on a linear
 * spring, which is as stiff as the contact of a flank is at an interference of 1 um. */
static double rise_of(const trb_model *m, const trb_pair *pair)
{
  const double roller = m->geometry.roller_mass, cage = m->params.cage_mass, stiffness = pair->stiffness(m, 1e-6);
  return sqrt(roller * cage / ((roller + cage) * stiffness));
}

/* Factor of the tolerances of two bodies. most: the largest speed since they met, which is kept. */
static double factor_of(const trb_approach *now, double step, const trb_impact_measure *measure, double *most)
{
  if (now->left > ahead * step * now->speed) {
    *most = INFINITY;
    return 1.0;
  }
  *most = now->left <= 0.0 && isfinite(*most) ? trb_max(*most, now->speed) : now->speed;
  const double finer = trb_min(*most / measure->velocity, *most * now->rise / measure->position);
  return trb_clamp(measure->share * finer, measure->least, 1.0);
}

/* Least factor of the pairs without a roller. */
static double factor_of_hub(trb_impacts *impacts, const trb_dynamics *d, const trb_instant *at, double step,
                            const trb_impact_measure *measure)
{
  double least = 1.0;
  for (int i = 0; i < d->work->n_hub; i++) {
    const trb_pair *pair = trb_pair_table[d->work->hub[i]];
    if (pair->approach == NULL) continue;
    const trb_approach now = pair->approach(d->model, at);
    least = trb_min(least, factor_of(&now, step, measure, &impacts->speed[d->model->n_rollers + d->work->hub[i]]));
  }
  return least;
}

void trb_impacts_look(trb_impacts *impacts, const trb_dynamics *d, const trb_motion *motion, double time, const double *y, double step,
                      const trb_impact_measure *measure)
{
  const trb_model *m = d->model;
  const double    *y_cage = y + trb_state_cage(m);
  trb_drive        drive;
  trb_rigid_pose   cage;
  double           rise[TRB_N_PAIRS], least = 1.0;
  int              posed = 0;
  for (int f = 0; f < d->n_fast; f++) rise[f] = rise_of(m, d->fast[f].pair);
  for (int j = 0; j < m->n_rollers; j++) {
    const double *y_roller = y + trb_state_roller(j);
    impacts->factor[j] = 1.0;
    for (int f = 0; f < d->n_fast; f++) {
      const trb_fast_pair *fast = &d->fast[f];
      if (fast->pair->surfaces(m, j) == 0) continue;
      if (!posed) {
        trb_motion_at(motion, m, time, &drive);
        trb_cage_pose_unpack(m, &drive, y_cage, &cage);
        posed = 1;
      }
      trb_roller_pose r;
      trb_roller_pose_unpack_centre(m, &drive, j, y_roller, &r);
      const double       left = trb_clearance_left(&fast->clearances[j], fast->arms, y_roller, y_cage);
      const trb_approach now = {.left = left, .speed = closing_speed(&r, &cage), .rise = rise[f]};
      impacts->factor[j] = trb_min(impacts->factor[j], factor_of(&now, step, measure, &impacts->speed[j]));
    }
    least = trb_min(least, impacts->factor[j]);
  }
  if (d->work->n_hub > 0) {
    trb_motion_at(motion, m, time, &drive);
    trb_cage_pose_unpack(m, &drive, y_cage, &cage);
    trb_ring rings[TRB_N_RINGS] = {0};
    trb_rings_place(m, &drive, rings);
    const trb_instant at = {.drive = &drive, .rings = rings, .cage = &cage};
    least = trb_min(least, factor_of_hub(impacts, d, &at, step, measure));
  }
  impacts->factor[m->n_rollers] = least;
}
