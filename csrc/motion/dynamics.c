#include "motion/dynamics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/kernels.h"
#include "contact/uneven.h"
#include "motion/spacer.h"

void trb_dynamics_place(trb_dynamics *d)
{
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body_kind *kind = d->system->bodies[b].kind;
    if (kind->place != NULL) kind->place(d->model, &d->drive, &d->bodies[b].ring);
  }
}

/* Generalised forces on bodies that deform are summed from zero. */
static void clear_forces(const trb_dynamics *d)
{
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_deformed *to = d->bodies[b].deformed;
    if (to != NULL) memset(to->force, 0, (size_t)to->modes->n * sizeof *to->force);
  }
}

trb_ring_pose trb_dynamics_ring_seen(const trb_dynamics *d, int body, const trb_roller_pose *roller)
{
  const trb_drive *drive = &d->drive;
  const double     cosine = drive->cosine * roller->cosine - drive->sine * roller->sine;
  const double     sine = drive->sine * roller->cosine + drive->cosine * roller->sine;
  return trb_ring_pose_in_frame(&d->bodies[body].ring, cosine, sine);
}

void trb_dynamics_pose_roller(trb_dynamics *d, int roller, const double *y)
{
  trb_roller_pose *r = &d->rollers[roller];
  trb_roller_pose_unpack(d->model, &d->drive, roller, y, r);
  for (int b = 0; b < d->system->n_bodies; b++) {
    trb_body_at *body = &d->bodies[b];
    if (body->in_frame != NULL && !body->rests) body->in_frame[roller] = trb_dynamics_ring_seen(d, b, r);
  }
}

int trb_dynamics_spin_roller(trb_dynamics *d, int roller, const double *y)
{
  const trb_model *m = d->model;
  if (d->spin == NULL) return 0;
  d->spin[roller] = y[d->spin_at + roller] - m->geometry.roller_spin_ratio * d->drive.rolling_angle;
  const double azimuth = d->drive.frame_angle + trb_nominal_angle(m, roller) + y[trb_state_roller(d->system, roller) + TRB_ROLLER_psi];
  for (int i = 0; i < d->work->n_batches; i++)
    for (int k = 0; k < d->work->batches[i].n; k++) {
      const trb_pair *pair = d->work->batches[i].pairs[k];
      if (pair->kind->uneven != NULL && pair->kind->uneven(m, pair, roller, azimuth, d->bodies[pair->b].ring.angle, d->spin[roller]))
        return 1;
    }
  return 0;
}

/* Steps over the shortest length in which a depth changes. */
enum { STEPS_A_CHANGE = 8 };

double trb_dynamics_longest_step(const trb_dynamics *d)
{
  double shortest = INFINITY;
  for (int i = 0; d->spin != NULL && i < d->work->n_batches; i++)
    for (int k = 0; k < d->work->batches[i].n; k++) {
      const trb_pair      *pair = d->work->batches[i].pairs[k];
      const trb_ring_pose *ring = &d->bodies[pair->b].ring;
      if (pair->kind->uneven == NULL) continue;
      shortest = fmin(shortest, pair->kind->change(d->model, pair, fabs(trb_dot(ring->omega, ring->axis) - d->drive.frame_speed)));
    }
  return shortest / STEPS_A_CHANGE;
}

void trb_dynamics_drive(trb_dynamics *d, double time)
{
  trb_motion_at(d->motion, d->model, time, &d->drive);
  trb_dynamics_place(d);
}

void trb_dynamics_pose_body(trb_dynamics *d, int body, const double *y_body)
{
  trb_body_pose(d->model, &d->system->bodies[body], &d->drive, y_body, &d->bodies[body]);
}

void trb_dynamics_pose_hub(trb_dynamics *d, const double *y)
{
  for (int b = 0; b < d->system->n_bodies; b++)
    if (d->system->bodies[b].size > 0) trb_dynamics_pose_body(d, b, y + d->system->bodies[b].first);
}

const double *trb_dynamics_held(trb_dynamics *d, double time, const double *y)
{
  if (d->held == NULL) return y;
  memcpy(d->held, y, (size_t)trb_state_size(d->system) * sizeof *y);
  trb_dynamics_drive(d, time);
  trb_spacer_hold(d->system, &d->drive, d->held);
  return d->held;
}

void trb_dynamics_pose(trb_dynamics *d, double time, const double *y)
{
  trb_dynamics_drive(d, time);
  y = trb_dynamics_held(d, time, y);
  trb_dynamics_pose_hub(d, y);
  for (int j = 0; j < d->model->n_rollers; j++) {
    trb_dynamics_pose_roller(d, j, y + trb_state_roller(d->system, j));
    (void)trb_dynamics_spin_roller(d, j, y);
  }
}

