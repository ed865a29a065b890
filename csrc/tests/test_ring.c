/* Contacts, works and records take the rings as their kinds place them. The systems of this program have rings of other kinds, which turn
 * at a common speed about the bearing's axis, on top of their usual motion. If
 * rollers and cage turn with them, all bodies move relative to each other as before: so every contact must give the same forces, losses
 * and energies, and the drives of both rings together must put in the same power, less what the common turn puts into the rollers. */
#include <stdlib.h>

#include "body/ring.h"
#include "check.h"
#include "contact/kernels.h"
#include "rig.h"
#include "stepping/ring_tangent.h"

enum { ROOM = 600 };

static double common; /* speed of all bodies, rad/s */

static trb_vec3 turn(void) { return trb_v(0.0, 0.0, common); }

static void turn_with(trb_ring_pose *pose)
{
  pose->velocity = trb_add(pose->velocity, trb_cross(turn(), pose->centre));
  pose->omega = trb_add(pose->omega, turn());
}

static void place_outer(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  trb_ring_at_rest.place(m, drive, pose);
  turn_with(pose);
}

static void place_inner(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  trb_ring_prescribed.place(m, drive, pose);
  turn_with(pose);
}

static trb_drive_power power(const trb_ring_pose *pose, const trb_drive *drive, const trb_wrench *on_ring)
{
  (void)drive;
  return (trb_drive_power){-trb_dot(on_ring->moment, pose->omega), -trb_dot(on_ring->force, pose->velocity)};
}

static const trb_body_kind outer = {.name = "turning outer ring", .place = place_outer, .power = power};
static const trb_body_kind inner = {.name = "turning inner ring", .place = place_inner, .power = power};

static unsigned long long seed = 21;

/* Rollers and cage turn with the rings; poses are those of the state. */
static void turn_state(trb_dynamics *d, double *y)
{
  const trb_model      *m = d->model;
  const trb_rigid_pose *cage = &d->bodies[TRB_BODY_CAGE].pose;
  double               *of_cage = y + rig_cage(d->system);
  const trb_vec3        v = trb_cross(turn(), cage->x), omega = trb_to_frame(&cage->frame, turn());
  for (int j = 0; j < m->n_rollers; j++) {
    const trb_roller_pose *r = &d->rollers[j];
    double                *own = y + trb_state_roller(d->system, j);
    const trb_vec3         more = trb_to_frame(&r->frame, turn());
    own[TRB_ROLLER_v_t] += common * r->radius;
    own[TRB_ROLLER_omega_n] += more.x, own[TRB_ROLLER_omega_t] += more.y, own[TRB_ROLLER_omega_a] += more.z;
  }
  of_cage[TRB_CAGE_v_x] += v.x, of_cage[TRB_CAGE_v_y] += v.y;
  of_cage[TRB_CAGE_omega_n] += omega.x, of_cage[TRB_CAGE_omega_t] += omega.y, of_cage[TRB_CAGE_omega_a] += omega.z;
}

/* Power that a wrench puts into a body. */
static double into(const trb_wrench *w, trb_vec3 v, trb_vec3 omega) { return trb_dot(w->force, v) + trb_dot(w->moment, omega); }

static void check_same(const trb_loads *a, const trb_loads *b, double force)
{
  double lost = 0.0, more = 0.0;
  CHECK_NEAR(trb_norm(trb_sub(a->roller.force, b->roller.force)), 0.0, 1e-9 * force);
  CHECK_NEAR(trb_norm(trb_sub(a->roller.moment, b->roller.moment)), 0.0, 1e-9 * force);
  for (int body = 0; body < TRB_N_BODIES; body++) {
    CHECK_NEAR(trb_norm(trb_sub(a->on[body].force, b->on[body].force)), 0.0, 1e-9 * force);
    CHECK_NEAR(trb_norm(trb_sub(a->on[body].moment, b->on[body].moment)), 0.0, 1e-9 * force);
  }
  for (int k = 0; k < TRB_N_LOSSES; k++) lost += fabs(a->power[k]);
  /* of rolling resistance drag and pressure force balance together only: so their powers do not depend on the frame only as a sum */
  for (int k = 0; k < TRB_N_LOSSES; k++) more += b->power[k] - a->power[k];
  CHECK_NEAR(more, 0.0, 1e-9 * lost);
  for (int k = 0; k < TRB_N_LOSSES; k++)
    if (k != TRB_LOSS_rolling && k != TRB_LOSS_rolling_pressure) CHECK_NEAR(b->power[k], a->power[k], 1e-9 * lost);
  for (int k = 0; k < TRB_N_TORQUES; k++) CHECK_NEAR(b->torque[k], a->torque[k], 1e-9 * force);
  CHECK_NEAR(b->elastic, a->elastic, 1e-12 + 1e-9 * a->elastic);
}

