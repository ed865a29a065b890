/* Bounds of gaps: whatever moves, no gap changes by more than its bound; and bounds are not much wider than needed. */
#include "motion/bound.h"

#include <stdlib.h>

#include "check.h"
#include "motion/dynamics.h"
#include "rig.h"

enum { MOST = 512 };

static unsigned long long seed = 11;

/* What a bound was, and what it bounded. */
typedef struct tried {
  double tightest; /* largest change over its bound */
  double mean;     /* the same, summed up */
  int    n;
} tried;

static void note(tried *t, double change, double bound)
{
  if (!(bound > 0.0)) return;
  t->tightest = fmax(t->tightest, change / bound);
  t->mean += change / bound;
  t->n++;
}

/* Between `most` and so many decades less. */
static double size_of(double most, double decades) { return most * pow(10.0, -decades * fabs(rig_random(&seed))); }

/* A bearing whose motion is that of its frame; rings stand where the tests put them. */
typedef struct bench {
  trb_system   *system;
  trb_motion   *motion;
  trb_dynamics *d;
  trb_detail   *detail;
  double        y[MOST];
} bench;

static int set_up(bench *b, const trb_params *params, double load)
{
  const double speed = 100.0 * TRB_PI;
  b->system = rig_system(params);
  b->motion = rig_motion(rig_state(b->system, load, speed, b->y), speed);
  if (!CHECK(trb_dynamics_create(b->system, b->motion, "scalar", &b->d, NULL) == TRB_OK)) return 0;
  for (int i = 0; i < b->system->n_bodies; i++) b->d->bodies[i].rests = 0;
  return CHECK(trb_detail_create(b->system->model, b->system->pairs, b->system->n_pairs, &b->detail, NULL) == TRB_OK);
}

static void take_down(bench *b)
{
  trb_detail_free(b->detail);
  trb_dynamics_free(b->d);
  trb_motion_free(b->motion);
  rig_free(b->system);
}

