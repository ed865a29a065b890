#include "bearing/state.h"

trb_tolerance trb_state_tolerance(const trb_model *m, int index)
{
#define TRB_STATE_KIND(name, kind, text) TRB_TOL_##kind,
  static const trb_tolerance roller[TRB_ROLLER_SIZE] = {TRB_ROLLER_STATE(TRB_STATE_KIND)};
  static const trb_tolerance cage[TRB_CAGE_SIZE] = {TRB_CAGE_STATE(TRB_STATE_KIND)};
#undef TRB_STATE_KIND
  if (index < trb_state_cage(m)) return roller[index % TRB_ROLLER_SIZE];
  if (index < trb_state_main_size(m)) return cage[index - trb_state_cage(m)];
  return TRB_TOL_QUADRATURE;
}

void trb_roller_pose_unpack(const trb_model *m, const trb_drive *drive, int roller, const double *y, trb_roller_pose *pose)
{
  const trb_geometry *g = &m->geometry;
  const trb_rolling   rolling = trb_pure_rolling(m, drive->shaft_speed);
  pose->radius = g->roller_centre_radius + y[TRB_ROLLER_r];
  pose->angle = trb_nominal_angle(m, roller) + y[TRB_ROLLER_psi];
  pose->cosine = cos(pose->angle);
  pose->sine = sin(pose->angle);
  pose->x = trb_v(pose->radius, 0.0, g->roller_centre_height + y[TRB_ROLLER_z]);
  pose->frame = trb_tilted_frame(y[TRB_ROLLER_skew], g->roller_axis_angle + y[TRB_ROLLER_tilt]);
  pose->v = trb_v(y[TRB_ROLLER_v_r], rolling.v_t + y[TRB_ROLLER_v_t], y[TRB_ROLLER_v_z]);
  pose->orbit_speed = pose->v.y / pose->radius;
  pose->omega_frame = trb_v(rolling.omega_n + y[TRB_ROLLER_omega_n], y[TRB_ROLLER_omega_t], rolling.omega_a + y[TRB_ROLLER_omega_a]);
  pose->omega = trb_from_frame(&pose->frame, pose->omega_frame);
}

void trb_cage_pose_unpack(const trb_model *m, const trb_drive *drive, const double *y, trb_cage_pose *pose)
{
  const double turn_cos = cos(y[TRB_CAGE_psi]), turn_sin = sin(y[TRB_CAGE_psi]);
  pose->x = trb_v(y[TRB_CAGE_x], y[TRB_CAGE_y], m->geometry.centre_plane + m->params.cage_offset + y[TRB_CAGE_z]);
  pose->frame = trb_tilted_frame(y[TRB_CAGE_skew], y[TRB_CAGE_tilt]);
  pose->body.n = trb_add(trb_scale(turn_cos, pose->frame.n), trb_scale(turn_sin, pose->frame.t));
  pose->body.t = trb_sub(trb_scale(turn_cos, pose->frame.t), trb_scale(turn_sin, pose->frame.n));
  pose->body.a = pose->frame.a;
  pose->v = trb_v(y[TRB_CAGE_v_x], y[TRB_CAGE_v_y], y[TRB_CAGE_v_z]);
  pose->omega_frame = trb_v(y[TRB_CAGE_omega_n], y[TRB_CAGE_omega_t], drive->frame_speed + y[TRB_CAGE_omega_a]);
  pose->omega = trb_from_frame(&pose->frame, pose->omega_frame);
}

trb_ring_pose trb_ring_pose_in_frame(const trb_ring_pose *ring, double cosine, double sine)
{
  return (trb_ring_pose){trb_turn_z(ring->apex, cosine, -sine), trb_turn_z(ring->axis, cosine, -sine),
                         trb_turn_z(ring->centre, cosine, -sine), trb_turn_z(ring->velocity, cosine, -sine),
                         trb_turn_z(ring->omega, cosine, -sine)};
}
