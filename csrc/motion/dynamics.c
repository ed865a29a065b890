#include "motion/dynamics.h"

#include <stdlib.h>
#include <string.h>

trb_status trb_dynamics_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_dynamics **dynamics,
                               trb_message *message)
{
  *dynamics = NULL;
  trb_dynamics *d = calloc(1, sizeof *d);
  if (d == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  const size_t n = (size_t)m->n_rollers;
  d->model = m;
  d->motion = motion;
  d->rollers = calloc(n, sizeof *d->rollers);
  d->inner = calloc(n, sizeof *d->inner);
  d->loads = calloc(n, sizeof *d->loads);
  d->everyone = calloc(n, sizeof *d->everyone);
  d->clearances = calloc(n, sizeof *d->clearances);
  trb_status status = TRB_OK;
  if (d->rollers == NULL || d->inner == NULL || d->loads == NULL || d->everyone == NULL || d->clearances == NULL) {
    status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for dynamics");
  } else {
    for (int j = 0; j < m->n_rollers; j++) d->everyone[j] = j;
    status = trb_workspace_create(m, variant, &d->work, message);
  }
  if (status != TRB_OK) {
    trb_dynamics_free(d);
    return status;
  }
  trb_clearance_arms_of(m, d->arms);
  *dynamics = d;
  return TRB_OK;
}

void trb_dynamics_free(trb_dynamics *d)
{
  if (d == NULL) return;
  trb_workspace_free(d->work);
  free(d->rollers);
  free(d->inner);
  free(d->loads);
  free(d->everyone);
  free(d->clearances);
  free(d);
}

void trb_dynamics_pose_roller(trb_dynamics *d, int roller, const double *y)
{
  trb_roller_pose *r = &d->rollers[roller];
  const trb_drive *drive = &d->drive;
  trb_roller_pose_unpack(d->model, drive, roller, y, r);
  if (d->model->params.planar > 0.0) {
    /* frozen tilts: the transverse angular velocity is the orbit's */
    const trb_frame *f = &r->frame;
    r->omega_frame.x = r->orbit_speed * f->n.z;
    r->omega_frame.y = r->orbit_speed * f->t.z;
    r->omega = trb_from_frame(f, r->omega_frame);
  }
  const double cosine = drive->cosine * r->cosine - drive->sine * r->sine, sine = drive->sine * r->cosine + drive->cosine * r->sine;
  d->inner[roller] = trb_ring_pose_in_frame(&drive->inner, cosine, sine);
}

void trb_dynamics_pose(trb_dynamics *d, double time, const double *y)
{
  trb_motion_at(d->motion, d->model, time, &d->drive);
  for (int j = 0; j < d->model->n_rollers; j++) trb_dynamics_pose_roller(d, j, y + trb_state_roller(j));
  trb_cage_pose_unpack(d->model, &d->drive, y + trb_state_cage(d->model), &d->cage);
}

trb_instant trb_dynamics_instant(const trb_dynamics *d)
{
  return (trb_instant){&d->drive,   d->rollers,         d->inner, d->model->params.with_cage > 0.0 ? &d->cage : NULL,
                       d->everyone, d->model->n_rollers};
}

void trb_dynamics_loads(trb_dynamics *d, trb_detail *detail)
{
  const trb_instant at = trb_dynamics_instant(d);
  trb_contact_all(d->model, &at, d->work, d->loads, detail);
}

typedef struct turn_rates {
  double   skew, tilt; /* rates of the axis' angles, rad/s */
  double   frame_a;    /* angular velocity of the frame (n, t, a) along a, rad/s */
  trb_vec3 spin;       /* angular acceleration in (n, t, a), rad/s2 */
} turn_rates;

/* Euler's equations in a frame that follows the axis but does not spin (docs/theory/motion.md#eulers-equations); parent: angular
 * velocity, about z, of the frame in which skew and tilt are measured. */
static turn_rates euler(const trb_frame *f, trb_vec3 omega, double parent, double transverse, double axial, trb_vec3 moment)
{
  turn_rates   out;
  const double cosine = f->t.y, sine = f->a.y; /* of the skew */
  out.skew = -(omega.x - parent * f->n.z);
  out.tilt = (omega.y - parent * f->t.z) / cosine;
  out.frame_a = parent * f->a.z + out.tilt * sine;
  const double spin = axial * omega.z, turn = transverse * out.frame_a;
  out.spin = trb_v((moment.x - omega.y * spin + turn * omega.y) / transverse, (moment.y - turn * omega.x + omega.x * spin) / transverse,
                   moment.z / axial);
  return out;
}

/* Gravity in a frame turned about z by the angle whose cosine and sine are given, on top of R. */
static trb_vec3 gravity_in(const trb_drive *drive, double cosine, double sine)
{
  return trb_turn_z(trb_turn_z(drive->gravity, drive->cosine, -drive->sine), cosine, -sine);
}

static int has_gravity(const trb_drive *drive) { return drive->gravity.x != 0.0 || drive->gravity.y != 0.0 || drive->gravity.z != 0.0; }

/* Planar motion (docs/theory/motion.md#planar-motion): the frozen tilts couple the orbit to the transverse inertia; (m + It s^2/r^2)
 * v_t' from Lagrange's equation of the orbit angle. */
static double orbit_inertia(const trb_geometry *g, const trb_roller_pose *r)
{
  return g->roller_inertia_transverse * r->frame.n.z * r->frame.n.z / (r->radius * r->radius);
}

static void freeze_roller(const trb_geometry *g, const trb_roller_pose *r, double v_t_reference_rate, double gravity_t, double *rates)
{
  const double inertia = orbit_inertia(g, r), coriolis = r->v.x * r->v.y / r->radius;
  rates[TRB_ROLLER_v_t] =
      (g->roller_mass * gravity_t - (g->roller_mass - inertia) * coriolis) / (g->roller_mass + inertia) - v_t_reference_rate;
  rates[TRB_ROLLER_z] = rates[TRB_ROLLER_v_z] = rates[TRB_ROLLER_skew] = rates[TRB_ROLLER_tilt] = 0.0;
  rates[TRB_ROLLER_omega_n] = rates[TRB_ROLLER_omega_t] = 0.0;
}

void trb_dynamics_roller_inertia(const trb_dynamics *d, int roller, double *flow)
{
  const trb_model       *m = d->model;
  const trb_geometry    *g = &m->geometry;
  const trb_drive       *drive = &d->drive;
  const trb_roller_pose *r = &d->rollers[roller];
  const trb_rolling      rolling_rate = trb_pure_rolling(m, drive->shaft_rate);
  const int              heavy = has_gravity(drive);
  const trb_vec3         fall = heavy ? gravity_in(drive, r->cosine, r->sine) : trb_v(0, 0, 0);
  const turn_rates       turn =
      euler(&r->frame, r->omega_frame, r->orbit_speed, g->roller_inertia_transverse, g->roller_inertia_axial, trb_v(0, 0, 0));
  flow[TRB_ROLLER_r] = r->v.x;
  flow[TRB_ROLLER_psi] = r->orbit_speed - drive->frame_speed;
  flow[TRB_ROLLER_z] = r->v.z;
  flow[TRB_ROLLER_skew] = turn.skew;
  flow[TRB_ROLLER_tilt] = turn.tilt;
  flow[TRB_ROLLER_v_r] = fall.x + r->v.y * r->orbit_speed;
  flow[TRB_ROLLER_v_t] = fall.y - r->v.x * r->orbit_speed - rolling_rate.v_t;
  flow[TRB_ROLLER_v_z] = fall.z;
  flow[TRB_ROLLER_omega_n] = turn.spin.x - rolling_rate.omega_n;
  flow[TRB_ROLLER_omega_t] = turn.spin.y;
  flow[TRB_ROLLER_omega_a] = turn.spin.z - rolling_rate.omega_a;
  if (m->params.planar > 0.0) freeze_roller(g, r, rolling_rate.v_t, fall.y, flow);
  const double frame_a = r->orbit_speed * r->frame.a.z + flow[TRB_ROLLER_tilt] * r->frame.a.y;
  flow[TRB_FLOW_spin] = r->omega_frame.z - frame_a + g->roller_spin_ratio * drive->shaft_speed;
  memset(flow + TRB_FLOW_quadrature, 0, TRB_N_QUADRATURES * sizeof *flow);
  if (!heavy) return;
  flow[TRB_FLOW_quadrature + TRB_Q_work_gravity] = g->roller_mass * trb_dot(fall, r->v);
  d->work->counters.gravity_bodies++;
}

void trb_dynamics_roller_response(const trb_dynamics *d, int roller, const trb_roller_load *load, double *flow)
{
  const trb_geometry    *g = &d->model->geometry;
  const trb_roller_pose *r = &d->rollers[roller];
  const trb_vec3         moment = trb_to_frame(&r->frame, load->moment);
  const double           per_mass = 1.0 / g->roller_mass, per_transverse = 1.0 / g->roller_inertia_transverse;
  flow[TRB_ROLLER_v_r] += per_mass * load->force.x;
  flow[TRB_ROLLER_omega_a] += moment.z / g->roller_inertia_axial;
  if (d->model->params.planar > 0.0) {
    flow[TRB_ROLLER_v_t] += (load->force.y + r->frame.n.z * moment.x / r->radius) / (g->roller_mass + orbit_inertia(g, r));
  } else {
    flow[TRB_ROLLER_v_t] += per_mass * load->force.y;
    flow[TRB_ROLLER_v_z] += per_mass * load->force.z;
    flow[TRB_ROLLER_omega_n] += per_transverse * moment.x;
    flow[TRB_ROLLER_omega_t] += per_transverse * moment.y;
  }
  for (int k = 0; k < TRB_N_POWERS; k++) flow[TRB_FLOW_quadrature + TRB_Q_loss_traction_outer + k] += load->power[k];
}

void trb_dynamics_roller_flow(const trb_dynamics *d, int roller, const trb_roller_load *load, double *flow)
{
  const trb_ring_pose *ring = &d->inner[roller];
  const double         shaft = -trb_dot(load->ring_moment, ring->axis) * d->drive.shaft_speed;
  trb_dynamics_roller_inertia(d, roller, flow);
  trb_dynamics_roller_response(d, roller, load, flow);
  flow[TRB_FLOW_quadrature + TRB_Q_work_shaft] += shaft;
  flow[TRB_FLOW_quadrature + TRB_Q_work_ring] +=
      -trb_dot(load->ring_force, ring->velocity) - trb_dot(load->ring_moment, ring->omega) - shaft;
}

void trb_dynamics_cage_rates(const trb_dynamics *d, const double *y, trb_vec3 force, trb_vec3 moment, double *rates)
{
  const trb_model     *m = d->model;
  const trb_drive     *drive = &d->drive;
  const trb_cage_pose *c = &d->cage;
  memset(rates, 0, TRB_CAGE_SIZE * sizeof *rates);
  if (m->params.with_cage <= 0.0) return;
  const double     w = drive->frame_speed, per_mass = 1.0 / m->params.cage_mass;
  const trb_vec3   g = has_gravity(drive) ? gravity_in(drive, 1.0, 0.0) : trb_v(0, 0, 0);
  const turn_rates turn =
      euler(&c->frame, c->omega_frame, w, m->params.cage_inertia_transverse, m->params.cage_inertia_axial, trb_to_frame(&c->frame, moment));
  rates[TRB_CAGE_x] = c->v.x + w * y[TRB_CAGE_y];
  rates[TRB_CAGE_y] = c->v.y - w * y[TRB_CAGE_x];
  rates[TRB_CAGE_psi] = c->omega_frame.z - turn.frame_a;
  rates[TRB_CAGE_v_x] = per_mass * force.x + g.x + w * c->v.y;
  rates[TRB_CAGE_v_y] = per_mass * force.y + g.y - w * c->v.x;
  rates[TRB_CAGE_omega_a] = turn.spin.z - drive->frame_rate;
  if (m->params.planar > 0.0) return;
  rates[TRB_CAGE_z] = c->v.z;
  rates[TRB_CAGE_skew] = turn.skew;
  rates[TRB_CAGE_tilt] = turn.tilt;
  rates[TRB_CAGE_v_z] = per_mass * force.z + g.z;
  rates[TRB_CAGE_omega_n] = turn.spin.x;
  rates[TRB_CAGE_omega_t] = turn.spin.y;
}

_Static_assert(TRB_Q_loss_traction_outer + TRB_N_POWERS == TRB_N_QUADRATURES, "a quadrature for every power, in the same order");

void trb_dynamics_start(const trb_dynamics *d, double *rates)
{
  const trb_model *m = d->model;
  double          *q = rates + trb_state_quadrature(m);
  memset(q, 0, TRB_N_QUADRATURES * sizeof *q);
  if (!has_gravity(&d->drive) || m->params.with_cage <= 0.0) return;
  d->work->counters.gravity_bodies++;
  q[TRB_Q_work_gravity] = m->params.cage_mass * trb_dot(gravity_in(&d->drive, 1.0, 0.0), d->cage.v);
}

void trb_dynamics_put(const trb_dynamics *d, int roller, const double *flow, double *rates)
{
  const trb_model *m = d->model;
  double          *q = rates + trb_state_quadrature(m);
  memcpy(rates + trb_state_roller(roller), flow, TRB_ROLLER_SIZE * sizeof *flow);
  rates[trb_state_spin(m) + roller] = flow[TRB_FLOW_spin];
  for (int k = 0; k < TRB_N_QUADRATURES; k++) q[k] += flow[TRB_FLOW_quadrature + k];
}

int trb_dynamics_clear(const trb_dynamics *d, int roller, const double *y)
{
  const trb_model *m = d->model;
  const int        faces = m->first_face[roller + 1] - m->first_face[roller];
  if (faces == 0) return 1;
  if (!trb_clearance_holds(&d->clearances[roller], d->arms, y + trb_state_roller(roller), y + trb_state_cage(m))) return 0;
  d->work->counters.pocket_tests += faces;
  d->work->counters.pocket_culled += faces;
  return 1;
}

void trb_dynamics_pocket(trb_dynamics *d, int roller, const double *y, double *flow, trb_vec3 *cage_force, trb_vec3 *cage_moment)
{
  const trb_instant     at = trb_dynamics_instant(d);
  trb_roller_load       load;
  const trb_pocket_gaps gaps = trb_contact_pocket_of(d->model, &at, roller, &d->work->counters, &load, NULL, NULL);
  trb_clearance_set(d->model, &d->clearances[roller], &gaps, y + trb_state_roller(roller), y + trb_state_cage(d->model));
  if (trb_pocket_clear(&gaps)) return;
  trb_dynamics_roller_response(d, roller, &load, flow);
  *cage_force = trb_add(*cage_force, load.cage_force);
  *cage_moment = trb_add(*cage_moment, load.cage_moment);
}

void trb_dynamics_derivative(trb_dynamics *d, double time, const double *y, double *rates)
{
  const trb_model  *m = d->model;
  const trb_instant at = trb_dynamics_instant(d);
  trb_vec3          force = {0, 0, 0}, moment = {0, 0, 0};
  trb_dynamics_pose(d, time, y);
  trb_dynamics_start(d, rates);
  trb_contact_rings_only(m, &at, d->work, d->loads);
  d->work->counters.force_evaluations++;
  for (int j = 0; j < m->n_rollers; j++) {
    double flow[TRB_FLOW_SIZE];
    trb_dynamics_roller_flow(d, j, &d->loads[j], flow);
    if (!trb_dynamics_clear(d, j, y)) trb_dynamics_pocket(d, j, y, flow, &force, &moment);
    trb_dynamics_put(d, j, flow, rates);
  }
  trb_dynamics_cage_rates(d, y + trb_state_cage(m), force, moment, rates + trb_state_cage(m));
}
