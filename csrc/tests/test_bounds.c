/* Bounds of interferences with rings: whatever moves, none changes by more than its bound; and bounds are not much wider than needed. */
#include "motion/bound.h"

#include <stdlib.h>

#include "check.h"
#include "motion/rhs.h"
#include "rig.h"

enum { MOST = 512 };

static unsigned long long seed = 11;
static trb_detail        *detail; /* of the bearing under test */

/* Between `most` and so many decades less. */
static double size_of(double most, double decades) { return most * pow(10.0, -decades * fabs(rig_random(&seed))); }

/* A bearing whose motion is that of its frame; rings stand where the tests put them. */
static rig_bench set_up(const trb_params *params, double load)
{
  rig_bench b = rig_open(params, load);
  for (int i = 0; i < b.system->n_bodies; i++) b.d->bodies[i].rests = 0;
  return b;
}

/* A displacement of all rings, or of none. */
typedef struct stand {
  trb_vec3 shift[TRB_MOST_BODIES], lean[TRB_MOST_BODIES];
} stand;

static void displace(double shift, double lean, stand *s)
{
  for (int i = 0; i < TRB_MOST_BODIES; i++) {
    const double axial = shift * rig_random(&seed);
    s->shift[i] = trb_add(s->shift[i], trb_v(shift * rig_random(&seed), shift * rig_random(&seed), axial));
    s->lean[i] = trb_add(s->lean[i], trb_v(lean * rig_random(&seed), lean * rig_random(&seed), 0.0));
  }
}

/* Interferences of all rollers at a state, negative for a gap, by row; the frame has turned. */
static void look(rig_bench *b, double turn, const double *y, const stand *s, trb_loads *loads, double (*depth)[TRB_MOST_PAIRS])
{
  trb_dynamics    *d = b->d;
  const trb_model *m = d->model;
  trb_dynamics_pose(d, turn / (m->geometry.cage_speed_ratio * 100.0 * TRB_PI), y);
  for (int i = 0; i < b->system->n_bodies; i++) {
    trb_ring_pose *ring = &d->bodies[i].ring;
    if (!trb_is_ring(b->system->bodies[i].kind)) continue;
    const trb_vec3 axis = trb_add(ring->axis, s->lean[i]);
    ring->axis = trb_scale(1.0 / trb_norm(axis), axis);
    ring->centre = trb_add(ring->centre, s->shift[i]);
  }
  for (int j = 0; j < m->n_rollers; j++) trb_dynamics_pose_roller(d, j, y + trb_state_roller(b->system, j));
  const trb_instant at = trb_dynamics_instant(d, d->everyone, m->n_rollers);
  trb_detail_clear(m, detail);
  trb_dynamics_slow(d, &at, TRB_ANY_BODY, detail);
  memcpy(loads, d->loads, (size_t)m->n_rollers * sizeof *loads);
  for (int i = 0; i < b->system->n_pairs; i++) {
    const trb_pair *pair = &b->system->pairs[i];
    for (int j = 0; j < m->n_rollers && pair->on && pair->kind->contact != TRB_CONTACT_NONE; j++) {
      const double margin = loads[j].margin[i];
      if (pair->kind->contact == TRB_CONTACT_LINE) depth[j][i] = trb_pair_contacts(m, pair, detail)[j].load > 0.0 ? margin : -margin;
      else depth[j][i] = trb_pair_contacts(m, pair, detail)[j].interference;
      if (pair->kind->depth == NULL) continue;
      /* depths out of poses alone are those of the evaluation */
      const trb_ring_pose ring = trb_dynamics_ring_seen(d, pair->b, &d->rollers[j]);
      CHECK_NEAR(pair->kind->depth(pair, &d->rollers[j], &ring), margin, 1e-15);
      CHECK(margin == depth[j][i]);
    }
  }
}

/* What may move: one coordinate of the rollers alone, all of them, the frame, the rings, or everything. */
static void move(const trb_system *system, int kind, double size, double *y, double *turn, stand *s)
{
  static const double unit[TRB_PLACE_OF_ROLLER] = {1.0, 30.0, 1.0, 30.0, 30.0};
  for (int j = 0; j < system->model->n_rollers; j++)
    for (int c = 0; c < TRB_PLACE_OF_ROLLER; c++)
      if (kind == c || kind == 5 || kind > 7) y[trb_state_roller(system, j) + c] += size * unit[c] * rig_random(&seed);
  if (kind > 5 && kind != 7) *turn += 1e3 * size * rig_random(&seed);
  if (kind > 6) displace(size, 20.0 * size, s);
}

