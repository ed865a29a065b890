#include "body/elastic_cage.h"

static int place_of(int mode) { return TRB_CAGE_SIZE + 2 * mode; }

static int amplitude_of(const trb_body *body, int mode, double per[2])
{
  per[0] = body->modes->per[mode];
  per[1] = body->modes->share[mode];
  return place_of(mode);
}

static void pose_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose)
{
  const trb_modes *modes = body->modes;
  trb_cage_pose(m, body, drive, y, pose);
  pose->moving = pose->stored = pose->lost = 0.0;
  for (int i = 0; i < modes->n; i++) {
    const double per = modes->share[i], stretch = per * y[place_of(i)], rate = per * y[place_of(i) + 1];
    pose->moving += 0.5 * modes->mass[i] * rate * rate;
    pose->stored += 0.5 * modes->mass[i] * stretch * stretch;
    pose->lost += modes->mass[i] * modes->damping[i] * rate * rate;
  }
}

static void pushed(const trb_body *body, const double *force, double *rates)
{
  const trb_modes *modes = body->modes;
  for (int i = 0; i < modes->n; i++) rates[place_of(i) + 1] += force[i] * modes->yield[i];
}

/* Coriolis force on a mode over the angular velocity. */
static double coriolis(const trb_modes *modes, int mode, const double *y)
{
  double force = 0.0;
  for (int c = modes->first_coriolis[mode]; c < modes->first_coriolis[mode + 1]; c++) {
    const int by = modes->coriolis[c].by;
    force += modes->coriolis[c].force * modes->share[by] * y[place_of(by) + 1];
  }
  return force;
}

static void rates_of(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *c, const double *y,
                     const trb_wrench *load, double *rates)
{
  const trb_modes *modes = body->modes;
  trb_cage_rates(m, body, drive, c, y, load, rates);
  for (int i = 0; i < modes->n; i++) {
    const int at = place_of(i);
    rates[at] = modes->frequency[i] * y[at + 1];
    rates[at + 1] = -modes->frequency[i] * y[at] - modes->damping[i] * y[at + 1];
    rates[at + 1] += coriolis(modes, i, y) * c->omega_frame.z * modes->yield[i];
  }
}

/* Coriolis forces by a mode are minus those on it. */
static void slopes_of(const trb_body *body, const trb_rigid_pose *pose, int coordinate, double *rates)
{
  const trb_modes *modes = body->modes;
  const int        mode = (coordinate - TRB_CAGE_SIZE) / 2, at = place_of(mode);
  if (coordinate == at) {
    rates[at + 1] -= modes->frequency[mode];
    return;
  }
  rates[at] += modes->frequency[mode];
  rates[at + 1] -= modes->damping[mode];
  for (int c = modes->first_coriolis[mode]; c < modes->first_coriolis[mode + 1]; c++) {
    const int on = modes->coriolis[c].by;
    rates[place_of(on) + 1] -= modes->coriolis[c].force * modes->share[mode] * pose->omega_frame.z * modes->yield[on];
  }
}

static void deform(const trb_body *body, const double *y, trb_deformed *deformed)
{
  for (int i = 0; i < body->modes->n; i++) {
    double        per[2];
    const double *at = y + amplitude_of(body, i, per);
    deformed->amplitude[i] = per[0] * at[0];
    deformed->rate[i] = per[1] * at[1];
  }
}

/* Rigid motion that belongs to a rate of a coordinate: that of the mean axes; amplitudes of modes have none. */
static trb_rigid motion_of(const trb_rigid_pose *pose, int coordinate)
{
  if (coordinate < TRB_CAGE_SIZE) return trb_cage_motion(pose, coordinate);
  return (trb_rigid){{0, 0, 0}, {0, 0, 0}};
}

#define MODE(number) \
  {"q" #number, TRB_TOL_VELOCITY, "amplitude of mode " #number " times its angular frequency or 17000 rad/s, the larger one, m/s"}, \
      {"p" #number, TRB_TOL_VELOCITY, "rate of its amplitude times the same over its angular frequency, m/s"},
#define TEN(t) MODE(t##0) MODE(t##1) MODE(t##2) MODE(t##3) MODE(t##4) MODE(t##5) MODE(t##6) MODE(t##7) MODE(t##8) MODE(t##9)
static const trb_coordinate coordinates[TRB_CAGE_SIZE + 2 * TRB_MOST_MODES] = {TRB_CAGE_STATE(TRB_COORDINATE) TEN() TEN(1) TEN(2) TEN(3)
                                                                                   TEN(4) TEN(5) TEN(6) TEN(7) TEN(8) TEN(9)};
#undef MODE
#undef TEN

const trb_body_kind trb_body_elastic_cage = {.name = "elastic cage",
                                             .skew = TRB_CAGE_skew,
                                             .loses = 1,
                                             .pose = pose_of,
                                             .rates = rates_of,
                                             .motion = motion_of,
                                             .mass = trb_cage_mass,
                                             .kinetic = trb_cage_kinetic,
                                             .deform = deform,
                                             .pushed = pushed,
                                             .amplitude = amplitude_of,
                                             .slopes = slopes_of};

trb_body trb_elastic_cage_of(const trb_modes *modes, const char *name)
{
  return (trb_body){
      .kind = &trb_body_elastic_cage, .name = name, .size = TRB_CAGE_SIZE + 2 * modes->n, .coordinates = coordinates, .modes = modes};
}
