#include "body/spacer.h"

#include <string.h>

static void pose_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  trb_body_cage.pose(m, body, drive, y, pose);
}

/* Without rollers; what they add is in motion/spacer.c. */
static void rates_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                     const trb_wrench *load, double *rates)
{
  (void)body;
  (void)y;
  memset(rates, 0, TRB_CAGE_SIZE * sizeof *rates);
  rates[TRB_CAGE_psi] = pose->omega_frame.z - drive->frame_speed;
  rates[TRB_CAGE_omega_a] = load->moment.z / m->params.cage_inertia_axial - drive->frame_rate;
}

static trb_rigid motion_of(const trb_rigid_pose *pose, int coordinate) { return trb_body_cage.motion(pose, coordinate); }

/* What guides the spacer carries its weight. */
static double mass_of(const trb_model *m, const trb_body *body)
{
  (void)m;
  (void)body;
  return 0.0;
}

static double kinetic_of(const trb_model *m, const trb_body *body, const trb_rigid_pose *pose)
{
  (void)body;
  return 0.5 * m->params.cage_inertia_axial * pose->omega_frame.z * pose->omega_frame.z;
}

static double inertia_of(const trb_model *m) { return m->params.cage_inertia_axial; }

#define COORDINATE(name, kind, text) {#name, TRB_TOL_##kind, text},
static const trb_coordinate coordinates[TRB_CAGE_SIZE] = {TRB_CAGE_STATE(COORDINATE)};
#undef COORDINATE

const trb_body_kind trb_body_spacer = {.name = "spacer",
                                       .size = TRB_CAGE_SIZE,
                                       .coordinates = coordinates,
                                       .skew = -1,
                                       .pose = pose_of,
                                       .rates = rates_of,
                                       .motion = motion_of,
                                       .mass = mass_of,
                                       .kinetic = kinetic_of,
                                       .spacing = inertia_of,
                                       .turn = TRB_CAGE_psi,
                                       .turning = TRB_CAGE_omega_a};
