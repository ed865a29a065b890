/* Two cages in one bearing: one holds every other roller, the second one the rest, with a mass, a clearance and a stiffness of its own. They do not
 * touch, and the rings are held, so each cage with its rollers moves, bit for bit, as in a system without the other one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/case.h"
#include "bearing/pockets.h"
#include "check.h"
#include "motion/fast_pairs.h"
#include "rig.h"

enum { Z = 12, FACES = RIG_FACES * Z / 2, FIRST = 0, SECOND = 1, BOTH = 2, N_SYSTEMS = 3, STEPS = 60 };

/* Numbers of the second cage. */
typedef struct numbers {
  double mass, play; /* kg; circumferential, m */
} numbers;

static const numbers other = {0.35, 0.17e-3};
static const double  speed = 100.0 * TRB_PI;

/* The rows, and a system of each cage alone and of both. */
typedef struct scene {
  trb_model      *model;
  trb_cage_inputs cage;    /* the second one */
  trb_pockets     pockets; /* of it */
  trb_system     *systems[N_SYSTEMS];
  trb_motion     *motion;
  int             at[N_SYSTEMS][2]; /* where the coordinates of each cage begin; -1: it is not there */
  double          y[N_SYSTEMS][RIG_ROOM];
} scene;

/* Faces of the pockets from one on, every other one. */
static void faces_of(const trb_params *p, double play, int first, trb_face faces[FACES])
{
  const trb_case c = {.params = *p,
                      .own = {[TRB_CASE_play_radial] = 0.25e-3, [TRB_CASE_play_circumferential] = play, [TRB_CASE_play_axial] = 0.4e-3}};
  trb_face       all[RIG_FACES];
  CHECK(trb_case_faces(&c, all, NULL) == TRB_OK);
  for (int i = 0; i < FACES; i++) {
    faces[i] = all[i % RIG_FACES];
    faces[i].pocket[0] = first + i / RIG_FACES * 2;
  }
}

/* Puts the second cage beside the first one. */
static void add_second(trb_system *s, const scene *of)
{
  const int body = s->n_bodies++, surface = s->n_surfaces++, pair = s->n_pairs++;
  s->bodies[body] = (trb_body){.kind = &trb_body_cage, .name = "second cage", .own = &of->cage};
  s->surfaces[surface] = (trb_surface){"pockets of the second cage", body, TRB_SHAPE_POCKETS, &of->pockets};
  s->pairs[pair] = s->pairs[TRB_PAIR_pocket];
  s->pairs[pair].name = "second pocket";
  s->pairs[pair].surface[1] = surface;
}

/* Puts it in the place of the first one. */
static void replace_by_second(trb_system *s, const scene *of)
{
  s->bodies[TRB_BODY_CAGE].own = &of->cage;
  s->surfaces[s->pairs[TRB_PAIR_pocket].surface[1]].is = &of->pockets;
}

/* A state of both, in which rollers touch both cages, and its parts. */
static void set_states(scene *s)
{
  unsigned long long seed = 9;
  double             start[RIG_ROOM] = {0}, cage[2][TRB_CAGE_SIZE];
  const trb_system  *first = s->systems[FIRST];
  s->motion = rig_motion(rig_state(first, 4930.0, speed, start), speed);
  for (int k = 0; k < 2; k++) {
    double moved[RIG_ROOM];
    memcpy(moved, start, sizeof moved);
    rig_disturb(first, &seed, moved);
    memcpy(cage[k], moved + rig_cage(first), sizeof cage[k]);
    if (k == SECOND) memcpy(start, moved, sizeof start);
  }
  cage[SECOND][TRB_CAGE_x] = -1.6e-4;
  for (int k = 0; k < N_SYSTEMS; k++) {
    const trb_system *to = s->systems[k];
    memset(s->y[k], 0, sizeof s->y[k]);
    memcpy(s->y[k], start, Z * TRB_ROLLER_SIZE * sizeof *start);
    for (int c = 0; c < 2; c++)
      if (s->at[k][c] >= 0) memcpy(s->y[k] + s->at[k][c], cage[c], sizeof cage[c]);
    CHECK(trb_state_size(to) <= RIG_ROOM);
  }
}

