/* How each kind of thing fills its quantities (motion/fields.h). */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "body/cage.h"
#include "body/free_ring.h"
#include "motion/record.h"

#define INFO(name, group, kind, unit, text) {#name, #group, unit, text, 0, TRB_FIELD_##kind, -1},
#define SHOWN(X, kind, as, group, of, at) TRB_FIELDS_OF_##kind(TRB_FIELD_OF, INFO, as, group, at)
#define MEMBER(of, as, group, quantity, kind, unit, text) \
  {#as "_" #quantity, #group, unit, text, offsetof(trb_contact, quantity), TRB_FIELD_##kind, of},
#define CONTACT(X, kind, as, group, of, at) TRB_FIELDS_OF_##kind(MEMBER, of, as, group, at)
const trb_field_info trb_field_table[TRB_N_FIELDS] = {TRB_SHOWN(SHOWN, CONTACT, 0)};

/* Numbers of the quantities of a kind in its list, as RING_tilt. */
#define QUANTITY(X, as, group, quantity, kind, unit, text) as##_##quantity,
enum { TRB_FIELDS_OF_cage(QUANTITY, 0, CAGE, 0, "") };
enum { TRB_FIELDS_OF_roller(QUANTITY, 0, ROLLER, 0, "") };
enum { TRB_FIELDS_OF_pocket(QUANTITY, 0, POCKET, 0, "") };
enum { TRB_FIELDS_OF_ring(QUANTITY, 0, RING, 0, "") };

double trb_audit_kinetic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += trb_roller_kinetic(d->model, &d->rollers[j]);
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    if (body->size > 0 && !body->carried) energy += body->kind->kinetic(d->model, body, &d->bodies[b].pose) + d->bodies[b].pose.moving;
  }
  return energy;
}

double trb_audit_elastic(const trb_dynamics *d)
{
  double energy = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) energy += d->loads[j].elastic;
  for (int b = 0; b < d->system->n_bodies; b++) energy += d->system->bodies[b].carried ? 0.0 : d->bodies[b].pose.stored;
  return energy + d->hub.elastic;
}

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

/* Small rotations that take z to an axis. */
static void put_tilt(double *to, trb_vec3 axis) { to[0] = -atan2(axis.y, axis.z), to[1] = atan2(axis.x, axis.z); }

/* Turn of a free ring beyond what is prescribed, about the bearing's own z. */
static double shaft_offset(const trb_seen *seen, int coordinate)
{
  const trb_dynamics *d = seen->d;
  const trb_body     *ring = &d->system->bodies[d->system->driven];
  const double        sense = d->model->params.inner_ring.turned > 0.0 ? -1.0 : 1.0;
  return ring->kind == &trb_ring_free ? sense * seen->y[ring->first + coordinate] : 0.0;
}

static void show_time(const trb_seen *seen, double *const *to)
{
  *to[0] = seen->time;
  *to[1] = seen->d->drive.shaft_angle + shaft_offset(seen, TRB_FREE_RING_psi);
  *to[2] = seen->d->drive.shaft_speed + shaft_offset(seen, TRB_FREE_RING_omega_a);
}

