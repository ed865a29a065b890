#include "motion/record.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "body/cage.h"
#include "body/free_ring.h"
#include "contact/pair.h"
#include "motion/audit.h"

const trb_field_info trb_field_table[TRB_N_FIELDS] = {
#define TRB_FIELD_INFO(name, group, kind, unit, text) {#name, #group, TRB_FIELD_##kind, unit, text},
    TRB_FIELDS(TRB_FIELD_INFO)
#undef TRB_FIELD_INFO
};

const char *trb_field_kind_name(trb_field_kind kind)
{
  static const char *const names[] = {"scalar",      "vec2",        "vec3",        "quaternion", "roller",
                                      "roller_vec3", "roller_quat", "pocket_face", "mode"};
  return names[kind];
}

int trb_field_shape(const trb_model *m, trb_field_kind kind, int shape[2])
{
  shape[0] = shape[1] = 1;
  switch (kind) {
  case TRB_FIELD_SCALAR: return 0;
  case TRB_FIELD_VEC2: shape[0] = 2; return 1;
  case TRB_FIELD_VEC3: shape[0] = 3; return 1;
  case TRB_FIELD_QUATERNION: shape[0] = 4; return 1;
  case TRB_FIELD_ROLLER: shape[0] = m->n_rollers; return 1;
  case TRB_FIELD_ROLLER_VEC3:
    shape[0] = m->n_rollers;
    shape[1] = 3;
    return 2;
  case TRB_FIELD_ROLLER_QUAT:
    shape[0] = m->n_rollers;
    shape[1] = 4;
    return 2;
  case TRB_FIELD_POCKET_FACE:
    shape[0] = m->n_rollers;
    shape[1] = m->n_slots;
    return 2;
  case TRB_FIELD_MODE: shape[0] = m->modes.n; return 1;
  }
  return 0;
}

int trb_record_offset(const trb_model *m, int field)
{
  int offset = 0, shape[2];
  for (int i = 0; i < field; i++) {
    (void)trb_field_shape(m, trb_field_table[i].kind, shape);
    offset += shape[0] * shape[1];
  }
  return offset;
}

/* Where each field of this record goes. */
typedef struct writer {
  trb_dynamics *d;
  trb_detail    seen; /* what records need, in the arrays of a detail: neither the nodes of raceways nor the gaps of pockets */
  double       *at[TRB_N_FIELDS];
} writer;

#define PUT(name, index) w->at[TRB_FIELD_AT_##name][index]

static void put3(double *to, trb_vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/* R -> inertial, orbiting frame -> inertial. */
static trb_vec3 from_r(const trb_drive *drive, trb_vec3 v) { return trb_turn_z(v, drive->cosine, drive->sine); }
static trb_vec3 from_orbit(const trb_drive *drive, const trb_roller_pose *r, trb_vec3 v)
{
  return from_r(drive, trb_turn_z(v, r->cosine, r->sine));
}

/* Quaternion of a rotation whose columns are the frame's axes (Shepperd), w >= 0. */
static void put_quaternion(double *to, const trb_frame *f)
{
  const double m[3][3] = {{f->n.x, f->t.x, f->a.x}, {f->n.y, f->t.y, f->a.y}, {f->n.z, f->t.z, f->a.z}};
  const double trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0.0) {
    const double s = 2.0 * sqrt(1.0 + trace);
    to[0] = 0.25 * s, to[1] = (m[2][1] - m[1][2]) / s, to[2] = (m[0][2] - m[2][0]) / s, to[3] = (m[1][0] - m[0][1]) / s;
    return;
  }
  const int    i = m[0][0] >= m[1][1] && m[0][0] >= m[2][2] ? 0 : (m[1][1] >= m[2][2] ? 1 : 2), j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = 2.0 * sqrt(fmax(1.0 + m[i][i] - m[j][j] - m[k][k], 0.0)), sign = m[k][j] - m[j][k] < 0.0 ? -1.0 : 1.0;
  to[0] = sign * (m[k][j] - m[j][k]) / s;
  to[1 + i] = sign * 0.25 * s, to[1 + j] = sign * (m[j][i] + m[i][j]) / s, to[1 + k] = sign * (m[k][i] + m[i][k]) / s;
}

/* A frame that is turned about its third axis. */
static trb_frame spun(const trb_frame *f, double angle)
{
  const double c = cos(angle), s = sin(angle);
  return (trb_frame){trb_add(trb_scale(c, f->n), trb_scale(s, f->t)), trb_sub(trb_scale(c, f->t), trb_scale(s, f->n)), f->a};
}

