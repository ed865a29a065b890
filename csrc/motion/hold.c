#include "motion/hold.h"

#include <math.h>
#include <string.h>

static double size_of_roller(const trb_model *m) { return m->params.total_length + m->params.roller_diameter; }

trb_hold_arms trb_hold_arms_raceway(const trb_model *m)
{
  double reach = 0.0;
  for (int j = 0; j < m->n_rollers; j++)
    for (int k = 0; k < m->n_nodes; k++) reach = fmax(reach, fabs(m->centre[j * m->n_lanes + k]));
  const trb_race_nodes *outer = &m->race[TRB_RACE_OUTER], *inner = &m->race[TRB_RACE_INNER];
  return (trb_hold_arms){fmax(outer->cosine, inner->cosine),    fmax(outer->sine, inner->sine), reach, reach, size_of_roller(m),
                         0.5 * m->geometry.roller_centre_radius};
}

/* The end's sphere turns about the roller's centre of mass: its centre moves nearly across the normal. */
trb_hold_arms trb_hold_arms_rib(const trb_model *m)
{
  const trb_geometry *g = &m->geometry;
  const double        station = g->sphere_centre - g->apex_to_mid - g->roller_mass_offset;
  const double        lean = fabs(m->rib_sine * m->axis_cosine - m->rib_cosine * m->axis_sine);
  return (trb_hold_arms){fabs(m->rib_sine), fabs(m->rib_cosine), lean * fabs(station),
                         fabs(station),     size_of_roller(m),   fabs(g->roller_centre_radius + station * m->axis_sine)};
}

/* The deepest point wanders round the end: the arm is that of the rib's edge. */
trb_hold_arms trb_hold_arms_front_rib(const trb_model *m)
{
  const double arm = 2.0 * m->geometry.roller_centre_radius;
  return (trb_hold_arms){1.0, 1.0, arm, arm, size_of_roller(m), 1e-12};
}

/* Across the bearing's axis. */
static double across(trb_vec3 v) { return fabs(v.x) + fabs(v.y); }

trb_hold_ring trb_hold_ring_of(const trb_model *m, const trb_drive *drive)
{
  const trb_ring_pose *ring = &drive->inner;
  const double         outside = 2.0 * m->geometry.roller_centre_radius, far = m->geometry.apex_to_mid + outside;
  return (trb_hold_ring){across(ring->apex) + far * across(ring->axis), across(ring->velocity) + outside * across(ring->omega)};
}

void trb_hold_set(const double *y_roller, double turn, double way, double speed, trb_hold *hold)
{
  hold->way = way;
  hold->speed = speed;
  hold->turn = turn;
  memcpy(hold->y, y_roller, sizeof hold->y);
}

int trb_hold_holds(const trb_hold *hold, const trb_hold_arms *arms, const trb_hold_ring *ring, const double *y, double turn)
{
  const double *from = hold->y;
  if (!(hold->way >= 0.0)) return 0;
  const double turned = fabs(turn - hold->turn), aside = arms->skew * fabs(y[TRB_ROLLER_skew] - from[TRB_ROLLER_skew]);
  /* the normal's part across the axial plane, times off */
  const double slant = arms->skew * fabs(y[TRB_ROLLER_skew]) + aside + ring->place;
  const double way = arms->radial * fabs(y[TRB_ROLLER_r] - from[TRB_ROLLER_r]) + arms->axial * fabs(y[TRB_ROLLER_z] - from[TRB_ROLLER_z]) +
                     arms->tilt * fabs(y[TRB_ROLLER_tilt] - from[TRB_ROLLER_tilt]) + turned * ring->place;
  if (!(way * arms->off + aside * trb_min(slant, arms->off) <= hold->way * arms->off)) return 0; /* nor what is not a number */
  double speed = turned * ring->speed;
  for (int i = TRB_ROLLER_v_r; i <= TRB_ROLLER_v_z; i++) speed += fabs(y[i] - from[i]);
  for (int i = TRB_ROLLER_omega_n; i <= TRB_ROLLER_omega_a; i++) speed += arms->reach * fabs(y[i] - from[i]);
  return speed <= hold->speed;
}