/* What the drives of the rings put in, less what goes into roller and cage: the power that is lost or stored. */
static double put_in(const trb_dynamics *d, int roller)
{
  const trb_roller_pose *r = &d->rollers[roller];
  const trb_rigid_pose  *cage = &d->bodies[TRB_BODY_CAGE].pose;
  double                 flow[TRB_FLOW_ROOM];
  trb_dynamics_roller_flow(d, roller, &d->loads[roller], flow);
  return flow[TRB_FLOW_quadrature + TRB_Q_work_shaft] + flow[TRB_FLOW_quadrature + TRB_Q_work_ring] -
         into(&d->loads[roller].roller, r->v, r->omega) - into(&d->loads[roller].on[TRB_BODY_CAGE], cage->v, cage->omega);
}

static void test_common_turn(int guidance)
{
  trb_params    p = rig_params();
  double        still[ROOM], turning[ROOM], rates[2][ROOM];
  trb_dynamics *d[2];
  p.effects.guidance = guidance;
  p.effects.damping = p.effects.rolling_pressure_force = 1;
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  trb_motion      *motion = rig_motion(rig_state(system, 4930.0, 100 * TRB_PI, still), 100 * TRB_PI);
  system->bodies[TRB_BODY_OUTER_RING].kind = &outer;
  system->bodies[TRB_BODY_INNER_RING].kind = &inner;
  CHECK(trb_system_finish(system, NULL) == TRB_OK);
  rig_disturb(system, &seed, still);
  /* the cage in the land's film, and out of it */
  still[rig_cage(system) + TRB_CAGE_x] = guidance == TRB_GUIDANCE_INNER_LAND ? 1.001 * p.land.clearance : 0.4 * p.land.clearance;
  for (int i = 0; i < 2; i++) {
    common = 0.0;
    if (!CHECK(trb_dynamics_create(system, motion, "scalar", &d[i], NULL) == TRB_OK)) return;
    trb_dynamics_pose(d[i], 0.01, still);
    memcpy(turning, still, sizeof turning);
    common = i == 1 ? 37.0 : 0.0;
    turn_state(d[i], turning);
    trb_rhs(d[i], NULL, 0.01, turning, rates[i]);
    trb_dynamics_loads(d[i], NULL, NULL);
  }
  double       scale = 0.0;
  const double hub = trb_norm(d[0]->hub.on[TRB_BODY_CAGE].force);
  for (int j = 0; j < m->n_rollers; j++) scale = fmax(scale, trb_norm(d[0]->loads[j].on[TRB_BODY_OUTER_RING].force));
  CHECK(scale > 100.0);
  for (int j = 0; j < m->n_rollers; j++) {
    check_same(&d[0]->loads[j], &d[1]->loads[j], scale);
    CHECK_NEAR(put_in(d[1], j), put_in(d[0], j), 1e-9 * scale * 40.0);
  }
  CHECK((hub > 1e-3) == (guidance != TRB_GUIDANCE_ROLLERS));
  check_same(&d[0]->hub, &d[1]->hub, fmax(hub, 1.0));
  /* the same for the whole right-hand side, with the cage */
  double gained[2];
  for (int i = 0; i < 2; i++) {
    const trb_rigid_pose *cage = &d[i]->bodies[TRB_BODY_CAGE].pose;
    const double         *q = rates[i] + trb_state_quadrature(system);
    gained[i] = q[TRB_Q_work_shaft] + q[TRB_Q_work_ring] - into(&d[i]->hub.on[TRB_BODY_CAGE], cage->v, cage->omega);
    for (int j = 0; j < m->n_rollers; j++) {
      const trb_roller_pose *r = &d[i]->rollers[j];
      gained[i] -= into(&d[i]->loads[j].roller, r->v, r->omega);
      gained[i] -= into(&d[i]->loads[j].on[TRB_BODY_CAGE], cage->v, cage->omega);
    }
  }
  CHECK_NEAR(gained[1], gained[0], 1e-9 * scale * 40.0);
  CHECK(fabs(rates[1][trb_state_quadrature(system) + TRB_Q_work_shaft] - rates[0][trb_state_quadrature(system) + TRB_Q_work_shaft]) > 1e-3);
  for (int i = 0; i < 2; i++) trb_dynamics_free(d[i]);
  trb_motion_free(motion);
  rig_free(system);
}