static void put_cage(writer *w, const double *y)
{
  const trb_dynamics   *d = w->d;
  const trb_model      *m = d->model;
  const trb_drive      *drive = &d->drive;
  const trb_rigid_pose *c = &d->bodies[TRB_BODY_CAGE].pose;
  const trb_vec3  plane = trb_v(0, 0, m->geometry.centre_plane), rail = trb_v(0, 0, m->geometry.centre_plane + m->params.cage_rail_offset);
  const trb_vec3  axis = from_r(drive, c->frame.a), centre = from_r(drive, c->x);
  const trb_frame body = {from_r(drive, c->body.n), from_r(drive, c->body.t), axis};
  trb_vec3        force = {0, 0, 0}, moment = {0, 0, 0};
  for (int j = 0; j < m->n_rollers; j++) {
    force = trb_add(force, d->loads[j].on[TRB_BODY_CAGE].force);
    moment = trb_add(moment, d->loads[j].on[TRB_BODY_CAGE].moment);
  }
  if (d->work->n_hub > 0) {
    force = trb_add(force, d->hub.on[TRB_BODY_CAGE].force);
    moment = trb_add(moment, d->hub.on[TRB_BODY_CAGE].moment);
  }
  put3(&PUT(cage_position, 0), trb_sub(trb_axpy(centre, -m->params.cage_offset, axis), plane));
  put3(&PUT(cage_rail_position, 0), trb_sub(trb_axpy(centre, m->params.cage_rail_offset - m->params.cage_offset, axis), rail));
  put3(&PUT(cage_velocity, 0), from_r(drive, c->v));
  put_quaternion(&PUT(cage_orientation, 0), &body);
  put3(&PUT(cage_angular_velocity, 0), from_r(drive, c->omega));
  PUT(cage_angle, 0) = drive->frame_angle + y[TRB_CAGE_psi];
  /* small rotations that take z to the axis */
  PUT(cage_tilt, 0) = -atan2(axis.y, axis.z);
  PUT(cage_tilt, 1) = atan2(axis.x, axis.z);
  put3(&PUT(cage_force, 0), from_r(drive, force));
  put3(&PUT(cage_moment, 0), from_r(drive, moment));
}

static void put_modes(writer *w)
{
  const trb_deformed *deformed = w->d->bodies[TRB_BODY_CAGE].deformed;
  if (deformed == NULL) return;
  const size_t size = (size_t)deformed->modes->n * sizeof(double);
  memcpy(&PUT(cage_mode, 0), deformed->amplitude, size);
  memcpy(&PUT(cage_mode_rate, 0), deformed->rate, size);
}

static void put_roller(writer *w, int j, const double *y, double spin_offset)
{
  const trb_dynamics    *d = w->d;
  const trb_drive       *drive = &d->drive;
  const trb_roller_pose *r = &d->rollers[j];
  const double           kinematic = -d->model->geometry.roller_spin_ratio * drive->rolling_angle;
  const trb_frame        spinning = spun(&r->frame, kinematic + spin_offset);
  const trb_frame        body = {from_orbit(drive, r, spinning.n), from_orbit(drive, r, spinning.t), from_orbit(drive, r, spinning.a)};
  put3(&PUT(roller_position, 3 * j), from_orbit(drive, r, r->x));
  put_quaternion(&PUT(roller_orientation, 4 * j), &body);
  put3(&PUT(roller_velocity, 3 * j), from_orbit(drive, r, r->v));
  put3(&PUT(roller_angular_velocity, 3 * j), from_orbit(drive, r, r->omega));
  PUT(roller_orbit_angle, j) = drive->frame_angle + r->angle;
  PUT(roller_orbit_speed, j) = r->orbit_speed;
  PUT(roller_spin_speed, j) = r->omega_frame.z - r->orbit_speed * r->frame.a.z;
  PUT(roller_skew, j) = y[TRB_ROLLER_skew];
  PUT(roller_tilt, j) = y[TRB_ROLLER_tilt];
}

/* Where each quantity of a contact is, and goes in a record. */
static const struct {
  size_t from;
  int    pair;
  int    field;
} contact_fields[] = {
#define ROW(X, pair, quantity, unit, text) {offsetof(trb_contact, quantity), TRB_PAIR_##pair, TRB_FIELD_AT_##pair##_##quantity},
    TRB_CONTACT_FIELDS(ROW, 0) TRB_OUTER_RIB_FIELDS(ROW, 0)
#undef ROW
};

