/* The raceway kernels on cylinders: a roller of constant radius between raceways of half angle zero, against formulas for cylinders, and as the
 * limit of cones. Only the laws' constants come from the rig's model. */
#include "contact/kernels.h"
#include "laws/line_contact.h"

#include "check.h"
#include "rig.h"

enum { MOST = 64 };
#define DEPTH 8e-6

/* A cylindrical roller against one raceway. */
typedef struct bench {
  const trb_model *m;
  trb_workspace   *work;
  int              variant;
  double           own, pitch; /* radius of the roller, of the circle of its centre, m */
  double           centre[MOST], sphere[MOST], radius[MOST], log_radius[MOST], share[MOST];
  trb_race_nodes   nodes;
  trb_cone         cone;
  trb_ring_pose    ring;
  trb_roller_pose  roller;
  trb_counters     counters;
  trb_race_output  out;
} bench;

static double side_of(int race) { return race == TRB_RACE_OUTER ? 1.0 : -1.0; }

/* Pressed into the raceway by DEPTH, at rest; half_angle is that of the raceway. */
static void set_up(bench *b, int race, double half_angle)
{
  const trb_params *p = &b->m->params;
  const double      side = side_of(race);
  b->own = 0.5 * p->roller.diameter;
  b->pitch = 0.5 * p->bearing.pitch_diameter;
  b->cone = trb_cone_of(0.0, b->pitch + side * b->own, half_angle, side);
  b->nodes = b->m->race[race];
  b->nodes.radius = b->radius, b->nodes.log_radius = b->log_radius, b->nodes.roller_share = b->share;
  for (int k = 0; k < b->m->n_lanes; k++) {
    b->centre[k] = b->m->station[k];
    b->sphere[k] = b->own;
    b->radius[k] = 1.0 / (1.0 / b->own - side / b->cone.radius);
    b->log_radius[k] = log(b->radius[k]);
    b->share[k] = b->radius[k] / b->own;
  }
  b->ring = (trb_ring_pose){.axis = {0, 0, 1}};
  b->roller = (trb_roller_pose){.x = {b->pitch + side * DEPTH, 0, 0}, .frame = trb_tilted_frame(0.0, 0.0)};
}

static void evaluate(bench *b)
{
  const trb_race_input in = {&b->roller, &b->ring, &b->cone, b->centre, b->sphere, &b->nodes, NULL, NULL, 0, 0};
  trb_kernel_variants[b->variant].raceway(b->m, &in, 1, b->work->lanes, &b->counters, &b->out);
}

/* Palmgren's load of a node at an interference. */
static double load_of(const bench *b, int k, double d)
{
  const double length = b->m->params.roller.effective_length, modulus = b->m->geometry.effective_modulus;
  return d > 0.0 ? 0.356 * modulus * pow(length, -1.0 / 9.0) * b->nodes.weight[k] * pow(d, 10.0 / 9.0) : 0.0;
}

/* Square on the raceway: every node as deep as the roller is pressed in; no force along the axis, no moment. */
static void test_square(bench *b, int race)
{
  const double side = side_of(race);
  double       load = 0.0;
  set_up(b, race, 0.0);
  evaluate(b);
  for (int k = 0; k < b->m->n_nodes; k++) {
    const double q = load_of(b, k, DEPTH), w = q / b->nodes.weight[k];
    CHECK_NEAR(b->work->lanes->interference[k], DEPTH, 2e-17);
    CHECK_NEAR(b->work->lanes->nx[k], side, 1e-15);
    CHECK_NEAR(b->work->lanes->nz[k], 0.0, 1e-17);
    CHECK_NEAR(b->work->lanes->px[k], b->cone.radius + 0.5 * side * DEPTH, 1e-17);
    CHECK_NEAR(b->work->lanes->pz[k], b->m->station[k], 1e-17);
    CHECK_RELATIVE(b->work->lanes->pressure[k], 2.0 * w / (TRB_PI * b->work->lanes->half_width[k]), 1e-11);
    CHECK_RELATIVE(b->work->lanes->half_width[k], sqrt(8.0 * w * b->radius[k] / (TRB_PI * b->m->geometry.effective_modulus)), 1e-11);
    load += q;
  }
  CHECK_NEAR(b->out.depth, DEPTH, 2e-17);
  CHECK_NEAR(b->out.force.x, -side * load, 1e-11 * load);
  CHECK_NEAR(b->out.force.y, 0.0, 1e-12 * load);
  CHECK_NEAR(b->out.force.z, 0.0, 1e-12 * load);
  CHECK_NEAR(trb_norm(b->out.moment), 0.0, 1e-12 * load * b->m->params.roller.effective_length);
  CHECK_NEAR(b->out.ring_force.x, side * load, 1e-11 * load);
  CHECK_RELATIVE(b->out.elastic, 9.0 / 19.0 * load * DEPTH, 1e-11);
  b->roller.x.x -= 2.0 * side * DEPTH;
  evaluate(b);
  CHECK(!b->out.loaded && trb_norm(b->out.force) == 0.0);
  CHECK_NEAR(b->out.depth, -DEPTH, 2e-17);
}