static void show_cage(const trb_seen *seen, double *const *to)
{
  const trb_dynamics   *d = seen->d;
  const trb_model      *m = d->model;
  const trb_drive      *drive = &d->drive;
  const trb_rigid_pose *c = &d->bodies[seen->of].pose;
  const trb_vec3  plane = trb_v(0, 0, m->geometry.centre_plane), rail = trb_v(0, 0, m->geometry.centre_plane + m->params.cage.rail_offset);
  const trb_vec3  axis = from_r(drive, c->frame.a), centre = from_r(drive, c->x);
  const trb_frame body = {from_r(drive, c->body.n), from_r(drive, c->body.t), axis};
  trb_vec3        force = {0, 0, 0}, moment = {0, 0, 0};
  for (int j = 0; j < m->n_rollers; j++) {
    force = trb_add(force, d->loads[j].on[seen->of].force);
    moment = trb_add(moment, d->loads[j].on[seen->of].moment);
  }
  if (d->work->n_hub > 0) {
    force = trb_add(force, d->hub.on[seen->of].force);
    moment = trb_add(moment, d->hub.on[seen->of].moment);
  }
  put3(to[CAGE_position], trb_sub(trb_axpy(centre, -m->params.cage.offset, axis), plane));
  put3(to[CAGE_rail_position], trb_sub(trb_axpy(centre, m->params.cage.rail_offset - m->params.cage.offset, axis), rail));
  put3(to[CAGE_velocity], from_r(drive, c->v));
  put_quaternion(to[CAGE_orientation], &body);
  put3(to[CAGE_angular_velocity], from_r(drive, c->omega));
  *to[CAGE_angle] = drive->frame_angle + seen->y[d->system->bodies[seen->of].first + TRB_CAGE_psi];
  put_tilt(to[CAGE_tilt], axis);
  put3(to[CAGE_force], from_r(drive, force));
  put3(to[CAGE_moment], from_r(drive, moment));
  const trb_deformed *deformed = d->bodies[seen->of].deformed;
  if (deformed == NULL) return;
  memcpy(to[CAGE_mode], deformed->amplitude, (size_t)deformed->modes->n * sizeof(double));
  memcpy(to[CAGE_mode_rate], deformed->rate, (size_t)deformed->modes->n * sizeof(double));
}

static void show_land(const trb_seen *seen, double *const *to)
{
#define PUT_LAND(X, name, unit, text) **to++ = seen->detail.land.name;
  TRB_LAND_FIELDS(PUT_LAND, 0)
#undef PUT_LAND
}

static void show_roller(const trb_seen *seen, double *const *to)
{
  const trb_dynamics *d = seen->d;
  const trb_drive    *drive = &d->drive;
  for (int j = 0; j < d->model->n_rollers; j++) {
    const double          *y = seen->y + trb_state_roller(d->system, j);
    const trb_roller_pose *r = &d->rollers[j];
    const double           kinematic = -d->model->geometry.roller_spin_ratio * drive->rolling_angle;
    const trb_frame        spinning = spun(&r->frame, kinematic + seen->y[trb_state_spin(d->system) + j]);
    const trb_frame        body = {from_orbit(drive, r, spinning.n), from_orbit(drive, r, spinning.t), from_orbit(drive, r, spinning.a)};
    put3(to[ROLLER_position] + 3 * j, from_orbit(drive, r, r->x));
    put_quaternion(to[ROLLER_orientation] + 4 * j, &body);
    put3(to[ROLLER_velocity] + 3 * j, from_orbit(drive, r, r->v));
    put3(to[ROLLER_angular_velocity] + 3 * j, from_orbit(drive, r, r->omega));
    to[ROLLER_orbit_angle][j] = drive->frame_angle + r->angle;
    to[ROLLER_orbit_speed][j] = r->orbit_speed;
    to[ROLLER_spin_speed][j] = r->omega_frame.z - r->orbit_speed * r->frame.a.z;
    to[ROLLER_skew][j] = y[TRB_ROLLER_skew];
    to[ROLLER_tilt][j] = y[TRB_ROLLER_tilt];
  }
}

static void show_pocket(const trb_seen *seen, double *const *to)
{
  const int    first = seen->d->system->pairs[seen->of].slots;
  const size_t size = (size_t)(seen->d->model->n_rollers * seen->d->model->n_slots) * sizeof(double);
  memcpy(to[POCKET_force], seen->detail.pocket_force + first, size);
  memcpy(to[POCKET_friction], seen->detail.pocket_friction + first, size);
}