static void put_contacts(writer *w, int j)
{
  for (size_t i = 0; i < sizeof contact_fields / sizeof contact_fields[0]; i++) {
    const int pair = contact_fields[i].pair, there = pair < w->d->system->n_pairs;
    double   *to = &w->at[contact_fields[i].field][j];
    *to = 0.0;
    if (!there) continue;
    const trb_contact *contact = &trb_pair_contacts(w->d->model, &w->d->system->pairs[pair], &w->seen)[j];
    *to = *(const double *)((const char *)contact + contact_fields[i].from);
  }
}

/* Of the cage on the land of a ring. */
static void put_land(writer *w)
{
#define PUT_LAND(X, name, unit, text) PUT(land_##name, 0) = w->seen.land.name;
  TRB_LAND_FIELDS(PUT_LAND, 0)
#undef PUT_LAND
}

/* Fields of the lists of bearing/losses.h. */
#define TORQUE(X, name, text) TRB_FIELD_AT_inner_torque_##name,
#define POWER(X, name, sense, is_on, text) TRB_FIELD_AT_power_##name,
#define QUADRATURE(name) TRB_FIELD_AT_##name,
static const int torque_fields[] = {TRB_TORQUES(TORQUE, 0)};
static const int power_fields[] = {TRB_LOSSES(POWER, 0)};
static const int quadrature_fields[] = {TRB_QUADRATURES(QUADRATURE)};
#undef TORQUE
#undef POWER
#undef QUADRATURE

/* Where fields of a ring go. */
typedef struct ring_fields {
  int position, tilt, velocity, omega, force, moment;
} ring_fields;

static const ring_fields of_inner = {TRB_FIELD_AT_ring_position,         TRB_FIELD_AT_ring_tilt,  TRB_FIELD_AT_ring_velocity,
                                     TRB_FIELD_AT_ring_angular_velocity, TRB_FIELD_AT_ring_force, TRB_FIELD_AT_ring_moment};
static const ring_fields of_outer = {TRB_FIELD_AT_housing_position,         TRB_FIELD_AT_housing_tilt,  TRB_FIELD_AT_housing_velocity,
                                     TRB_FIELD_AT_housing_angular_velocity, TRB_FIELD_AT_housing_force, TRB_FIELD_AT_housing_moment};

/* A ring's displacement and motion in the roller-centre plane, and its loads about that point; `along` leads there on its axis. */
static void put_ring_fields(writer *w, const ring_fields *at, const trb_ring_pose *ring, double along, const trb_wrench *load)
{
  const trb_vec3 arm = trb_scale(along, ring->axis);
  const trb_vec3 nominal = trb_v(0, 0, w->d->model->geometry.centre_plane);
  put3(w->at[at->position], trb_sub(trb_add(ring->centre, arm), nominal));
  put3(w->at[at->velocity], trb_add(ring->velocity, trb_cross(ring->omega, arm)));
  put3(w->at[at->omega], ring->omega);
  /* small rotations that take z to the axis */
  w->at[at->tilt][0] = -atan2(ring->axis.y, ring->axis.z);
  w->at[at->tilt][1] = atan2(ring->axis.x, ring->axis.z);
  put3(w->at[at->force], load->force);
  put3(w->at[at->moment], trb_sub(load->moment, trb_cross(arm, load->force)));
}

/* What rollers and cage do to a ring, about its reference point; friction: the moment about its axis. */
static trb_wrench load_on_ring(const trb_dynamics *d, int body, double *friction)
{
  trb_wrench sum = {{0, 0, 0}, {0, 0, 0}};
  *friction = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) {
    const trb_wrench *on = &d->loads[j].on[body];
    sum.force = trb_add(sum.force, from_orbit(&d->drive, &d->rollers[j], on->force));
    sum.moment = trb_add(sum.moment, from_orbit(&d->drive, &d->rollers[j], on->moment));
    *friction += trb_dot(on->moment, d->bodies[body].in_frame[j].axis);
  }
  if (d->work->n_hub == 0) return sum;
  const trb_wrench *on = &d->hub.on[body];
  const trb_vec3    moment = from_r(&d->drive, on->moment);
  sum.force = trb_add(sum.force, from_r(&d->drive, on->force));
  sum.moment = trb_add(sum.moment, moment);
  *friction += trb_dot(moment, d->bodies[body].ring.axis);
  return sum;
}