/* Random states of rollers and rings, and random displacements of both from there. aside, lean: of the rings; off: of the
 * rollers, m; farthest: displacement, m. */
static void try_rings(rig_bench *b, double aside, double lean, double off, double farthest, rig_tried *of, int *held)
{
  const trb_system   *system = b->system;
  const trb_model    *m = system->model;
  const size_t        n = (size_t)m->n_rollers;
  const trb_ring_arms arms = trb_ring_arms_of(system);
  trb_loads          *loads = calloc(2 * n, sizeof *loads);
  double (*before)[TRB_MOST_PAIRS] = calloc(2 * n, sizeof *before), (*after)[TRB_MOST_PAIRS] = before + n;
  const double share = 0.5;
  for (int k = 0; k < 600; k++) {
    double place[MOST], to[MOST], turn = rig_random(&seed), turned = turn;
    stand  from = {0}, there;
    memcpy(place, b->start, sizeof place);
    displace(aside, lean, &from);
    double unused = 0.0;
    stand  none = {0};
    move(system, 5, off, place, &unused, &none);
    look(b, turn, place, &from, loads, before);
    trb_body_at bodies[TRB_MOST_BODIES];
    memcpy(bodies, b->d->bodies, sizeof bodies);
    memcpy(to, place, sizeof to);
    there = from;
    move(system, k % 9, size_of(farthest, 4.0), to, &turned, &there);
    look(b, turned, to, &there, loads + n, after);
    trb_ring_offset offsets[TRB_MOST_BODIES];
    trb_ring_offsets_of(system, b->d->bodies, offsets);
    for (int i = 0; i < system->n_bodies; i++) {
      offsets[i].shifted = trb_norm(trb_sub(b->d->bodies[i].ring.centre, bodies[i].ring.centre));
      offsets[i].leaned = trb_norm(trb_sub(b->d->bodies[i].ring.axis, bodies[i].ring.axis));
    }
    for (int j = 0; j < m->n_rollers; j++) {
      const double *first = place + trb_state_roller(system, j), *last = to + trb_state_roller(system, j);
      double        step[TRB_ROLLER_SIZE];
      for (int c = 0; c < TRB_ROLLER_SIZE; c++) step[c] = last[c] - first[c];
      const unsigned open = trb_bounds_open(&arms, offsets, loads[j].margin, share, first, step, turned - turn);
      for (int i = 0; i < arms.n; i++) {
        const int       row = arms.row[i], ring = arms.body[i];
        const double    change = fabs(after[j][row] - before[j][row]), angle = turned - turn + last[TRB_ROLLER_psi];
        const double    around = fabs(step[TRB_ROLLER_psi] + turned - turn);
        const double    way = trb_way_on_ring(&arms.of[i], &offsets[ring], first, step, around, 0.0);
        trb_ring_offset still = offsets[ring];
        trb_bound       bound;
        CHECK(change <= way * (1.0 + 1e-9) + 1e-15);
        CHECK(way <= (1.0 + 1e-9) * trb_way_on_ring(&arms.of[i], &offsets[ring], first, step, around, INFINITY));
        if (way > 1e-12) rig_note(&of[row], change, way);
        /* a bound that was set there says the same */
        still.shifted = still.leaned = 0.0;
        trb_bound_set_on_ring(&bound, 1.000001 * way, &bodies[ring].ring, first, first[TRB_ROLLER_psi]);
        CHECK(trb_bound_holds_on_ring(&bound, &arms.of[i], &still, &b->d->bodies[ring].ring, last, angle));
        bound.length[0] = 0.999 * way;
        CHECK(way < 1e-12 || !trb_bound_holds_on_ring(&bound, &arms.of[i], &still, &b->d->bodies[ring].ring, last, angle));
        bound.length[0] = NAN;
        CHECK(!trb_bound_holds_on_ring(&bound, &arms.of[i], &still, &b->d->bodies[ring].ring, last, angle));
        if (open >> i & 1U) continue;
        ++*held;
        CHECK(change <= share * fabs(loads[j].margin[row]) * (1.0 + 1e-9));
      }
    }
  }
  free(loads);
  free(before);
}

