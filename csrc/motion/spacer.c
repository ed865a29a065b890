#include "motion/spacer.h"

#include <string.h>

static const trb_body *body_of(const trb_system *system) { return &system->bodies[system->spacer]; }

trb_spacer_at trb_spacer_where(const trb_system *system)
{
  const trb_body *body = body_of(system);
  return (trb_spacer_at){.turn = body->first + body->kind->turn, .turning = body->first + body->kind->turning};
}

void trb_spacer_hold(const trb_system *system, const trb_drive *drive, double *y)
{
  const trb_model *m = system->model;
  if (system->spacer < 0) return;
  const trb_spacer_at at = trb_spacer_where(system);
  const double        turn = y[at.turn], turning = y[at.turning], speed = drive->frame_speed + turning;
  const double        rolling = trb_pure_rolling(m, drive->rolling_speed, drive->carried_speed).v_t;
  memset(y + body_of(system)->first, 0, (size_t)body_of(system)->size * sizeof *y);
  y[at.turn] = turn;
  y[at.turning] = turning;
  for (int j = 0; j < m->n_rollers; j++) {
    double *own = y + trb_state_roller(system, j);
    own[TRB_ROLLER_psi] = turn;
    own[TRB_ROLLER_v_t] = (m->geometry.roller_centre_radius + own[TRB_ROLLER_r]) * speed - rolling;
  }
}

static double radius_of(const trb_system *system, int roller, const double *y)
{
  return system->model->geometry.roller_centre_radius + y[trb_state_roller(system, roller) + TRB_ROLLER_r];
}

/* Inertia against a roller's tangential acceleration, times the radius of its orbit, kg m. */
static double moment_of_mass(const trb_system *system, const trb_drive *drive, int roller, const double *y)
{
  const double mass = trb_roller_orbit_mass(system->model, drive, roller, y + trb_state_roller(system, roller));
  return radius_of(system, roller, y) * mass;
}

double trb_spacer_inertia(const trb_system *system, const trb_drive *drive, const double *y)
{
  double inertia = body_of(system)->kind->spacing(body_of(system));
  for (int j = 0; j < system->model->n_rollers; j++) inertia += radius_of(system, j, y) * moment_of_mass(system, drive, j, y);
  return inertia;
}

trb_spaced trb_spacer_part(const trb_system *system, const trb_drive *drive, int roller, const double *y, double inertia)
{
  return (trb_spaced){.radius = radius_of(system, roller, y),
                      .speed = drive->frame_speed + y[trb_spacer_where(system).turning],
                      .share = moment_of_mass(system, drive, roller, y) / inertia};
}

void trb_spacer_join(const trb_system *system, const trb_drive *drive, const double *y, double *rates)
{
  const int    turning = trb_spacer_where(system).turning;
  const double inertia = trb_spacer_inertia(system, drive, y), alone = body_of(system)->kind->spacing(body_of(system));
  const double rolling_rate = trb_pure_rolling(system->model, drive->rolling_rate, drive->carried_rate).v_t;
  double       sum = alone / inertia * (rates[turning] + drive->frame_rate);
  for (int j = 0; j < system->model->n_rollers; j++) {
    const int        first = trb_state_roller(system, j);
    const trb_spaced is = trb_spacer_part(system, drive, j, y, inertia);
    sum += is.share * (rates[first + TRB_ROLLER_v_t] + rolling_rate - y[first + TRB_ROLLER_v_r] * is.speed);
    rates[first + TRB_ROLLER_psi] = rates[first + TRB_ROLLER_v_t] = 0.0;
  }
  rates[turning] = sum - drive->frame_rate;
}