static void put_rings(writer *w)
{
  const trb_dynamics *d = w->d;
  const trb_model    *m = d->model;
  double              torque[TRB_N_TORQUES] = {0}, on_inner, on_outer;
  const trb_wrench    inner = load_on_ring(d, TRB_BODY_INNER_RING, &on_inner), outer = load_on_ring(d, TRB_BODY_OUTER_RING, &on_outer);
  put_ring_fields(w, &of_inner, &d->bodies[TRB_BODY_INNER_RING].ring, 0.0, &inner);
  if (d->system->bodies[TRB_BODY_INNER_RING].size == 0) put3(&PUT(ring_position, 0), d->drive.displacement);
  put_ring_fields(w, &of_outer, &d->bodies[TRB_BODY_OUTER_RING].ring, m->geometry.centre_plane, &outer);
  for (int j = 0; j < m->n_rollers; j++)
    for (int k = 0; k < TRB_N_TORQUES; k++) torque[k] += d->loads[j].torque[k];
  for (int k = 0; k < TRB_N_TORQUES && d->work->n_hub > 0; k++) torque[k] += d->hub.torque[k];
  const double sign = d->drive.rolling_speed < 0.0 ? -1.0 : 1.0;
  PUT(inner_torque, 0) = -sign * on_inner;
  PUT(outer_torque, 0) = sign * on_outer;
  for (int k = 0; k < TRB_N_TORQUES; k++) w->at[torque_fields[k]][0] = -sign * torque[k];
}

static void put_energy(writer *w, const double *quadratures)
{
  const trb_dynamics *d = w->d;
  double              total = 0.0, within[TRB_N_LOSSES] = {0};
  trb_dynamics_book_bodies(d, within);
  for (int k = 0; k < TRB_N_LOSSES; k++) {
    double power = within[k];
    for (int j = 0; j < d->model->n_rollers; j++) power += d->loads[j].power[k];
    power += d->hub.power[k];
    w->at[power_fields[k]][0] = power;
    total += power;
  }
  PUT(power_loss, 0) = total;
  PUT(kinetic_energy, 0) = trb_audit_kinetic(d);
  PUT(elastic_energy, 0) = trb_audit_elastic(d);
  for (int k = 0; k < TRB_N_QUADRATURES; k++) w->at[quadrature_fields[k]][0] = k < trb_n_quadratures(d->system) ? quadratures[k] : 0.0;
}

/* Turn of a free ring beyond what is prescribed, about the bearing's own z. */
static double shaft_offset(const trb_dynamics *d, const double *y, int coordinate)
{
  const trb_body *ring = &d->system->bodies[d->system->driven];
  const double    sense = d->model->params.ring_turned > 0.0 ? -1.0 : 1.0;
  return ring->kind == &trb_ring_free ? sense * y[ring->first + coordinate] : 0.0;
}

void trb_record_fill(trb_dynamics *d, const unsigned *apart, double time, const double *y, trb_detail *detail, double *record)
{
  const trb_model *m = d->model;
  writer           it = {.d = d, .seen = *detail}, *w = &it;
  int              offset = 0, shape[2];
  for (int i = 0; i < TRB_N_FIELDS; i++) {
    w->at[i] = record + offset;
    (void)trb_field_shape(m, trb_field_table[i].kind, shape);
    offset += shape[0] * shape[1];
  }
  it.seen.lanes = it.seen.pocket_interference = NULL;
  trb_dynamics_pose(d, time, y);
  trb_detail_clear(m, &it.seen);
  const trb_counters keep = d->work->counters;
  trb_dynamics_loads_of(d, apart, &it.seen);
  d->work->counters = keep; /* looking is not integrating */
  PUT(time, 0) = time;
  PUT(shaft_angle, 0) = d->drive.shaft_angle + shaft_offset(d, y, TRB_FREE_RING_psi);
  PUT(shaft_speed, 0) = d->drive.shaft_speed + shaft_offset(d, y, TRB_FREE_RING_omega_a);
  put_cage(w, y + d->system->bodies[TRB_BODY_CAGE].first);
  put_modes(w);
  put_land(w);
  for (int j = 0; j < m->n_rollers; j++) {
    put_roller(w, j, y + trb_state_roller(d->system, j), y[d->spin_at + j]);
    put_contacts(w, j);
  }
  memcpy(&PUT(pocket_force, 0), it.seen.pocket_force, (size_t)(m->n_rollers * m->n_slots) * sizeof(double));
  memcpy(&PUT(pocket_friction, 0), it.seen.pocket_friction, (size_t)(m->n_rollers * m->n_slots) * sizeof(double));
  put_rings(w);
  put_energy(w, y + d->quadrature);
}