static void test_rings(const trb_params *params, double load)
{
  rig_tried of[TRB_MOST_PAIRS] = {{0}};
  int       held = 0;
  rig_bench b = set_up(params, load);
  detail = rig_detail(b.system);
  try_rings(&b, 0.0, 0.0, 2e-6, 1e-5, of, &held);
  try_rings(&b, 40e-6, 0.0, 2e-6, 1e-5, of, &held);
  try_rings(&b, 20e-6, 1e-3, 1e-5, 1e-4, of, &held);
  try_rings(&b, 100e-6, 5e-3, 1e-4, 1e-3, of, &held);
  try_rings(&b, 100e-6, 2e-2, 5e-4, 2e-3, of, &held);
  const trb_ring_arms arms = trb_ring_arms_of(b.system);
  for (int i = 0; i < arms.n; i++) {
    const rig_tried *t = &of[arms.row[i]];
    fprintf(stderr, "%s: change over bound %.3f at most, %.3f in the mean of %d\n", b.system->pairs[arms.row[i]].name, t->tightest,
            t->mean / t->n, t->n);
    CHECK(t->n > 4000 && t->tightest > 0.9 && t->mean > 0.1 * t->n);
  }
  fprintf(stderr, "held %d\n", held);
  CHECK(held > 10000);
  trb_detail_free(detail);
  rig_close(&b);
}

/* Not a number proves nothing, wherever it stands. */
static void test_not_a_number(void)
{
  const trb_params      p = rig_params();
  trb_system           *system = rig_system(&p);
  const trb_ring_arms   arms = trb_ring_arms_of(system);
  const trb_ring_offset still[TRB_MOST_BODIES] = {{0}};
  const double          place[TRB_ROLLER_SIZE] = {0};
  double                interference[TRB_MOST_PAIRS], step[TRB_ROLLER_SIZE] = {0};
  for (int i = 0; i < TRB_MOST_PAIRS; i++) interference[i] = -1e-6;
  CHECK(arms.n == 4 && trb_bounds_open(&arms, still, interference, 0.5, place, step, 0.0) == 0U);
  for (int c = 0; c < TRB_PLACE_OF_ROLLER; c++) {
    step[c] = NAN;
    CHECK(trb_bounds_open(&arms, still, interference, 0.5, place, step, 0.0) == 0xFU);
    step[c] = 0.0;
  }
  CHECK(trb_bounds_open(&arms, still, interference, 0.5, place, step, NAN) == 0xFU);
  interference[arms.row[2]] = NAN;
  CHECK(trb_bounds_open(&arms, still, interference, 0.5, place, step, 0.0) == 1U << 2);
  rig_free(system);
}

/* The edge of the small end, seen from the roller's centre of mass, which lies nearer to the large end. */
static void test_arm_of_the_small_end(const trb_system *system)
{
  const trb_geometry *g = &system->model->geometry;
  trb_arms            arms;
  trb_pair_front_rib.arms(system->model, &system->pairs[TRB_PAIR_front_rib], &arms);
  CHECK(g->small_end_station < 0.0 && g->roller_mass_offset > 0.0);
  CHECK(arms.tilt <= 1.0 && arms.skew == arms.tilt);
  CHECK(arms.tilt * arms.roller[TRB_ROLLER_tilt] >= hypot(g->small_end_station - g->roller_mass_offset, g->small_end_radius));
}

/* Whatever meets a ring that stands aside and leans, while it turns and moves, passes a roller across no faster than its offset says. */
static void test_offset_of_a_ring(const trb_system *system)
{
  const trb_geometry *g = &system->model->geometry;
  const double        lean = 2e-3, outside = 2.0 * g->roller_centre_radius;
  const trb_ring_pose ring = {.axis = {sin(lean), 0, cos(lean)},
                              .centre = {3e-6, -4e-6, 1e-3},
                              .velocity = {-1e-3, 2e-3, 1.0},
                              .omega = {100.0 * sin(lean), 0.3, 100.0 * cos(lean)}};
  trb_body_at         bodies[TRB_MOST_BODIES] = {{.rests = 1}};
  trb_ring_offset     offsets[TRB_MOST_BODIES];
  for (int b = 0; b < system->n_bodies; b++) bodies[b].ring = ring;
  trb_ring_offsets_of(system, bodies, offsets);
  const trb_ring_offset *of = &offsets[system->driven];
  CHECK_NEAR(of->lean, 2.0 * sin(0.5 * lean), 1e-15);
  CHECK_NEAR(of->aside, 5e-6, 1e-18);
  CHECK(of->shifted == 0.0 && of->leaned == 0.0);
  for (int sign = -1; sign <= 1; sign++) {
    const trb_vec3 across = trb_cross(trb_v(ring.omega.x, ring.omega.y, 0.0), trb_scale(sign * outside, ring.axis));
    const trb_vec3 speed = trb_add(ring.velocity, across);
    CHECK(of->speed >= hypot(speed.x, speed.y));
    /* an outer ring has its reference point at the apex, far along the axis from the rollers */
    const trb_vec3 arm = trb_v(sign * g->roller_centre_radius, 0.0, g->centre_plane);
    const trb_vec3 there = trb_add(ring.velocity, trb_cross(trb_v(ring.omega.x, ring.omega.y, 0.0), arm));
    CHECK(of->speed >= hypot(there.x, there.y));
  }
}