trb_instant trb_dynamics_instant(const trb_dynamics *d)
{
  return (trb_instant){&d->drive, d->rollers, d->bodies, d->everyone, d->model->n_rollers, NULL, NULL};
}

void trb_dynamics_loads(trb_dynamics *d, trb_detail *detail) { trb_dynamics_loads_of(d, NULL, detail); }

void trb_dynamics_loads_of(trb_dynamics *d, const unsigned *apart, trb_detail *detail)
{
  trb_instant at = trb_dynamics_instant(d);
  at.apart = apart;
  at.spin = d->spin;
  clear_forces(d);
  trb_contact_all(d->model, &at, d->work, d->loads, detail);
  trb_contact_hub(d->model, &at, d->work, &d->hub, detail);
}

/* Books what a body's drive puts in against a wrench; pose and wrench in the same frame. */
static void add_work(const trb_dynamics *d, int body, const trb_ring_pose *pose, const trb_loads *loads, double *quadratures)
{
  const trb_drive_power power = d->system->bodies[body].kind->power(pose, &d->drive, &loads->on[body]);
  quadratures[TRB_Q_work_shaft] += power.shaft;
  quadratures[TRB_Q_work_ring] += power.place;
}

void trb_dynamics_roller_flow(const trb_dynamics *d, int roller, const trb_loads *loads, double *flow)
{
  const trb_roller_pose *r = &d->rollers[roller];
  double                *quadratures = flow + TRB_FLOW_quadrature;
  memset(quadratures, 0, TRB_FLOW_N_QUADRATURES * sizeof *flow);
  quadratures[TRB_Q_work_gravity] = trb_roller_inertia(d->model, &d->drive, r, flow, &flow[TRB_FLOW_spin]);
  d->work->counters.gravity_bodies += trb_has_gravity(&d->drive);
  trb_roller_response(d->model, r, &loads->roller, flow);
  for (int k = 0; k < TRB_N_ROLLER_LOSSES; k++) quadratures[TRB_Q_losses + k] += loads->power[k];
  for (int b = 0; b < d->system->n_bodies; b++)
    if (d->system->bodies[b].kind->power != NULL) add_work(d, b, &d->bodies[b].in_frame[roller], loads, quadratures);
}

void trb_dynamics_roller_reactions(const trb_dynamics *d, int roller, const trb_loads *loads, trb_wrench *reactions)
{
  const trb_roller_pose *r = &d->rollers[roller];
  for (int k = 0; k < d->system->n_moving; k++) {
    const trb_wrench *on = &loads->on[d->system->moving[k]];
    reactions[k] = (trb_wrench){trb_turn_z(on->force, r->cosine, r->sine), trb_turn_z(on->moment, r->cosine, r->sine)};
  }
}

void trb_dynamics_add_reactions(trb_dynamics *d, int roller)
{
  for (int k = 0; k < d->system->n_moving; k++) trb_add_wrench(&d->on_body[d->system->moving[k]], &trb_dynamics_reactions(d, roller)[k]);
}

void trb_dynamics_start(trb_dynamics *d, double *rates)
{
  const trb_model *m = d->model;
  double          *q = rates + d->quadrature;
  memset(q, 0, (size_t)trb_n_quadratures(d->system) * sizeof *q);
  memset(d->on_body, 0, sizeof d->on_body);
  clear_forces(d);
  for (int b = 0; b < d->system->n_bodies && trb_has_gravity(&d->drive); b++) {
    const trb_body *body = &d->system->bodies[b];
    const double    mass = body->size > 0 && !body->carried ? body->kind->mass(m, body) : 0.0;
    if (mass <= 0.0) continue;
    d->work->counters.gravity_bodies++;
    q[TRB_Q_work_gravity] += mass * trb_dot(trb_gravity_in(&d->drive, 1.0, 0.0), d->bodies[b].pose.v);
  }
}

void trb_dynamics_put(const trb_dynamics *d, int roller, const double *flow, double *rates)
{
  const int all = trb_n_quadratures(d->system), n = all < TRB_FLOW_N_QUADRATURES ? all : TRB_FLOW_N_QUADRATURES;
  double   *q = rates + d->quadrature;
  memcpy(rates + trb_state_roller(d->system, roller), flow, TRB_ROLLER_SIZE * sizeof *flow);
  rates[d->spin_at + roller] = flow[TRB_FLOW_spin];
  for (int k = 0; k < n; k++) q[k] += flow[TRB_FLOW_quadrature + k];
}

