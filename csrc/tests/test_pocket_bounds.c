/* Bounds of gaps between rollers and their pockets: as long as one says so nothing touches, wherever bodies have moved since it was found, and no
 * gap changes by more than the bound. */
#include "motion/fast_pairs.h"

#include "check.h"
#include "rig.h"

enum { MOST = 512 };

static unsigned long long seed = 23;

/* Lower bounds of a roller's gaps at a state, whether its pocket pushes, and whether these are heights over the planes of all faces. */
static trb_gaps gaps_at(trb_dynamics *d, int roller, const double *y, int *touches, int *heights)
{
  trb_load     load = {0};
  trb_counters counters = {0};
  trb_dynamics_pose_hub(d, y);
  trb_dynamics_pose_roller(d, roller, y + trb_state_roller(d->system, roller));
  const trb_instant at = trb_dynamics_instant(d, NULL, 0);
  const trb_gaps    gaps = trb_contact_pocket_of(d->model, &d->system->pairs[TRB_PAIR_pocket], &at, roller, &counters, &load, NULL, NULL);
  *touches = trb_norm(load.on_b.force) > 0.0 || counters.pocket_nodes > 0;
  *heights = counters.pocket_culled == counters.pocket_tests;
  return gaps;
}

/* So that each coordinate alone moves surfaces by some tens of micrometres. */
static const double unit[TRB_PLACE_OF_ROLLER + TRB_PLACE_OF_BODY] = {2e-5, 5e-4, 2e-5, 1e-3, 1e-3, 2e-5, 2e-5, 2e-5, 5e-4, 5e-4, 5e-4};

/* From a state without contact, on along a random direction of one coordinate or of all, until the roller touches. */
static void walk(const trb_system *system, trb_dynamics *d, const double *start, rig_tried *of, int *held, int *reached)
{
  const trb_model *m = system->model;
  trb_arms         arms[TRB_N_GAPS];
  trb_pair_pocket.arms(m, &system->pairs[TRB_PAIR_pocket], arms);
  for (int j = 0; j < m->n_rollers; j++) {
    const int first = trb_state_roller(system, j), cage = rig_cage(system), alone = rig_random(&seed) > 0.0;
    const int only = (int)(11.0 * (0.5 + 0.5 * rig_random(&seed)));
    double    direction[11], y[MOST];
    trb_bound c;
    int       touches, heights, now_heights;
    for (int i = 0; i < 11; i++) direction[i] = alone && i != only ? 0.0 : unit[i] * rig_random(&seed);
    memcpy(y, start, sizeof y);
    const trb_gaps gaps = gaps_at(d, j, y, &touches, &heights);
    CHECK(!(trb_gaps_clear(&gaps) && touches));
    trb_bound_set(m, &c, &gaps, y + first, y + cage);
    CHECK(trb_gaps_clear(&gaps) == trb_bound_clear(&c, arms, NULL, y + first, y + cage));
    if (!trb_gaps_clear(&gaps)) continue;
    for (double along = 0.0; along < 40.0; along += 0.02) {
      for (int i = 0; i < TRB_PLACE_OF_ROLLER; i++) y[first + i] = start[first + i] + along * direction[i];
      for (int i = 0; i < TRB_PLACE_OF_BODY; i++) y[cage + i] = start[cage + i] + along * direction[TRB_PLACE_OF_ROLLER + i];
      const int      clear = trb_bound_clear(&c, arms, NULL, y + first, y + cage);
      const trb_gaps now = gaps_at(d, j, y, &touches, &now_heights);
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
        if (way > 1e-9) rig_note(&of[g], change, way);
      }
    }
  }
}

static void test_pockets(const trb_params *params)
{
  rig_bench b = rig_open(params, 4930.0);
  double    start[RIG_ROOM];
  rig_tried of[TRB_N_GAPS] = {{0}};
  int       held = 0, reached = 0;
  trb_dynamics_pose(b.d, 0.0, b.start);
  for (int trial = 0; trial < 12; trial++) {
    memcpy(start, b.start, sizeof start);
    if (trial % 3 == 0) rig_disturb(b.system, &seed, start);
    for (int i = 0; i < TRB_PLACE_OF_BODY; i++) start[rig_cage(b.system) + i] += unit[TRB_PLACE_OF_ROLLER + i] * rig_random(&seed);
    walk(b.system, b.d, start, of, &held, &reached);
  }
  for (int g = 0; g < TRB_N_GAPS; g++) {
    fprintf(stderr, "%s: change over bound %.3f at most, %.3f in the mean of %d\n", g == TRB_GAP_FLANK ? "flank" : "ends", of[g].tightest,
            of[g].mean / of[g].n, of[g].n);
    CHECK(of[g].n > 1000 && of[g].tightest > 0.8);
  }
  CHECK(held > 1000 && reached > 20);
  rig_close(&b);
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

/* A turn of a body about the roller moves a face's vertex by its distance, which the arm of the same kind of face must reach. */
static void test_arms_of_pockets(const trb_system *system)
{
  const trb_model *m = system->model;
  trb_arms         arms[TRB_N_GAPS];
  trb_pair_pocket.arms(m, &system->pairs[TRB_PAIR_pocket], arms);
  for (int i = 0; i < m->pockets.first_face[m->n_rollers]; i++) {
    const trb_polygon *f = &m->pockets.faces[i].surface;
    const int          gap = m->pockets.faces[i].part == TRB_PART_FLANK ? TRB_GAP_FLANK : TRB_GAP_ENDS;
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
    p.cage.offset = 5e-3 * (k - 1);
    trb_model *m = rig_model(&p);
    trb_pair_pocket.arms(m, &(trb_pair){.own = &m->pockets}, arms);
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
  trb_params  p = rig_params();
  trb_system *system = rig_system(&p);
  test_limits(system);
  test_arms_of_pockets(system);
  rig_free(system);
  test_lean();
  test_pockets(&p);
  p.pocket.edges = 0;
  test_pockets(&p);
  p = rig_params(), p.effects.n_slices = 8, p.cage.offset = 3e-3;
  test_pockets(&p);
  p = rig_cylinder();
  test_pockets(&p);
  return check_report();
}