/* A housing that turns about the apex moves what the rollers meet by the distance of that. */
static void test_speeds_of_a_housing(void)
{
  trb_params p = rig_params();
  p.outer_ring.free = 1.0, p.outer_ring.mass = 5.0, p.outer_ring.inertia_axial = 1e-2, p.outer_ring.inertia_transverse = 1e-2;
  trb_system           *system = rig_system(&p);
  const trb_geometry   *g = &system->model->geometry;
  const trb_ring_offset offsets[TRB_MOST_BODIES] = {{.speed = 0.0}};
  const double          y[TRB_ROLLER_SIZE] = {0}, turning = 0.1, moved = turning * hypot(g->roller_centre_radius, g->centre_plane);
  trb_body_at           bodies[TRB_MOST_BODIES] = {{.rests = 1}};
  trb_speed_bound       bound;
  if (!CHECK(system->n_moving == 1)) return;
  trb_speed_bound_set(&bound, 0.999 * moved, system, bodies, y, 0.0);
  CHECK(trb_speed_bound_holds(&bound, system, offsets, bodies, y, 0.0));
  bodies[system->moving[0]].ring.omega.y = turning;
  CHECK(!trb_speed_bound_holds(&bound, system, offsets, bodies, y, 0.0));
  rig_free(system);
}

/* Two velocities that each change by 0.6 of what may be hold alone, and not together, whatever their signs; the same of turns past a ring that
 * moves across. */
static void test_speeds_add_up(const trb_system *system)
{
  static const int      velocities[] = {TRB_ROLLER_v_r,     TRB_ROLLER_v_t,     TRB_ROLLER_v_z,
                                        TRB_ROLLER_omega_n, TRB_ROLLER_omega_t, TRB_ROLLER_omega_a};
  const trb_params     *p = &system->model->params;
  const double          reach = p->roller.total_length + p->roller.diameter, from[TRB_ROLLER_SIZE] = {0}, speed = 1e-3;
  const trb_body_at     bodies[TRB_MOST_BODIES] = {{.rests = 1}};
  const trb_ring_offset offsets[TRB_MOST_BODIES] = {{.speed = 0.0}, {.speed = 0.1}};
  trb_speed_bound       bound;
  trb_speed_bound_set(&bound, speed, system, bodies, from, 0.5);
  for (int a = 0; a < 6; a++)
    for (int b = 0; b < 6; b++) {
      double y[TRB_ROLLER_SIZE] = {0};
      y[velocities[a]] = 0.6 * speed / (a < 3 ? 1.0 : reach);
      CHECK(trb_speed_bound_holds(&bound, system, offsets, bodies, y, 0.5));
      CHECK(trb_speed_bound_holds(&bound, system, offsets, bodies, y, 0.5 + 0.3 * speed / 0.1));
      CHECK(!trb_speed_bound_holds(&bound, system, offsets, bodies, y, 0.5 - 0.6 * speed / 0.1));
      if (a == b) continue;
      y[velocities[b]] = -0.6 * speed / (b < 3 ? 1.0 : reach);
      CHECK(!trb_speed_bound_holds(&bound, system, offsets, bodies, y, 0.5));
    }
  trb_speed_bound_set(&bound, NAN, system, bodies, from, 0.5);
  CHECK(!trb_speed_bound_holds(&bound, system, offsets, bodies, from, 0.5));
}

int main(void)
{
  trb_params p = rig_params();
  p.rib.front_clearance = 20e-6;
  test_rings(&p, 3000.0);
  p = rig_cylinder();
  test_rings(&p, 3000.0);
  test_not_a_number();
  p = rig_params();
  trb_system *system = rig_system(&p);
  test_arm_of_the_small_end(system);
  test_offset_of_a_ring(system);
  test_speeds_add_up(system);
  test_speeds_of_a_housing();
  rig_free(system);
  return check_report();
}