static scene *open_scene(const numbers *second)
{
  trb_params p = rig_params();
  trb_face   faces[FACES];
  double     deviation[Z] = {0};
  scene     *s = calloc(1, sizeof *s);
  if (s == NULL) exit(1);
  p.effects.damping = 1;
  faces_of(&p, 0.12e-3, 0, faces);
  if (!CHECK(trb_model_create(&p, deviation, Z, faces, FACES, &s->model, NULL) == TRB_OK)) exit(1);
  s->cage = p.cage;
  s->cage.mass = second->mass, s->cage.inertia_axial *= 0.7, s->cage.offset += 1.5e-3, s->cage.youngs_modulus *= 0.5;
  faces_of(&p, second->play, 1, faces);
  CHECK(trb_pockets_fill(s->model, &p.pocket, &s->cage, faces, FACES, &s->pockets, NULL) == TRB_OK);
  for (int k = 0; k < N_SYSTEMS; k++) {
    if (!CHECK(trb_system_tapered(s->model, &s->systems[k], NULL) == TRB_OK)) exit(1);
    if (k == SECOND) replace_by_second(s->systems[k], s);
    if (k == BOTH) add_second(s->systems[k], s);
    CHECK(trb_system_finish(s->systems[k], NULL) == TRB_OK);
    s->at[k][FIRST] = k == SECOND ? -1 : rig_cage(s->systems[k]);
    s->at[k][SECOND] = k == FIRST ? -1 : s->systems[k]->bodies[k == BOTH ? TRB_N_BODIES : TRB_BODY_CAGE].first;
  }
  CHECK(s->systems[BOTH]->layout.hub_width == 2 * TRB_CAGE_SIZE);
  set_states(s);
  return s;
}

static void close_scene(scene *s)
{
  for (int k = 0; k < N_SYSTEMS; k++) trb_system_free(s->systems[k]);
  trb_motion_free(s->motion);
  trb_model_free(s->model);
  free(s);
}

/* Whether a cage and its rollers have the same bits in two states. */
static int same(const scene *s, int cage, int a, const double *y_a, int b, const double *y_b)
{
  int equal = memcmp(y_a + s->at[a][cage], y_b + s->at[b][cage], TRB_CAGE_SIZE * sizeof *y_a) == 0;
  for (int j = cage; j < Z; j += 2) {
    const int at = trb_state_roller(s->systems[a], j);
    equal &= memcmp(y_a + at, y_b + at, TRB_ROLLER_SIZE * sizeof *y_a) == 0;
    equal &= y_a[trb_state_spin(s->systems[a]) + j] == y_b[trb_state_spin(s->systems[b]) + j];
  }
  return equal;
}

/* Each roller pushes its own cage alone; force and moment are those on the roller the other way round; details tell both rows apart. */
static void test_action(const scene *s)
{
  const trb_system *both = s->systems[BOTH];
  trb_dynamics     *d = rig_dynamics(both, s->motion);
  trb_detail       *detail = rig_detail(both);
  const int         bodies[2] = {TRB_BODY_CAGE, TRB_N_BODIES};
  int               touching[2] = {0, 0};
  trb_dynamics_pose(d, 0.0, s->y[BOTH]);
  trb_detail_clear(s->model, detail);
  trb_dynamics_loads(d, NULL, detail);
  CHECK(d->n_fast == 2);
  for (int f = 0; f < 2; f++) {
    const trb_rigid_pose *cage = &d->bodies[bodies[f]].pose;
    CHECK(d->fast[f].pair->b == bodies[f]);
    for (int j = 0; j < Z; j++) {
      trb_load               load = {0};
      const trb_roller_pose *r = &d->rollers[j];
      const double          *force = detail->pocket_force + d->fast[f].pair->slots + j * s->model->n_slots;
      double                 sum = 0.0;
      for (int i = 0; i < s->model->n_slots; i++) sum += force[i];
      const trb_gaps gaps = trb_fast_touch(d, f, j, s->y[BOTH], &load, NULL, NULL);
      CHECK((d->fast[f].surfaces[j] > 0) == (j % 2 == f));
      if (j % 2 != f) {
        CHECK(sum == 0.0 && trb_gaps_clear(&gaps));
        CHECK(trb_norm(d->loads[j].on[bodies[f]].force) == 0.0 && trb_norm(d->loads[j].on[bodies[f]].moment) == 0.0);
        continue;
      }
      if (!(sum > 0.0)) continue;
      touching[f]++;
      const trb_vec3 on_roller = trb_turn_z(load.on_a.force, r->cosine, r->sine), x = trb_turn_z(r->x, r->cosine, r->sine);
      const trb_vec3 turn = trb_add(trb_turn_z(load.on_a.moment, r->cosine, r->sine), trb_cross(x, on_roller));
      const trb_vec3 back = trb_add(load.on_b.moment, trb_cross(cage->x, load.on_b.force));
      CHECK_NEAR(trb_norm(trb_add(on_roller, load.on_b.force)), 0.0, 1e-12 * sum);
      CHECK_NEAR(trb_norm(trb_add(turn, back)), 0.0, 1e-12 * sum);
      CHECK_NEAR(trb_norm(trb_sub(d->loads[j].on[bodies[f]].force, load.on_b.force)), 0.0, 1e-12 * sum);
    }
    CHECK(touching[f] > 0);
  }
  trb_detail_free(detail);
  trb_dynamics_free(d);
}