void trb_dynamics_book_bodies(const trb_dynamics *d, double *losses)
{
  for (int b = 0; b < d->system->n_bodies; b++)
    if (d->system->bodies[b].loss != 0 && !d->system->bodies[b].carried) losses[d->system->bodies[b].loss - 1] += d->bodies[b].pose.lost;
}

void trb_dynamics_add_hub(trb_dynamics *d, double *rates)
{
  const trb_instant at = trb_dynamics_instant(d);
  double           *q = rates + d->quadrature;
  if (d->work->n_hub == 0) return;
  trb_contact_hub(d->model, &at, d->work, &d->hub, NULL);
  for (int k = 0; k < d->model->n_losses; k++) q[TRB_Q_losses + k] += d->hub.power[k];
  for (int b = 0; b < d->system->n_bodies; b++) {
    trb_add_wrench(&d->on_body[b], &d->hub.on[b]);
    if (d->system->bodies[b].kind->power == NULL) continue;
    const trb_ring_pose pose = trb_body_in(&d->bodies[b], d->drive.cosine, d->drive.sine);
    add_work(d, b, &pose, &d->hub, q);
  }
}

static const trb_wrench no_load = {{0, 0, 0}, {0, 0, 0}};

void trb_dynamics_body_rates(const trb_dynamics *d, int body, const double *y, const trb_wrench *load, double *rates)
{
  const trb_body       *is = &d->system->bodies[body];
  const trb_rigid_pose *pose = &d->bodies[body].pose;
  double                alone[TRB_MOST_CARRIED];
  is->kind->rates(d->model, is, &d->drive, pose, y + is->first, load, rates);
  if (!is->carried) return;
  is->kind->rates(d->model, is, &d->drive, pose, y + is->first, &no_load, alone);
  for (int i = 0; i < is->size; i++) rates[i] -= alone[i];
}

/* Books the work that passes between a bearing and the shaft that carries its ring: what the contacts do to the ring is taken from the
 * bearing and given to the system that has the shaft. What they take from the turning ring the drive puts in again, where it keeps the speed.
 * So the energies of each bearing add up by themselves. */
static void add_passed(const trb_dynamics *d, int b, const double *y, double *rates)
{
  const trb_body       *body = &d->system->bodies[b];
  const trb_ring_pose  *ring = &d->bodies[b].ring;
  const trb_drive      *drive = &d->drive;
  const trb_vec3        force = trb_turn_z(d->on_body[b].force, drive->cosine, drive->sine);
  const trb_vec3        moment = trb_turn_z(d->on_body[b].moment, drive->cosine, drive->sine);
  const double          all = trb_dot(force, ring->velocity) + trb_dot(moment, ring->omega);
  const double          turning = trb_dot(moment, ring->axis) * trb_dot(ring->omega, ring->axis);
  const trb_drive_power with = body->kind->work(d->model, body, drive, y + body->first, &d->on_body[b]);
  const trb_drive_power without = body->kind->work(d->model, body, drive, y + body->first, &no_load);
  rates[d->quadrature + TRB_Q_work_shaft] -= turning;
  rates[d->quadrature + TRB_Q_work_ring] -= all - turning;
  rates[body->carrier_quadrature + TRB_Q_work_ring] += all + (with.shaft - without.shaft);
}

void trb_dynamics_put_hub(const trb_dynamics *d, const double *y, double *rates)
{
  trb_dynamics_book_bodies(d, rates + d->quadrature + TRB_Q_losses);
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    double         *own = rates + body->first;
    if (body->size == 0) continue;
    if (body->carried) {
      double added[TRB_MOST_CARRIED] = {0};
      trb_dynamics_body_rates(d, b, y, &d->on_body[b], added);
      for (int i = 0; i < body->size; i++) own[i] += added[i];
      add_passed(d, b, y, rates);
      continue;
    }
    trb_dynamics_body_rates(d, b, y, &d->on_body[b], own);
    if (d->bodies[b].deformed != NULL) body->kind->pushed(body, d->bodies[b].deformed->force, own);
    if (body->kind->work != NULL) {
      const trb_drive_power power = body->kind->work(d->model, body, &d->drive, y + body->first, &d->on_body[b]);
      rates[d->quadrature + TRB_Q_work_shaft] += power.shaft;
      rates[d->quadrature + TRB_Q_work_ring] += power.place;
    }
  }
}
