#include "body/roller.h"

const trb_coordinate trb_roller_coordinates[TRB_ROLLER_SIZE] = {TRB_ROLLER_STATE(TRB_COORDINATE)};

static const trb_vec3 none = {0, 0, 0}, first = {1, 0, 0}, second = {0, 1, 0}, third = {0, 0, 1};

void trb_roller_pose_unpack_centre(const trb_model *m, const trb_drive *drive, int roller, const double *y, trb_roller_pose *pose)
{
  const trb_geometry *g = &m->geometry;
  const trb_rolling   rolling = trb_pure_rolling(m, drive->rolling_speed, drive->carried_speed);
  pose->radius = g->roller_centre_radius + y[TRB_ROLLER_r];
  pose->angle = trb_nominal_angle(m, roller) + y[TRB_ROLLER_psi];
  const trb_angle angle = trb_angle_sum(m->nominal_angle[roller], trb_angle_of(y[TRB_ROLLER_psi]));
  pose->cosine = angle.cosine;
  pose->sine = angle.sine;
  pose->x = trb_v(pose->radius, 0.0, g->roller_centre_height + y[TRB_ROLLER_z]);
  pose->v = trb_v(y[TRB_ROLLER_v_r], rolling.v_t + y[TRB_ROLLER_v_t], y[TRB_ROLLER_v_z]);
}

void trb_roller_pose_unpack(const trb_model *m, const trb_drive *drive, int roller, const double *y, trb_roller_pose *pose)
{
  const trb_rolling rolling = trb_pure_rolling(m, drive->rolling_speed, drive->carried_speed);
  trb_roller_pose_unpack_centre(m, drive, roller, y, pose);
  const trb_angle axis = {m->axis_cosine, m->axis_sine};
  pose->frame = trb_turned_frame(trb_angle_of(y[TRB_ROLLER_skew]), trb_angle_sum(axis, trb_angle_of(y[TRB_ROLLER_tilt])));
  pose->orbit_speed = pose->v.y / pose->radius;
  pose->omega_frame = trb_v(rolling.omega_n + y[TRB_ROLLER_omega_n], y[TRB_ROLLER_omega_t], rolling.omega_a + y[TRB_ROLLER_omega_a]);
  pose->omega = trb_from_frame(&pose->frame, pose->omega_frame);
  if (m->params.effects.planar <= 0.0) return;
  /* frozen tilts: the transverse angular velocity is the orbit's */
  const trb_frame *f = &pose->frame;
  pose->omega_frame.x = pose->orbit_speed * f->n.z;
  pose->omega_frame.y = pose->orbit_speed * f->t.z;
  pose->omega = trb_from_frame(f, pose->omega_frame);
}

/* Planar motion (docs/theory/motion.md#planar-motion): the frozen tilts couple the orbit to the transverse inertia; (m + It s^2/r^2)
 * v_t' from Lagrange's equation of the orbit angle. */
static double orbit_inertia(const trb_geometry *g, const trb_roller_pose *r)
{
  return g->roller_inertia_transverse * r->frame.n.z * r->frame.n.z / (r->radius * r->radius);
}

double trb_roller_orbit_mass(const trb_model *m, const trb_drive *drive, int roller, const double *y)
{
  trb_roller_pose pose;
  if (m->params.effects.planar <= 0.0) return m->geometry.roller_mass;
  trb_roller_pose_unpack(m, drive, roller, y, &pose);
  return m->geometry.roller_mass + orbit_inertia(&m->geometry, &pose);
}

static void freeze_roller(const trb_geometry *g, const trb_roller_pose *r, double v_t_reference_rate, double gravity_t, double *rates)
{
  const double inertia = orbit_inertia(g, r), coriolis = r->v.x * r->v.y / r->radius;
  rates[TRB_ROLLER_v_t] =
      (g->roller_mass * gravity_t - (g->roller_mass - inertia) * coriolis) / (g->roller_mass + inertia) - v_t_reference_rate;
  rates[TRB_ROLLER_z] = rates[TRB_ROLLER_v_z] = rates[TRB_ROLLER_skew] = rates[TRB_ROLLER_tilt] = 0.0;
  rates[TRB_ROLLER_omega_n] = rates[TRB_ROLLER_omega_t] = 0.0;
}