/* A ring's displacement and motion in the roller-centre plane, and what rollers and cage do to it about that point. */
static void show_ring(const trb_seen *seen, double *const *to)
{
  const trb_dynamics  *d = seen->d;
  const trb_ring_pose *ring = &d->bodies[seen->of].ring;
  const trb_vec3       nominal = trb_v(0, 0, d->model->geometry.centre_plane);
  trb_wrench           sum = {{0, 0, 0}, {0, 0, 0}};
  for (int j = 0; j < d->model->n_rollers; j++) {
    const trb_wrench *on = &d->loads[j].on[seen->of];
    sum.force = trb_add(sum.force, from_orbit(&d->drive, &d->rollers[j], on->force));
    sum.moment = trb_add(sum.moment, from_orbit(&d->drive, &d->rollers[j], on->moment));
  }
  if (d->work->n_hub > 0) {
    sum.force = trb_add(sum.force, from_r(&d->drive, d->hub.on[seen->of].force));
    sum.moment = trb_add(sum.moment, from_r(&d->drive, d->hub.on[seen->of].moment));
  }
  /* the reference point of the ring that is driven is there, that of another one at the apex */
  const trb_vec3 arm = trb_scale(seen->of == d->system->driven ? 0.0 : d->model->geometry.centre_plane, ring->axis);
  put3(to[RING_position], trb_sub(trb_add(ring->centre, arm), nominal));
  if (seen->of == d->system->driven && d->system->bodies[seen->of].size == 0)
    put3(to[RING_position], d->drive.displacement); /* without rounding */
  put_tilt(to[RING_tilt], ring->axis);
  put3(to[RING_velocity], trb_add(ring->velocity, trb_cross(ring->omega, arm)));
  put3(to[RING_angular_velocity], ring->omega);
  put3(to[RING_force], sum.force);
  put3(to[RING_moment], trb_sub(sum.moment, trb_cross(arm, sum.force)));
}

/* Sense of the rolling set. */
static double sense_of(const trb_dynamics *d) { return d->drive.rolling_speed < 0.0 ? -1.0 : 1.0; }

/* Of rollers and cage on a ring about its axis, against its turn relative to the other ring. */
static void show_friction(const trb_seen *seen, double *const *to)
{
  const trb_dynamics *d = seen->d;
  double              friction = 0.0;
  for (int j = 0; j < d->model->n_rollers; j++) friction += trb_dot(d->loads[j].on[seen->of].moment, d->bodies[seen->of].in_frame[j].axis);
  if (d->work->n_hub > 0) friction += trb_dot(from_r(&d->drive, d->hub.on[seen->of].moment), d->bodies[seen->of].ring.axis);
  *to[0] = (seen->of == d->system->driven ? -sense_of(d) : sense_of(d)) * friction;
}

static void show_share(const trb_seen *seen, double *const *to)
{
  const trb_dynamics *d = seen->d;
  for (int k = 0; k < TRB_N_TORQUES; k++) {
    double torque = 0.0;
    for (int j = 0; j < d->model->n_rollers; j++) torque += d->loads[j].torque[k];
    if (d->work->n_hub > 0) torque += d->hub.torque[k];
    *to[k] = -sense_of(d) * torque;
  }
}

static void show_power(const trb_seen *seen, double *const *to)
{
  const trb_dynamics *d = seen->d;
  double              total = 0.0, within[TRB_N_LOSSES] = {0};
  trb_dynamics_book_bodies(d, within);
  for (int k = 0; k < TRB_N_LOSSES; k++) {
    double power = within[k];
    for (int j = 0; j < d->model->n_rollers; j++) power += d->loads[j].power[k];
    power += d->hub.power[k];
    *to[1 + k] = power;
    total += power;
  }
  *to[0] = total;
}

static void show_energy(const trb_seen *seen, double *const *to)
{
  const trb_dynamics *d = seen->d;
  *to[0] = trb_audit_kinetic(d);
  *to[1] = trb_audit_elastic(d);
  for (int k = 0; k < TRB_N_QUADRATURES; k++)
    *to[2 + k] = k < trb_n_quadratures(d->system) ? seen->y[trb_state_quadrature(d->system) + k] : 0.0;
}

#define ONE(...) +1
#define FILLED(X, kind, as, group, of, at) {show_##kind, of, 0 TRB_FIELDS_OF_##kind(ONE, ONE, as, group, at)},
#define DESCRIBED(X, kind, as, group, of, at) {NULL, of, 0 TRB_FIELDS_OF_##kind(ONE, ONE, as, group, at)},
const trb_shown trb_shown_table[] = {TRB_SHOWN(FILLED, DESCRIBED, 0)};
const int       trb_n_shown = (int)(sizeof trb_shown_table / sizeof trb_shown_table[0]);