/* The kinds themselves: the outer ring rests, the inner ring is where the drive says. */
static void test_kinds(void)
{
  const trb_params p = rig_params();
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  trb_drive        drive = {.ring = {{0, 0.6, 0.8}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}, .angle = 0.0}, .shaft_speed = 2.0};
  trb_ring_pose    pose;
  CHECK(trb_ring_at_rest.rests && trb_ring_at_rest.power == NULL);
  trb_ring_at_rest.place(m, &drive, &pose);
  CHECK(pose.axis.z == 1.0 && trb_norm(pose.centre) == 0.0 && trb_norm(pose.velocity) == 0.0 && trb_norm(pose.omega) == 0.0);
  CHECK(!trb_ring_prescribed.rests);
  trb_ring_prescribed.place(m, &drive, &pose);
  CHECK(memcmp(&pose, &drive.ring, sizeof pose) == 0);
  const trb_wrench      on_ring = {{1, -1, 2}, {3, 5, -7}};
  const trb_drive_power taken = trb_ring_prescribed.power(&pose, &drive, &on_ring);
  CHECK_NEAR(taken.shaft, -2.0 * (0.6 * 5 - 0.8 * 7), 1e-14);
  CHECK_NEAR(taken.shaft + taken.place, -into(&on_ring, pose.velocity, pose.omega), 1e-14);
  rig_free(system);
}

/* The inputs of a ring: in R, and moved along R's axes by rollers that see the ring from their own frames; a reaction comes back as a wrench. */
static void test_inputs(void)
{
  const trb_ring_pose ring = {{0.01, -0.02, 1.0}, {1e-3, 2e-3, 0.1}, {0.3, -0.2, 0.1}, {1, -2, 300}, 0.0};
  const trb_wrench    wrench = {{1, -2, 3}, {-4, 5, 6}};
  double              reaction[TRB_RING_OUT];
  trb_ring_reaction(&wrench, reaction);
  const trb_wrench back = trb_ring_wrench(reaction);
  CHECK(memcmp(&back, &wrench, sizeof wrench) == 0);
  for (int i = 0; i < 8; i++) {
    const double    frame = 0.7 * i, angle = cos(i);
    const trb_drive drive = {.cosine = cos(frame), .sine = sin(frame)}, turned = {.cosine = cos(-angle), .sine = sin(-angle)};
    double          inputs[TRB_RING_IN], moved[TRB_RING_IN];
    trb_ring_inputs(&ring, &drive, inputs);
    CHECK_NEAR(inputs[0] * cos(frame) - inputs[1] * sin(frame), ring.centre.x, 1e-15);
    CHECK_NEAR(inputs[3] * sin(frame) + inputs[4] * cos(frame), ring.axis.y, 1e-15);
    CHECK_NEAR(inputs[5] * cos(frame) - inputs[6] * sin(frame), ring.velocity.x, 1e-15);
    CHECK(inputs[7] == ring.velocity.z && inputs[10] == ring.omega.z);
    for (int c = 0; c < TRB_RING_IN; c++) {
      trb_ring_pose seen = trb_ring_pose_in_frame(&ring, cos(frame + angle), sin(frame + angle));
      trb_ring_move(&seen, c, 1e-3, cos(angle), sin(angle));
      trb_ring_inputs(&seen, &turned, moved);
      for (int k = 0; k < TRB_RING_IN; k++) CHECK_NEAR(moved[k] - inputs[k], k == c ? 1e-3 : 0.0, 1e-12);
    }
  }
}

int main(void)
{
  test_kinds();
  test_inputs();
  test_common_turn(TRB_GUIDANCE_ROLLERS);
  test_common_turn(TRB_GUIDANCE_INNER_LAND);
  test_common_turn(TRB_GUIDANCE_OUTER_LAND);
  return check_report();
}