/* Steps of one length by the classical formula of Runge and Kutta, with exact forces: what is computed for one cage has no part in the steps of the
 * other one. */
static void integrate(const trb_system *system, const trb_motion *motion, double *y)
{
  static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, h = 5e-7;
  const int           n = trb_state_size(system);
  trb_dynamics       *d = rig_dynamics(system, motion);
  for (int step = 0; step < STEPS; step++) {
    double rates[RIG_ROOM] = {0}, sum[RIG_ROOM] = {0}, at[RIG_ROOM];
    for (int k = 0; k < 4; k++) {
      for (int i = 0; i < n; i++) at[i] = y[i] + part[k] * h * rates[i];
      trb_rhs(d, NULL, h * (step + part[k]), at, rates);
      for (int i = 0; i < n; i++) sum[i] += weight[k] * rates[i];
    }
    for (int i = 0; i < n; i++) y[i] += h * sum[i];
  }
  trb_dynamics_free(d);
}

/* Each cage as in a system of its own; and the first one as it was when the second one is heavier or has more play. */
static void test_apart(void)
{
  static const numbers changed[] = {{0.7, 0.17e-3}, {0.35, 0.11e-3}};
  scene               *s = open_scene(&other);
  double               start[RIG_ROOM];
  memcpy(start, s->y[BOTH], sizeof start);
  for (int k = 0; k < N_SYSTEMS; k++) integrate(s->systems[k], s->motion, s->y[k]);
  CHECK(same(s, FIRST, BOTH, s->y[BOTH], FIRST, s->y[FIRST]));
  CHECK(same(s, SECOND, BOTH, s->y[BOTH], SECOND, s->y[SECOND]));
  for (int c = 0; c < 2; c++) CHECK(!same(s, c, BOTH, s->y[BOTH], BOTH, start));
  CHECK(memcmp(s->y[BOTH] + s->at[BOTH][FIRST], s->y[BOTH] + s->at[BOTH][SECOND], TRB_CAGE_SIZE * sizeof *start) != 0);
  for (size_t i = 0; i < sizeof changed / sizeof *changed; i++) {
    scene *now = open_scene(&changed[i]);
    integrate(now->systems[BOTH], now->motion, now->y[BOTH]);
    CHECK(same(s, FIRST, BOTH, now->y[BOTH], BOTH, s->y[BOTH]));
    CHECK(!same(s, SECOND, BOTH, now->y[BOTH], BOTH, s->y[BOTH]));
    close_scene(now);
  }
  close_scene(s);
}

/* The Jacobian has the borders of both, and with the integrators of users the energy changes by works and losses alone. */
static void test_steps(void)
{
  static const char *const kinds[] = {"bdf", "erk"};
  scene                   *s = open_scene(&other);
  const trb_system        *both = s->systems[BOTH];
  double                   end[2][RIG_ROOM] = {{0}};
  CHECK(rig_jacobian_off(both, s->motion, 0.0, s->y[BOTH]) < 0.1);
  for (int k = 0; k < 2; k++) {
    trb_settings settings = rig_settings();
    settings.atol_position *= 1e-3, settings.atol_angle *= 1e-3, settings.atol_velocity *= 1e-3, settings.atol_spin *= 1e-3;
    settings.rtol *= 1e-3, settings.max_step = 2e-7;
    trb_simulation *sim = rig_simulation(both, s->motion, kinds[k], &settings, s->y[BOTH]);
    rig_run(sim, 1e-4);
    const double time = 1e-4;
    CHECK(trb_simulation_state_at(sim, time, end[k], NULL) == TRB_OK);
    const double *q = end[k] + trb_state_quadrature(both);
    const double  off = rig_balance(both, s->motion, time, end[k]) - rig_balance(both, s->motion, 0.0, s->y[BOTH]);
    double        lost = 0.0;
    for (int l = 0; l < s->model->n_losses; l++) lost += q[TRB_Q_losses + l];
    CHECK(q[TRB_Q_loss_pocket] > 0.0 && lost > 1e-3);
    CHECK_NEAR(off, 0.0, 1e-3 * lost);
    fprintf(stderr, "%s: energy off by %.2e of what was lost\n", kinds[k], fabs(off) / lost);
    trb_simulation_free(sim);
  }
  for (int c = 0; c < 2; c++)
    for (int i = 0; i < 3; i++) {
      const int at = s->at[BOTH][c] + i;
      CHECK_NEAR(end[0][at], end[1][at], 1e-3 * fabs(end[1][at] - s->y[BOTH][at]) + 1e-10);
    }
  close_scene(s);
}

int main(void)
{
  scene *s = open_scene(&other);
  test_action(s);
  close_scene(s);
  test_apart();
  test_steps();
  return check_report();
}