/* Tilted in the axial plane, and skewed: the depth of each node from its own place. */
static void test_leaning(bench *b, int race)
{
  const double side = side_of(race), tilt = 3e-4, skew = 5e-3;
  double       fx = 0.0, my = 0.0, load = 0.0;
  set_up(b, race, 0.0);
  b->roller.frame = trb_tilted_frame(0.0, tilt);
  evaluate(b);
  for (int k = 0; k < b->m->n_nodes; k++) {
    const double s = b->m->station[k], x = b->roller.x.x + s * sin(tilt), d = b->own + side * (x - b->cone.radius), q = load_of(b, k, d);
    CHECK_NEAR(b->work->lanes->interference[k], d, 2e-17);
    fx -= side * q, my -= side * q * s * cos(tilt), load += q;
  }
  CHECK(load > 0.0);
  CHECK_NEAR(b->out.force.x, fx, 1e-11 * load);
  CHECK_NEAR(b->out.force.z, 0.0, 1e-12 * load);
  CHECK_NEAR(b->out.moment.y, my, 1e-11 * load * b->m->params.roller.effective_length);
  b->roller.frame = trb_tilted_frame(skew, 0.0);
  evaluate(b);
  for (int k = 0; k < b->m->n_nodes; k++) {
    const double aside = b->m->station[k] * sin(skew), off = hypot(b->roller.x.x, aside);
    CHECK_NEAR(b->work->lanes->interference[k], b->own + side * (off - b->cone.radius), 5e-17);
    CHECK_NEAR(b->work->lanes->ny[k], side * aside / off, 1e-15);
  }
}

/* Dry friction of a roller that is dragged round without turning; and none where the cylinders roll. */
static void test_motion(bench *b, int race)
{
  const double side = side_of(race), speed = 2.0, turn = b->m->params.friction.coulomb_speed;
  const double mu = b->m->params.friction.dry_friction * speed / hypot(speed, turn);
  set_up(b, race, 0.0);
  b->roller.v = trb_v(0, speed, 0);
  evaluate(b);
  const double load = -side * b->out.force.x;
  CHECK(load > 0.0);
  CHECK_NEAR(b->out.force.y, -mu * load, 1e-9 * mu * load);
  CHECK_RELATIVE(b->out.power_traction, mu * load * speed, 1e-9);
  CHECK_RELATIVE(b->out.moment.z, -side * b->own * mu * load, 1e-3);
  /* orbit and spin of pure rolling with the outer ring at rest: ratios of radii */
  const double shaft = 300.0, inner = b->pitch - b->own, outer = b->pitch + b->own, orbit = shaft * inner / (inner + outer);
  b->ring.omega = trb_v(0, 0, race == TRB_RACE_OUTER ? 0.0 : shaft);
  b->roller.v = trb_v(0, orbit * b->roller.x.x, 0);
  b->roller.orbit_speed = orbit;
  b->roller.omega = trb_v(0, 0, orbit - orbit * outer / b->own);
  evaluate(b);
  for (int k = 0; k < b->m->n_nodes; k++) {
    CHECK_NEAR(b->work->lanes->sliding_speed[k], 0.0, 2.0 * shaft * DEPTH);
    CHECK_RELATIVE(b->work->lanes->mean_speed[k], orbit * outer, 1e-3);
  }
}

/* A cone becomes a cylinder as its half angle goes to zero, in proportion to it. */
static void test_limit(bench *b, int race)
{
  const double side = side_of(race);
  trb_vec3     force, moment;
  double       load;
  set_up(b, race, 0.0);
  evaluate(b);
  force = b->out.force, moment = b->out.moment, load = trb_norm(force);
  for (double angle = 1e-4; angle > 1e-14; angle *= 0.1) {
    set_up(b, race, angle);
    evaluate(b);
    for (int k = 0; k < b->m->n_nodes; k++) {
      /* the angle moves the surface only off the reference plane */
      const double d = DEPTH - side * b->m->station[k] * angle;
      CHECK_NEAR(b->work->lanes->interference[k], d, 0.5 * angle * angle * b->own + 3e-17);
    }
    CHECK_NEAR(b->out.force.z, side * load * angle, load * (3.0 * angle * angle * b->m->params.roller.effective_length / DEPTH + 1e-12));
    CHECK_NEAR(b->out.force.x, force.x, load * (angle * angle * 2e5 + 1e-11));
    CHECK_NEAR(trb_norm(trb_sub(b->out.moment, moment)), 0.0, load * b->m->params.roller.effective_length * (1e3 * angle + 1e-11));
  }
}

int main(void)
{
  trb_params   p = rig_params();
  static bench b;
  p.effects.lubrication = TRB_LUBRICATION_DRY, p.friction.dry_friction = 0.1, p.effects.rolling_resistance = 0.0, p.effects.damping = 0.0;
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  CHECK(m->n_lanes <= MOST);
  for (int v = 0; v < trb_n_kernel_variants; v++) {
    if (!trb_kernel_runs(v)) continue;
    b = (bench){.m = m, .variant = v};
    if (!CHECK(trb_workspace_create(system->pairs, system->n_pairs, trb_kernel_variants[v].name, &b.work, NULL) == TRB_OK))
      return check_report();
    for (int race = 0; race < TRB_N_RACES; race++) {
      test_square(&b, race);
      test_leaning(&b, race);
      test_motion(&b, race);
      test_limit(&b, race);
    }
    trb_workspace_free(b.work);
  }
  rig_free(system);
  return check_report();
}
