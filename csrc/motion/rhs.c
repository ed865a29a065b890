#include "motion/rhs.h"

#include <math.h>
#include <string.h>

#include "motion/fast_pairs.h"
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
  d->spin[roller] = y[trb_state_spin(d->system) + roller] - m->geometry.roller_spin_ratio * d->drive.rolling_angle;
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

void trb_dynamics_pose_of(trb_dynamics *d, double time, const double *y, const int *chosen, int n)
{
  trb_dynamics_drive(d, time);
  trb_dynamics_pose_hub(d, y);
  for (int k = 0; k < n; k++) {
    trb_dynamics_pose_roller(d, chosen[k], y + trb_state_roller(d->system, chosen[k]));
    (void)trb_dynamics_spin_roller(d, chosen[k], y);
  }
}

void trb_dynamics_pose(trb_dynamics *d, double time, const double *y)
{
  trb_dynamics_pose_of(d, time, trb_dynamics_held(d, time, y), d->everyone, d->model->n_rollers);
}

static void clear_loads(const trb_instant *at, trb_loads *loads)
{
  for (int k = 0; k < at->n; k++) {
    memset(&loads[at->chosen[k]], 0, sizeof *loads);
    for (int i = 0; i < TRB_MOST_PAIRS; i++) loads[at->chosen[k]].margin[i] = TRB_NO_CONTACT;
  }
}

void trb_dynamics_slow(trb_dynamics *d, const trb_instant *at, int body, trb_detail *detail)
{
  clear_loads(at, d->loads);
  for (int i = 0; i < d->work->n_batches; i++) {
    const trb_batch *all = &d->work->batches[i];
    trb_batch        some = {.n = 0};
    if (all->pairs[0]->kind->pace != TRB_PACE_SLOW) continue;
    for (int k = 0; k < all->n; k++)
      if (body == TRB_ANY_BODY || all->pairs[k]->b == body) some.pairs[some.n] = all->pairs[k], some.index[some.n++] = all->index[k];
    if (some.n > 0) some.pairs[0]->kind->evaluate(d->model, at, &some, d->work, d->loads, detail);
  }
}

void trb_dynamics_hub(trb_dynamics *d, trb_detail *detail)
{
  const trb_instant at = trb_dynamics_instant(d, NULL, 0);
  memset(&d->hub, 0, sizeof d->hub);
  for (int i = 0; i < d->work->n_hub; i++) {
    const trb_pair *pair = d->work->hub[i].pairs[0];
    trb_load        load;
    memset(&load, 0, sizeof load);
    pair->kind->between(d->model, pair, &at, &d->work->counters, &load, detail);
    trb_add_load(pair, &load, &d->hub);
  }
}