/* ---- contacts with rings ---- */

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
static void look(bench *b, double turn, const double *y, const stand *s, trb_loads *loads, double (*depth)[TRB_MOST_PAIRS])
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
  const trb_instant at = trb_dynamics_instant(d);
  trb_detail_clear(m, b->detail);
  trb_contact_slow(m, &at, d->work, loads, b->detail);
  for (int i = 0; i < b->system->n_pairs; i++) {
    const trb_pair *pair = &b->system->pairs[i];
    for (int j = 0; j < m->n_rollers && pair->on && pair->kind->contact != TRB_CONTACT_NONE; j++) {
      const double margin = loads[j].margin[i];
      if (pair->kind->contact == TRB_CONTACT_LINE) depth[j][i] = trb_pair_contacts(m, pair, b->detail)[j].load > 0.0 ? margin : -margin;
      else depth[j][i] = trb_pair_contacts(m, pair, b->detail)[j].interference;
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
static void try_rings(bench *b, double aside, double lean, double off, double farthest, tried *of, int *held)
{
  const trb_system   *system = b->system;
  const trb_model    *m = system->model;
  const size_t        n = (size_t)m->n_rollers;
  const trb_ring_arms arms = trb_ring_arms_of(system);
  trb_loads          *loads = calloc(2 * n, sizeof *loads);
  double(*before)[TRB_MOST_PAIRS] = calloc(2 * n, sizeof *before), (*after)[TRB_MOST_PAIRS] = before + n;
  const double share = 0.5;
  for (int k = 0; k < 1500; k++) {
    double place[MOST], to[MOST], turn = rig_random(&seed), turned = turn;
    stand  from = {0}, there;
    memcpy(place, b->y, sizeof place);
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
        const double    way = trb_way_on_ring(&arms.of[i], &offsets[ring], first, step, around);
        trb_ring_offset still = offsets[ring];
        trb_bound       bound;
        CHECK(change <= way * (1.0 + 1e-9) + 1e-15);
        if (way > 1e-12) note(&of[row], change, way);
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
  bench b;
  tried of[TRB_MOST_PAIRS] = {{0}};
  int   held = 0;
  if (!set_up(&b, params, load)) return;
  try_rings(&b, 0.0, 0.0, 2e-6, 1e-5, of, &held);
  try_rings(&b, 40e-6, 0.0, 2e-6, 1e-5, of, &held);
  try_rings(&b, 20e-6, 1e-3, 1e-5, 1e-4, of, &held);
  try_rings(&b, 100e-6, 5e-3, 1e-4, 1e-3, of, &held);
  try_rings(&b, 100e-6, 2e-2, 5e-4, 2e-3, of, &held);
  const trb_ring_arms arms = trb_ring_arms_of(b.system);
  for (int i = 0; i < arms.n; i++) {
    const tried *t = &of[arms.row[i]];
    fprintf(stderr, "%s: change over bound %.3f at most, %.3f in the mean of %d\n", b.system->pairs[arms.row[i]].name, t->tightest,
            t->mean / t->n, t->n);
    CHECK(t->n > 4000 && t->tightest > 0.9 && t->mean > 0.1 * t->n);
  }
  fprintf(stderr, "held %d\n", held);
  CHECK(held > 10000);
  take_down(&b);
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

/* ---- velocities ---- */

/* Two velocities that each change by 0.6 of what may be hold alone, and not together, whatever their signs; the same of turns past a ring that
 * moves across. */
static void test_speeds_add_up(const trb_system *system)
{
  static const int velocities[] = {TRB_ROLLER_v_r, TRB_ROLLER_v_t, TRB_ROLLER_v_z, TRB_ROLLER_omega_n, TRB_ROLLER_omega_t, TRB_ROLLER_omega_a};
  const trb_params     *p = &system->model->params;
  const double          reach = p->total_length + p->roller_diameter, from[TRB_ROLLER_SIZE] = {0}, speed = 1e-3;
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

/* ---- rollers in their pockets ---- */

/* Lower bounds of a roller's gaps at a state, whether its pocket pushes, and whether these are heights over the planes of all faces. */
static trb_gaps gaps_at(trb_dynamics *d, int roller, const double *y, int *touches, int *heights)
{
  trb_load     load = {0};
  trb_counters counters = {0};
  trb_dynamics_pose_hub(d, y);
  trb_dynamics_pose_roller(d, roller, y + trb_state_roller(d->system, roller));
  const trb_instant at = trb_dynamics_instant(d);
  const trb_gaps    gaps = trb_contact_pocket_of(d->model, &d->system->pairs[TRB_PAIR_pocket], &at, roller, &counters, &load, NULL, NULL);
  *touches = trb_norm(load.on_b.force) > 0.0 || counters.pocket_nodes > 0;
  *heights = counters.pocket_culled == counters.pocket_tests;
  return gaps;
}

/* So that each coordinate alone moves surfaces by some tens of micrometres. */
static const double pocket_unit[TRB_PLACE_OF_ROLLER + TRB_PLACE_OF_BODY] = {2e-5, 5e-4, 2e-5, 1e-3, 1e-3, 2e-5,
                                                                            2e-5, 2e-5, 5e-4, 5e-4, 5e-4};

/* From a state without contact, on along a random direction of one coordinate or of all, until the roller touches. */
static void walk(bench *b, const double *start, tried *of, int *held, int *reached)
{
  const trb_system *system = b->system;
  const trb_model  *m = system->model;
  trb_arms          arms[TRB_N_GAPS];
  trb_pair_pocket.arms(m, &system->pairs[TRB_PAIR_pocket], arms);
  for (int j = 0; j < m->n_rollers; j++) {
    const int first = trb_state_roller(system, j), cage = rig_cage(system), alone = rig_random(&seed) > 0.0;
    const int only = (int)(11.0 * (0.5 + 0.5 * rig_random(&seed)));
    double    direction[11], y[MOST];
    trb_bound c;
    int       touches, heights, now_heights;
    for (int i = 0; i < 11; i++) direction[i] = alone && i != only ? 0.0 : pocket_unit[i] * rig_random(&seed);
    memcpy(y, start, sizeof y);
    const trb_gaps gaps = gaps_at(b->d, j, y, &touches, &heights);
    CHECK(!(trb_gaps_clear(&gaps) && touches));
    trb_bound_set(m, &c, &gaps, y + first, y + cage);
    CHECK(trb_gaps_clear(&gaps) == trb_bound_clear(&c, arms, NULL, y + first, y + cage));
    if (!trb_gaps_clear(&gaps)) continue;
    for (double along = 0.0; along < 40.0; along += 0.02) {
      for (int i = 0; i < TRB_PLACE_OF_ROLLER; i++) y[first + i] = start[first + i] + along * direction[i];
      for (int i = 0; i < TRB_PLACE_OF_BODY; i++) y[cage + i] = start[cage + i] + along * direction[TRB_PLACE_OF_ROLLER + i];
      const int      clear = trb_bound_clear(&c, arms, NULL, y + first, y + cage);
      const trb_gaps now = gaps_at(b->d, j, y, &touches, &now_heights);
      CHECK(clear == (trb_bound_left(&c, arms, NULL, y + first, y + cage) > 0.0));
      *held += clear;
      CHECK(!(clear && (touches || !trb_gaps_clear(&now))));
      if (touches) {
        ++*reached;
        break;
      }
      for (int g = 0; g < TRB_N_GAPS && heights && now_heights; g++) {
        double way = 0.0;
        for (int i = 0; i < TRB_PLACE_OF_ROLLER; i++) way += arms[g].roller[i] * fabs(along * direction[i]);
        for (int i = 0; i < TRB_PLACE_OF_BODY; i++) way += arms[g].body[i] * fabs(along * direction[TRB_PLACE_OF_ROLLER + i]);
        const double change = fabs(now.of[g] - gaps.of[g]);
        CHECK(change <= way * (1.0 + 1e-9) + 1e-15);
        if (way > 1e-9) note(&of[g], change, way);
      }
    }
  }
}

static void test_pockets(const trb_params *params)
{
  bench  b;
  double start[MOST];
  tried  of[TRB_N_GAPS] = {{0}};
  int    held = 0, reached = 0;
  if (!set_up(&b, params, 4930.0)) return;
  trb_dynamics_pose(b.d, 0.0, b.y);
  for (int trial = 0; trial < 12; trial++) {
    memcpy(start, b.y, sizeof start);
    if (trial % 3 == 0) rig_disturb(b.system, &seed, start);
    for (int i = 0; i < TRB_PLACE_OF_BODY; i++) start[rig_cage(b.system) + i] += pocket_unit[TRB_PLACE_OF_ROLLER + i] * rig_random(&seed);
    walk(&b, start, of, &held, &reached);
  }
  for (int g = 0; g < TRB_N_GAPS; g++) {
    fprintf(stderr, "pocket, %s: change over bound %.3f at most, %.3f in the mean of %d\n", g == TRB_GAP_FLANK ? "flank" : "ends",
            of[g].tightest, of[g].mean / of[g].n, of[g].n);
    CHECK(of[g].n > 1000 && of[g].tightest > 0.8);
  }
  CHECK(held > 1000 && reached > 20);
  take_down(&b);
}

/* Displacements beyond those that arms are made for, and gaps that are not a number, prove nothing. */
static void test_limits(const trb_system *system)
{
  const trb_model *m = system->model;
  const trb_gaps   near = {{1e-4, 1e-4}}, unknown = {{1e-4, (double)NAN}};
  double           roller[TRB_ROLLER_SIZE] = {0}, cage[TRB_CAGE_SIZE] = {0};
  trb_arms         arms[TRB_N_GAPS];
  trb_bound        c;
  trb_pair_pocket.arms(m, &system->pairs[TRB_PAIR_pocket], arms);
  trb_bound_set(m, &c, &near, roller, cage);
  CHECK(trb_bound_clear(&c, arms, NULL, roller, cage));
  const double moved[TRB_N_GAPS] = {0.4e-4, 1e-4};
  CHECK(!trb_bound_clear(&c, arms, moved, roller, cage));
  CHECK_NEAR(trb_bound_left(&c, arms, moved, roller, cage), 0.0, 1e-18);
  trb_bound_set(m, &c, &unknown, roller, cage);
  CHECK(!trb_bound_clear(&c, arms, NULL, roller, cage));
  trb_bound_set(m, &c, &near, roller, cage);
  cage[TRB_CAGE_psi] = NAN;
  CHECK(!trb_bound_clear(&c, arms, NULL, roller, cage));
  cage[TRB_CAGE_psi] = 0.0, cage[TRB_CAGE_x] = 1.0;
  trb_bound_set(m, &c, &near, roller, cage);
  CHECK(!trb_bound_clear(&c, arms, NULL, roller, cage));
}

/* ---- lengths ---- */

/* A turn of a body about the roller moves a face's vertex by its distance, which the arm of the same kind of face must reach. */
static void test_arms_of_pockets(const trb_system *system)
{
  const trb_model *m = system->model;
  trb_arms         arms[TRB_N_GAPS];
  trb_pair_pocket.arms(m, &system->pairs[TRB_PAIR_pocket], arms);
  for (int i = 0; i < m->first_face[m->n_rollers]; i++) {
    const trb_polygon *f = &m->faces[i].surface;
    const int          gap = m->faces[i].part == TRB_PART_FLANK ? TRB_GAP_FLANK : TRB_GAP_ENDS;
    for (int k = 0; k < f->n; k++) {
      const trb_vec3 vertex = trb_axpy(trb_axpy(f->origin, f->outline[2 * k], f->u), f->outline[2 * k + 1], f->v);
      CHECK(arms[gap].roller[TRB_ROLLER_skew] >= trb_norm(vertex) && arms[gap].roller[TRB_ROLLER_tilt] >= trb_norm(vertex));
      CHECK(arms[gap].body[TRB_CAGE_psi] >= trb_norm(vertex) + m->geometry.roller_centre_radius);
    }
  }
}

/* A cage leans about its centre of mass: as far as that is from its middle plane, to either side, its pockets are further away. */
static void test_lean(void)
{
  double lean[3][TRB_N_GAPS];
  for (int k = 0; k < 3; k++) {
    trb_arms   arms[TRB_N_GAPS];
    trb_params p = rig_params();
    p.cage_offset = 5e-3 * (k - 1);
    trb_model *m = rig_model(&p);
    trb_pair_pocket.arms(m, NULL, arms);
    for (int g = 0; g < TRB_N_GAPS; g++) {
      CHECK(arms[g].body[TRB_CAGE_skew] == arms[g].body[TRB_CAGE_tilt]);
      lean[k][g] = arms[g].body[TRB_CAGE_skew];
    }
    trb_model_free(m);
  }
  for (int g = 0; g < TRB_N_GAPS; g++) {
    CHECK_NEAR(lean[0][g] - lean[1][g], 5e-3, 1e-15);
    CHECK_NEAR(lean[2][g] - lean[1][g], 5e-3, 1e-15);
  }
}

int main(void)
{
  trb_params p = rig_params();
  p.front_rib_clearance = 20e-6;
  test_rings(&p, 3000.0);
  trb_params cylinder = rig_cylinder();
  test_rings(&cylinder, 3000.0);
  test_not_a_number();
  p = rig_params();
  test_pockets(&p);
  trb_system *system = rig_system(&p);
  test_speeds_add_up(system);
  test_limits(system);
  test_arms_of_pockets(system);
  rig_free(system);
  p.pocket_edges = 0;
  test_pockets(&p);
  p = rig_params(), p.n_slices = 8, p.cage_offset = 3e-3;
  test_pockets(&p);
  test_pockets(&cylinder);
  test_lean();
  return check_report();
}