double trb_roller_inertia(const trb_model *m, const trb_drive *drive, const trb_roller_pose *r, double *rates, double *spin)
{
  const trb_geometry  *g = &m->geometry;
  const trb_rolling    rolling_rate = trb_pure_rolling(m, drive->rolling_rate, drive->carried_rate);
  const int            heavy = trb_has_gravity(drive);
  const trb_vec3       fall = heavy ? trb_gravity_in(drive, r->cosine, r->sine) : trb_v(0, 0, 0);
  const trb_turn_rates turn =
      trb_euler(&r->frame, r->omega_frame, r->orbit_speed, g->roller_inertia_transverse, g->roller_inertia_axial, trb_v(0, 0, 0));
  rates[TRB_ROLLER_r] = r->v.x;
  rates[TRB_ROLLER_psi] = r->orbit_speed - drive->frame_speed;
  rates[TRB_ROLLER_z] = r->v.z;
  rates[TRB_ROLLER_skew] = turn.skew;
  rates[TRB_ROLLER_tilt] = turn.tilt;
  rates[TRB_ROLLER_v_r] = fall.x + r->v.y * r->orbit_speed;
  rates[TRB_ROLLER_v_t] = fall.y - r->v.x * r->orbit_speed - rolling_rate.v_t;
  rates[TRB_ROLLER_v_z] = fall.z;
  rates[TRB_ROLLER_omega_n] = turn.spin.x - rolling_rate.omega_n;
  rates[TRB_ROLLER_omega_t] = turn.spin.y;
  rates[TRB_ROLLER_omega_a] = turn.spin.z - rolling_rate.omega_a;
  if (m->params.effects.planar > 0.0) freeze_roller(g, r, rolling_rate.v_t, fall.y, rates);
  const double frame_a = r->orbit_speed * r->frame.a.z + rates[TRB_ROLLER_tilt] * r->frame.a.y;
  *spin = r->omega_frame.z - frame_a + g->roller_spin_ratio * drive->rolling_speed;
  return heavy ? g->roller_mass * trb_dot(fall, r->v) : 0.0;
}

void trb_roller_response(const trb_model *m, const trb_roller_pose *r, const trb_wrench *load, double *rates)
{
  const trb_geometry *g = &m->geometry;
  const trb_vec3      moment = trb_to_frame(&r->frame, load->moment);
  const double        per_mass = 1.0 / g->roller_mass, per_transverse = 1.0 / g->roller_inertia_transverse;
  rates[TRB_ROLLER_v_r] += per_mass * load->force.x;
  rates[TRB_ROLLER_omega_a] += moment.z / g->roller_inertia_axial;
  if (m->params.effects.planar > 0.0) {
    rates[TRB_ROLLER_v_t] += (load->force.y + r->frame.n.z * moment.x / r->radius) / (g->roller_mass + orbit_inertia(g, r));
  } else {
    rates[TRB_ROLLER_v_t] += per_mass * load->force.y;
    rates[TRB_ROLLER_v_z] += per_mass * load->force.z;
    rates[TRB_ROLLER_omega_n] += per_transverse * moment.x;
    rates[TRB_ROLLER_omega_t] += per_transverse * moment.y;
  }
}

trb_rigid trb_roller_motion(const trb_roller_pose *r, int coordinate)
{
  const trb_frame *f = &r->frame;
  switch (coordinate) {
  case TRB_ROLLER_r:
  case TRB_ROLLER_v_r: return (trb_rigid){first, none};
  case TRB_ROLLER_psi: return (trb_rigid){trb_scale(r->radius, second), third};
  case TRB_ROLLER_v_t: return (trb_rigid){second, none};
  case TRB_ROLLER_z:
  case TRB_ROLLER_v_z: return (trb_rigid){third, none};
  case TRB_ROLLER_skew: return (trb_rigid){none, trb_scale(-1.0, f->n)};
  case TRB_ROLLER_tilt: return (trb_rigid){none, second};
  case TRB_ROLLER_omega_n: return (trb_rigid){none, f->n};
  case TRB_ROLLER_omega_t: return (trb_rigid){none, f->t};
  default: return (trb_rigid){none, f->a};
  }
}