void trb_dynamics_loads(trb_dynamics *d, const unsigned *apart, trb_detail *detail)
{
  trb_instant at = trb_dynamics_instant(d, d->everyone, d->model->n_rollers);
  at.apart = apart;
  at.spin = d->spin;
  clear_forces(d);
  clear_loads(&at, d->loads);
  d->work->counters.force_evaluations++;
  for (int i = 0; i < d->work->n_batches; i++) {
    const trb_batch *batch = &d->work->batches[i];
    batch->pairs[0]->kind->evaluate(d->model, &at, batch, d->work, d->loads, detail);
  }
  trb_dynamics_hub(d, detail);
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

/* The part of a right-hand side that belongs to no roller begins with gravity. */
static void start(trb_dynamics *d, double *rates)
{
  const trb_model *m = d->model;
  double          *q = rates + trb_state_quadrature(d->system);
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
  double   *q = rates + trb_state_quadrature(d->system);
  memcpy(rates + trb_state_roller(d->system, roller), flow, TRB_ROLLER_SIZE * sizeof *flow);
  rates[trb_state_spin(d->system) + roller] = flow[TRB_FLOW_spin];
  for (int k = 0; k < n; k++) q[k] += flow[TRB_FLOW_quadrature + k];
}

void trb_dynamics_book_bodies(const trb_dynamics *d, double *losses)
{
  for (int b = 0; b < d->system->n_bodies; b++)
    if (d->system->bodies[b].loss != 0 && !d->system->bodies[b].carried) losses[d->system->bodies[b].loss - 1] += d->bodies[b].pose.lost;
}

/* Adds the loads of pairs without a roller to those of the hub's bodies and their powers to the quadratures of the rates. */
static void add_hub(trb_dynamics *d, double *rates)
{
  double *q = rates + trb_state_quadrature(d->system);
  if (d->work->n_hub == 0) return;
  trb_dynamics_hub(d, NULL);
  for (int k = 0; k < d->model->n_losses; k++) q[TRB_Q_losses + k] += d->hub.power[k];
  for (int b = 0; b < d->system->n_bodies; b++) {
    trb_add_wrench(&d->on_body[b], &d->hub.on[b]);
    if (d->system->bodies[b].kind->power == NULL) continue;
    const trb_ring_pose pose = trb_body_in(&d->bodies[b], d->drive.cosine, d->drive.sine);
    add_work(d, b, &pose, &d->hub, q);
  }
}

void trb_dynamics_body_rates(const trb_dynamics *d, int body, const double *y, const trb_wrench *load, double *rates)
{
  const trb_body *is = &d->system->bodies[body];
  if (is->carried) (void)is->kind->added(d->model, is, &d->drive, y + is->first, load, rates);
  else is->kind->rates(d->model, is, &d->drive, &d->bodies[body].pose, y + is->first, load, rates);
}

/* Books the work that passes between a bearing and the shaft that carries its ring: what the contacts do to the ring is taken from the
 * bearing and given to the system that has the shaft. What they take from the turning ring the drive puts in again, where it keeps the speed.
 * So the energies of each bearing add up by themselves. added: what the drive puts in against the contacts. */
static void add_passed(const trb_dynamics *d, int b, trb_drive_power added, double *rates)
{
  const trb_body      *body = &d->system->bodies[b];
  const trb_ring_pose *ring = &d->bodies[b].ring;
  const trb_drive     *drive = &d->drive;
  const trb_vec3       force = trb_turn_z(d->on_body[b].force, drive->cosine, drive->sine);
  const trb_vec3       moment = trb_turn_z(d->on_body[b].moment, drive->cosine, drive->sine);
  const double         all = trb_dot(force, ring->velocity) + trb_dot(moment, ring->omega);
  const double         turning = trb_dot(moment, ring->axis) * trb_dot(ring->omega, ring->axis);
  rates[trb_state_quadrature(d->system) + TRB_Q_work_shaft] -= turning;
  rates[trb_state_quadrature(d->system) + TRB_Q_work_ring] -= all - turning;
  rates[body->carrier_quadrature + TRB_Q_work_ring] += all + added.shaft;
}

static void put_hub(const trb_dynamics *d, const double *y, double *rates)
{
  trb_dynamics_book_bodies(d, rates + trb_state_quadrature(d->system) + TRB_Q_losses);
  for (int b = 0; b < d->system->n_bodies; b++) {
    const trb_body *body = &d->system->bodies[b];
    double         *own = rates + body->first;
    if (body->size == 0) continue;
    if (body->carried) {
      double                added[TRB_MOST_CARRIED] = {0};
      const trb_drive_power given = body->kind->added(d->model, body, &d->drive, y + body->first, &d->on_body[b], added);
      for (int i = 0; i < body->size; i++) own[i] += added[i];
      add_passed(d, b, given, rates);
      continue;
    }
    trb_dynamics_body_rates(d, b, y, &d->on_body[b], own);
    if (d->bodies[b].deformed != NULL) body->kind->pushed(body, d->bodies[b].deformed->force, own);
    if (body->kind->work != NULL) {
      const trb_drive_power power = body->kind->work(d->model, body, &d->drive, y + body->first, &d->on_body[b]);
      rates[trb_state_quadrature(d->system) + TRB_Q_work_shaft] += power.shaft;
      rates[trb_state_quadrature(d->system) + TRB_Q_work_ring] += power.place;
    }
  }
}

/* Poses of the bodies, but for rollers whose forces are approximated and that touch nothing: they need none. Gives how many of the n chosen
 * rollers are to be evaluated exactly; they are d->exact, and d->near says which fast pairs of a roller may touch. */
static int place(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, const int *chosen, int n)
{
  int n_exact = 0;
  trb_dynamics_drive(d, time);
  trb_dynamics_pose_hub(d, y);
  if (instead != NULL) instead->begin(instead->self, d, time);
  for (int k = 0; k < n; k++) {
    const int     j = chosen[k];
    const double *own = y + trb_state_roller(d->system, j);
    d->near[j] = trb_fast_near(d, j, y);
    d->uneven[j] = trb_dynamics_spin_roller(d, j, y);
    const int follows =
        instead != NULL && !d->uneven[j] && instead->follow(instead->self, d, j, own, d->flows[j], trb_dynamics_reactions(d, j));
    if (!follows) d->exact[n_exact++] = j;
    if (!follows || d->near[j] != 0) trb_dynamics_pose_roller(d, j, own);
  }
  d->work->counters.tangent_rollers += n - n_exact;
  d->work->counters.exact_rollers += n_exact;
  return n_exact;
}

/* Flow under the slow pairs' exact loads. */
static void take(trb_dynamics *d, const trb_approximation *instead, int j, const double *y_roller)
{
  trb_wrench *const reactions = trb_dynamics_reactions(d, j);
  trb_dynamics_roller_flow(d, j, &d->loads[j], d->flows[j]);
  trb_dynamics_roller_reactions(d, j, &d->loads[j], reactions);
  if (instead != NULL && !d->uneven[j]) instead->learn(instead->self, d, j, y_roller, d->flows[j], reactions);
}

/* Slow pairs of the rollers that are to be evaluated exactly. */
static void evaluate_slow(trb_dynamics *d, int n_exact)
{
  trb_instant at = trb_dynamics_instant(d, d->exact, n_exact);
  at.spin = d->spin;
  trb_dynamics_slow(d, &at, TRB_ANY_BODY, NULL);
}

void trb_rhs_rollers(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, const int *chosen, int n,
                     double *rates)
{
  d->work->counters.force_evaluations++;
  /* poses */
  const int n_exact = place(d, instead, time, y, chosen, n);
  start(d, rates);
  /* slow pairs, exactly or approximated */
  if (n_exact > 0) evaluate_slow(d, n_exact);
  for (int k = 0; k < n_exact; k++) take(d, instead, d->exact[k], y + trb_state_roller(d->system, d->exact[k]));
  for (int k = 0; k < n; k++) {
    const int j = chosen[k];
    /* fast pairs that are not proven clear */
    if (d->near[j] != 0) trb_fast_add(d, j, y, d->flows[j]);
    for (int i = 0; i < d->system->n_moving; i++) trb_add_wrench(&d->on_body[d->system->moving[i]], &trb_dynamics_reactions(d, j)[i]);
  }
}

void trb_rhs_hub(trb_dynamics *d, const double *y, double *rates)
{
  add_hub(d, rates);
  put_hub(d, y, rates);
}

void trb_rhs_alone(trb_dynamics *d, const trb_approximation *instead, double time, int j, const double *y_roller)
{
  if (d->drive.time != time) trb_dynamics_drive(d, time);
  d->uneven[j] = 0;
  if (instead != NULL) instead->begin(instead->self, d, time);
  if (instead != NULL && instead->follow(instead->self, d, j, y_roller, d->flows[j], trb_dynamics_reactions(d, j))) {
    d->work->counters.tangent_rollers++;
    return;
  }
  trb_dynamics_pose_roller(d, j, y_roller);
  d->work->counters.exact_rollers++;
  d->exact[0] = j;
  evaluate_slow(d, 1);
  take(d, instead, j, y_roller);
}

void trb_rhs(trb_dynamics *d, const trb_approximation *instead, double time, const double *y, double *rates)
{
  const int n = d->model->n_rollers;
  y = trb_dynamics_held(d, time, y);
  trb_rhs_rollers(d, instead, time, y, d->everyone, n, rates);
  for (int j = 0; j < n; j++) trb_dynamics_put(d, j, d->flows[j], rates);
  trb_rhs_hub(d, y, rates);
  if (d->held == NULL) return;
  trb_spacer_join(d->system, &d->drive, y, rates);
  d->work->counters.spacers++;
}
