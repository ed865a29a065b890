#include "motion/margin.h"

#include <math.h>

trb_margin_arms trb_margin_arms_of(const trb_model *m)
{
  const trb_geometry *g = &m->geometry;
  const double        offset = fabs(g->roller_mass_offset), sphere = fabs(g->sphere_centre - g->apex_to_mid) + offset;
  const double        end = hypot(fabs(g->small_end_station) + offset, g->outer_race_radius);
  double              chain = 0.0;
  trb_margin_arms     arms;
  for (int j = 0; j < m->n_rollers; j++)
    for (int k = 0; k < m->n_nodes; k++) chain = fmax(chain, fabs(m->centre[j * m->n_lanes + k]));
  arms.arm[TRB_MARGIN_RACES] = chain;
  arms.arm[TRB_MARGIN_RIB] = sphere;
  arms.arm[TRB_MARGIN_FRONT_RIB] = end;
  for (int i = 0; i < TRB_N_MARGINS; i++) arms.ring[i] = arms.arm[i] + g->outer_race_radius + m->params.total_length;
  arms.rib_sine = fabs(m->rib_sine);
  arms.rib_lean = fabs(sin(g->rib_normal_angle - g->roller_axis_angle));
  arms.sphere_offset = fabs(g->sphere_centre) * sin(g->roller_axis_angle);
  return arms;
}

/* Bound of how a turn of the roller changes the interference at the rib. The interference of a sphere and a cone follows the sphere's
 * centre along the cone's normal. This centre lies far from the roller's centre of mass, so the arm is long. But the normal points
 * nearly along the roller's axis, so a turn moves the centre nearly across the normal. What remains is proportional to the angle between
 * axis and normal, to the skew, and to the turn of the normal about the bearing axis, which can be large as the sphere's centre is close
 * to that axis. */
static double turned_at_rib(const trb_margin_arms *a, const double *place, const double *step, double lean)
{
  const double skewed = fabs(step[TRB_ROLLER_skew]), tilted = fabs(step[TRB_ROLLER_tilt]);
  const double skew = fabs(place[TRB_ROLLER_skew]) + skewed, tilt = fabs(place[TRB_ROLLER_tilt]) + tilted;
  const double arm = a->arm[TRB_MARGIN_RIB], across = arm * (skew + tilt + lean) / (0.5 * a->sphere_offset);
  const double sine = a->rib_sine * trb_min(across, 1.0);
  return arm * (skewed * (sine + skew + lean) + tilted * (a->rib_lean + sine + tilt + lean));
}

int trb_margin_holds(const trb_margin_arms *a, const trb_drive *drive, const double *margin, double share, const double *place,
                     const double *step, double turn)
{
  const double lean = hypot(drive->inner.axis.x, drive->inner.axis.y), aside = hypot(drive->displacement.x, drive->displacement.y);
  const double around = fabs(step[TRB_ROLLER_psi]) + fabs(turn), shift = fabs(step[TRB_ROLLER_r]) + fabs(step[TRB_ROLLER_z]);
  const double turned = fabs(step[TRB_ROLLER_skew]) + fabs(step[TRB_ROLLER_tilt]);
  const double by_turn[TRB_N_MARGINS] = {a->arm[TRB_MARGIN_RACES] * turned, turned_at_rib(a, place, step, lean),
                                         a->arm[TRB_MARGIN_FRONT_RIB] * turned};
  for (int i = 0; i < TRB_N_MARGINS; i++)
    if (!(shift + by_turn[i] + around * (aside + lean * a->ring[i]) <= share * margin[i])) return 0;
  return 1;
}
