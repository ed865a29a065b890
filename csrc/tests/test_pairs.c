/* The table of pairs drives everything: a row that is taken out is gone from forces, margins, Jacobian, records, peaks and audit alike,
 * and nothing else changes. */
#include <stdlib.h>

#include "check.h"
#include "motion/equilibrium.h"
#include "motion/peak_look.h"
#include "rig.h"
#include "stepping/jacobian.h"

enum { MOST = 512, MOST_FIELDS = 4096 };

static unsigned long long seed = 17;

/* All that is seen of a state by a model with some rows only. */
typedef struct seen {
  double     rates[MOST], record[MOST_FIELDS], peaks[MOST_FIELDS];
  trb_loads *loads;
  trb_loads  hub;
  trb_arrow *arrow;
  int        bounds; /* pairs whose interference has a bound */
} seen;

/* A cage is guided by one land at most. */
static int guidance = TRB_GUIDANCE_INNER_LAND;

static trb_params params_of_test(void)
{
  trb_params p = rig_params();
  p.effects.damping = 1, p.effects.rolling_pressure_force = 1, p.rib.front_clearance = 5e-6, p.effects.oil_fill = 0.3,
  p.effects.guidance = guidance;
  p.cage.face_inner = 42.6e-3, p.cage.face_outer = 45.5e-3, p.pocket.film = 20e-6;
  return p;
}

/* Every pair touches somewhere: some rollers stand at the front rib, the others at the back one; the cage is against its rollers. */
static trb_motion *make_state(double *y)
{
  const trb_params p = params_of_test();
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  const double     speed = 100.0 * TRB_PI;
  trb_motion      *motion = rig_motion(rig_state(system, 4930.0, speed, y), speed);
  rig_disturb(system, &seed, y);
  for (int j = 0; j < m->n_rollers; j += 3) y[trb_state_roller(system, j) + TRB_ROLLER_z] -= 10e-6;
  rig_free(system);
  return motion;
}

/* bits: of the rows to leave out. */
static void leave_out(trb_system *system, unsigned bits)
{
  for (int i = 0; i < system->n_pairs; i++)
    if (bits >> i & 1U) system->pairs[i].on = 0;
}

static void look(const trb_motion *motion, const double *y, unsigned left_out, seen *s)
{
  const trb_params p = params_of_test();
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  trb_peak_look   *peaks;
  leave_out(system, left_out);
  memset(s, 0, sizeof *s);
  s->loads = calloc((size_t)m->n_rollers, sizeof *s->loads);
  trb_dynamics *d = rig_dynamics(system, motion);
  trb_detail   *detail = rig_detail(system);
  trb_jacobian *jac = rig_jacobian(system, motion);
  if (!CHECK(trb_arrow_create(m->n_rollers, system->layout.hub_width, &s->arrow, NULL) == TRB_OK)) exit(1);
  if (!CHECK(trb_peak_look_create(system, motion, "scalar", &peaks, NULL) == TRB_OK)) exit(1);
  if (!CHECK(trb_record_offset(system, TRB_N_FIELDS) <= MOST_FIELDS && trb_peak_look_sizes(system).all <= MOST_FIELDS)) exit(1);
  trb_rhs(d, NULL, 0.01, y, s->rates);
  trb_record_fill(d, NULL, 0.01, y, detail, s->record);
  memcpy(s->loads, d->loads, (size_t)m->n_rollers * sizeof *s->loads);
  s->hub = d->hub;
  trb_jacobian_fill(jac, 0.01, y, 1, s->arrow);
  trb_peak_look_at(peaks, 0.01, y, s->peaks);
  s->bounds = trb_ring_arms_of(system).n;
  trb_peak_look_free(peaks);
  trb_jacobian_free(jac);
  trb_detail_free(detail);
  trb_dynamics_free(d);
  rig_free(system);
}

static void forget(seen *s)
{
  free(s->loads);
  trb_arrow_free(s->arrow);
}

/* What is known of a row. */
static const trb_pair *pair_of(int row)
{
  static trb_system *known;
  if (known == NULL) {
    const trb_params p = params_of_test();
    known = rig_system(&p);
  }
  return &known->pairs[row];
}

static int is_hub(int row) { return pair_of(row)->kind->between != NULL; }

/* Pairs without a roller whose bodies touch have fields and peaks of the land. */
static int is_land(int row) { return is_hub(row) && pair_of(row)->kind->approach != NULL; }

/* Whether the bodies of a row touch: only then there is an interference. */
static int is_contact(int row)
{
  return pair_of(row)->kind->contact != TRB_CONTACT_NONE || pair_of(row)->kind->touch != NULL || is_land(row);
}

/* a - b = c - d within a share of the largest of the four, and how much a pair makes of it. */
static double check_share(const char *what, double a, double b, double c, double d, double share, double floor)
{
  const double largest = fmax(fmax(fabs(a), fabs(b)), fmax(fabs(c), fabs(d)));
  if (!CHECK_NEAR((a - b) - (c - d), 0.0, share * largest + floor)) printf("  %s: %g %g %g %g\n", what, a, b, c, d);
  return fabs(c - d) > share * largest + floor ? fabs(c - d) : 0.0;
}

/* Rates are affine in forces: what a row makes is the same whatever the other rows do. */
static void check_rates(const seen *full, const seen *out, const seen *alone, const seen *none, int size)
{
  double made = 0.0;
  for (int i = 0; i < size; i++) made += check_share("rate", full->rates[i], out->rates[i], alone->rates[i], none->rates[i], 1e-9, 1e-6);
  CHECK(made > 0.0);
}

/* Entries of a block, a row of the state for each i, a column for each c. */
#define CHECK_BLOCK(size, entry) \
  for (int i = 0; i < (size); i++) { \
    double largest = 0.0; \
    for (int c = 0; c < (size); c++) largest = fmax(largest, fabs(full->arrow->entry)); \
    for (int c = 0; c < (size); c++) { \
      const double with = alone->arrow->entry, without = none->arrow->entry; \
      (void)check_share("slope", full->arrow->entry, out->arrow->entry, with, without, 1e-3, 1e-5 * largest); \
      made += fabs(with - without) > 1e-3 * fmax(fabs(with), fabs(without)) + 1e-3; \
    } \
  }

static void check_jacobian(int row, const seen *full, const seen *out, const seen *alone, const seen *none, int n)
{
  double made = 0.0;
  if (is_hub(row)) {
    CHECK_BLOCK(TRB_CAGE_SIZE, hub[c * full->arrow->room + i])
  } else {
    for (int j = 0; j < n; j++) CHECK_BLOCK(TRB_NR, rollers[j].own[c][i])
  }
  CHECK(made > 0.0);
}

/* The row's own fields are there with it and zero without it; those of the other rows are as they were. */
static void check_records(const trb_system *system, int row, const seen *full, const seen *out)
{
  const char  *name = is_land(row) ? "land" : pair_of(row)->name;
  const size_t length = strlen(name);
  double       made = 0.0;
  for (int f = 0; f < TRB_N_FIELDS; f++) {
    const trb_field_info *field = &trb_field_table[f];
    const int             from = trb_record_offset(system, f), to = trb_record_offset(system, f + 1);
    const int             land = strncmp(field->name, "land_", 5) == 0;
    const int             contact = strcmp(field->group, "contacts") == 0 || strcmp(field->group, "pocket") == 0 || land;
    const int             own = contact && strncmp(field->name, name, length) == 0 && field->name[length] == '_';
    for (int i = from; i < to && contact; i++) {
      made += own ? fabs(full->record[i]) : 0.0;
      CHECK(out->record[i] == (own ? 0.0 : full->record[i]));
    }
  }
  CHECK(made > 0.0 || !is_contact(row));
}

/* Losses, elastic energy and torques are sums over rows. */
static void check_audit(const trb_system *system, const seen *full, const seen *out, const seen *alone)
{
  static const char *const groups[] = {"power", "torque", "energy"};
  double                   made = 0.0;
  for (int f = 0; f < TRB_N_FIELDS; f++) {
    const trb_field_info *field = &trb_field_table[f];
    const int             at = trb_record_offset(system, f);
    int                   summed = strcmp(field->name, "kinetic_energy") != 0;
    int                   found = strcmp(field->name, "ring_force") == 0 || strcmp(field->name, "ring_moment") == 0;
    for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++) found |= strcmp(field->group, groups[g]) == 0;
    summed &= found && strncmp(field->name, "work_", 5) != 0 && strncmp(field->name, "loss_", 5) != 0;
    for (int i = at; i < trb_record_offset(system, f + 1) && summed; i++)
      made += check_share(field->name, full->record[i], out->record[i], alone->record[i], 0.0, 1e-9, 1e-9);
  }
  CHECK(made > 0.0);
}

/* Wrenches, elastic energy and powers of all pairs without a roller. */
static void check_hub(int row, const seen *full, const seen *out, const seen *alone)
{
  enum { NUMBERS = sizeof(trb_loads) / sizeof(double) };
  const double *a = (const double *)&full->hub, *b = (const double *)&out->hub, *c = (const double *)&alone->hub;
  for (int i = 0; i < NUMBERS; i++) CHECK_NEAR(a[i], b[i] + c[i], 1e-12 * (fabs(b[i]) + fabs(c[i])));
  CHECK((trb_norm(alone->hub.on[pair_of(row)->b].force) > 1.0) == is_land(row));
  CHECK(!is_land(row) || alone->hub.elastic > 0.0);
  CHECK(!is_hub(row) || trb_norm(alone->hub.on[pair_of(row)->b].moment) > 1e-4);
}

static void check_loads(const trb_model *m, int row, const seen *full, const seen *out, const seen *alone)
{
  double elastic = 0.0, force = 0.0, moment = 0.0;
  for (int j = 0; j < m->n_rollers; j++) {
    const trb_loads *a = &full->loads[j], *b = &out->loads[j], *c = &alone->loads[j];
    CHECK_NEAR(a->elastic, b->elastic + c->elastic, 1e-12 * a->elastic);
    CHECK_NEAR(trb_norm(trb_sub(trb_sub(a->roller.force, b->roller.force), c->roller.force)), 0.0,
               1e-9 * (trb_norm(b->roller.force) + trb_norm(c->roller.force)) + 1e-9);
    elastic += c->elastic;
    force += trb_norm(c->roller.force);
    moment += trb_norm(c->roller.moment);
    if (pair_of(row)->kind->contact == TRB_CONTACT_NONE) continue;
    CHECK(b->margin[row] == TRB_NO_CONTACT && c->margin[row] == a->margin[row] && a->margin[row] < TRB_NO_CONTACT);
  }
  if (!is_hub(row)) CHECK(is_contact(row) ? elastic > 0.0 && force > 1.0 : force > 1.0 || (force == 0.0 && moment > 1e-4));
  CHECK(full->bounds == out->bounds + (pair_of(row)->kind->contact != TRB_CONTACT_NONE) && alone->bounds == full->bounds - out->bounds);
}

/* Whose peaks a quantity is. */
static int is_peak_of(int quantity, int row)
{
  if (quantity == TRB_PEAK_pocket_force) return row == TRB_PAIR_pocket;
  const int pair = trb_field_table[trb_peak_quantities[quantity].field].pair;
  return pair < 0 ? is_land(row) : pair == row;
}

/* Loads among the peaks: gone with the row. */
static void check_peaks(const trb_system *system, int row, const seen *full, const seen *out)
{
  double made = 0.0;
  for (int q = 0; q < TRB_N_PEAK_QUANTITIES; q++) {
    if (q >= TRB_PEAK_outer_pressure && q != TRB_PEAK_land_force) continue;
    for (int i = trb_peak_look_offset(system, q); i < trb_peak_look_offset(system, q + 1); i++) {
      made += is_peak_of(q, row) ? full->peaks[i] : 0.0;
      CHECK(out->peaks[i] == (is_peak_of(q, row) ? 0.0 : full->peaks[i]));
    }
  }
  CHECK(made > 0.0 || !is_contact(row));
}

/* Gives the rows that were tried, bit by row. */
static unsigned test_rows(void)
{
  double           y[MOST];
  trb_motion      *motion = make_state(y);
  const trb_params p = params_of_test();
  trb_system      *system = rig_system(&p);
  const trb_model *m = system->model;
  static seen      full, none, out, alone;
  const unsigned   all = (1U << TRB_N_PAIRS) - 1U;
  unsigned         tried = 0;
  look(motion, y, 0, &full);
  look(motion, y, all, &none);
  for (int row = 0; row < TRB_N_PAIRS; row++) {
    if (!system->pairs[row].on) continue;
    tried |= 1U << row;
    look(motion, y, 1U << row, &out);
    look(motion, y, all & ~(1U << row), &alone);
    check_rates(&full, &out, &alone, &none, trb_state_size(system));
    check_jacobian(row, &full, &out, &alone, &none, m->n_rollers);
    check_loads(m, row, &full, &out, &alone);
    check_hub(row, &full, &out, &alone);
    check_records(system, row, &full, &out);
    check_audit(system, &full, &out, &alone);
    check_peaks(system, row, &full, &out);
    for (int j = 0; j < m->n_rollers; j++)
      if (pair_of(row)->kind->touch != NULL) CHECK(out.arrow->borders[j].parts == 0U);
    forget(&out);
    forget(&alone);
  }
  forget(&full);
  forget(&none);
  rig_free(system);
  trb_motion_free(motion);
  return tried;
}

static void run(const trb_params *params, unsigned left_out, const trb_motion *motion, const double *start, double *end)
{
  trb_system        *system = rig_system(params);
  const trb_settings settings = rig_settings();
  trb_simulation    *s;
  leave_out(system, left_out);
  if (!CHECK(rig_create(system, motion, "bdf", "scalar", &settings, 0.0, start, &s, NULL) == TRB_OK)) exit(1);
  for (int i = 0; i < 60; i++) CHECK(trb_simulation_step(s, NULL) == TRB_OK);
  memcpy(end, s->integrator.y, (size_t)trb_state_size(system) * sizeof *end);
  trb_simulation_free(s);
  rig_free(system);
}

/* Where an effect of the scene switches a pair off, a run is the same to the bit without the pair's row. */
static void test_switches(void)
{
  double      y[MOST], with[MOST] = {0}, without[MOST] = {0}, row[MOST] = {0};
  trb_motion *motion = make_state(y);
  for (int k = 0; k < 3; k++) {
    trb_params     on = params_of_test(), off = on;
    const unsigned rows[] = {1U << TRB_PAIR_rib, 1U << TRB_PAIR_front_rib, 1U << TRB_PAIR_pocket};
    if (k == 0) off.effects.back_rib = 0;
    if (k == 1) off.effects.front_rib = 0;
    if (k == 2) off.pocket.bars = off.pocket.ends = 0;
    run(&on, 0, motion, y, with);
    run(&off, 0, motion, y, without);
    run(&on, rows[k], motion, y, row);
    CHECK(memcmp(row, without, sizeof row) == 0);
    CHECK(memcmp(row, with, sizeof row) != 0);
  }
  trb_motion_free(motion);
}

/* Without the pair that seats rollers the equilibrium is that of a bearing without a back-face rib. */
static void test_equilibrium(void)
{
  trb_params       off = rig_params();
  const trb_params on = rig_params();
  double           angles[12], rollers[2][12 * TRB_ROLLER_FREEDOMS] = {{0}}, loads[2][36];
  off.effects.back_rib = 0;
  for (int k = 0; k < 2; k++) {
    trb_system      *system = rig_system(k == 0 ? &off : &on);
    const trb_model *m = system->model;
    trb_equilibrium e = {.load = {0, 0, -4930, 0, 0}, .fixed = {0, 0, 0, 1, 1}, .angles = angles, .rollers = rollers[k], .loads = loads[k]};
    for (int j = 0; j < 12; j++) angles[j] = trb_nominal_angle(m, j);
    if (k == 1) leave_out(system, 1U << TRB_PAIR_rib);
    CHECK(trb_equilibrium_solve(system, &e, NULL) == TRB_OK);
    rig_free(system);
  }
  CHECK(memcmp(rollers[0], rollers[1], sizeof rollers[0]) == 0 && memcmp(loads[0], loads[1], sizeof loads[0]) == 0);
  for (int j = 0; j < 12; j++) CHECK(loads[1][3 * j] > 0.0 && loads[1][3 * j + 2] == 0.0);
}

/* Without the row of its land a cage that is guided by one ring moves as without the row of one that is guided by the other. */
static void test_guidance(void)
{
  double      y[MOST], inner[MOST] = {0}, outer[MOST] = {0}, guided[MOST] = {0};
  trb_params  p = params_of_test();
  trb_motion *motion = make_state(y);
  p.effects.guidance = TRB_GUIDANCE_INNER_LAND;
  run(&p, 0, motion, y, guided);
  run(&p, 1U << TRB_PAIR_inner_land, motion, y, inner);
  p.effects.guidance = TRB_GUIDANCE_OUTER_LAND;
  run(&p, 1U << TRB_PAIR_outer_land, motion, y, outer);
  CHECK(memcmp(inner, outer, sizeof inner) == 0);
  CHECK(memcmp(inner, guided, sizeof inner) != 0);
  trb_motion_free(motion);
}

/* Each loss and each share of the torque is booked by some pair, or by a body, as a free ring or an elastic cage. */
static void test_bookings(void)
{
  int        losses[TRB_N_LOSSES] = {0}, torques[TRB_N_TORQUES] = {0};
  trb_params p = rig_params();
  p.inner_ring.free = p.inner_ring.mass = p.inner_ring.inertia_axial = p.inner_ring.inertia_transverse = p.cage.n_modes = 1.0;
  trb_system *with_losses = rig_system(&p);
  for (int b = 0; b < with_losses->n_bodies; b++)
    if (with_losses->bodies[b].loss > 0) losses[with_losses->bodies[b].loss - 1]++;
  rig_free(with_losses);
  for (int row = 0; row < TRB_N_PAIRS; row++)
    for (int by = 0; by < TRB_N_MECHANISMS; by++) {
      const int loss = pair_of(row)->books.loss[by], torque = pair_of(row)->books.torque[by];
      if (loss > 0) losses[loss - 1]++;
      if (torque > 0) torques[torque - 1]++;
    }
  for (int k = 0; k < TRB_N_LOSSES; k++) CHECK(losses[k] > 0);
  for (int k = 0; k < TRB_N_TORQUES; k++) CHECK(torques[k] > 0);
}

/* A system whose rows do not fit together is refused, and the message says which row. */
static void test_refused(void)
{
  const trb_params p = params_of_test();
  trb_message      message = {TRB_OK, ""};
  trb_system      *system = rig_system(&p);
  const trb_system good = *system;
  /* a mechanism that is booked nowhere, in a row that acts */
  system->pairs[TRB_PAIR_rib].books.loss[TRB_BY_DAMPING] = 0;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pair rib loses energy by damping, which is booked nowhere");
  system->pairs[TRB_PAIR_rib].on = 0;
  CHECK(trb_system_finish(system, &message) == TRB_OK);
  *system = good;
  /* a loss for which a roller's part of the right-hand side has no room, and one that the state does not have */
  system->pairs[TRB_PAIR_rib].books.loss[TRB_BY_SLIDING] = TRB_BOOK(TRB_LOSS_land);
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pair rib loses energy by sliding, which is booked nowhere");
  *system = good;
  system->pairs[TRB_PAIR_pocket].books.torque[TRB_BY_ROLLING] = TRB_BOOK(TRB_TORQUE_rolling);
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pair pocket books what is lost by rolling, and loses nothing by it");
  *system = good;
  /* a contact that would be followed across its onset, or whose peaks nobody could tell; rows that are not there */
  const trb_pair_kind *const whole = system->pairs[TRB_PAIR_rib].kind;
  trb_pair_kind              part[2] = {*whole, *whole};
  part[0].arms = NULL, part[1].look = NULL;
  for (int i = 0; i < 2; i++) {
    system->pairs[TRB_PAIR_rib].kind = &part[i];
    CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
    CHECK_SAYS(message.text, "pair rib: its kind 'spherical end on a conical rib' is a contact of a roller with a ring");
    *system = good;
  }
  system->bodies[TRB_BODY_OIL].kind = NULL;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "has no row in this system");
  *system = good;
  system->surfaces[system->pairs[TRB_PAIR_rib].surface[1]].name = NULL;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pair rib: surface");
  *system = good;
  /* surfaces */
  system->pairs[TRB_PAIR_rib].surface[1] = system->pairs[TRB_PAIR_outer].surface[1];
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "does not have the shape that a pair of the kind 'spherical end on a conical rib' needs there");
  *system = good;
  system->surfaces[system->pairs[TRB_PAIR_pocket].surface[1]].body = TRB_N_BODIES;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "surface pockets: body 4: must be from -1");
  *system = good;
  system->surfaces[system->pairs[TRB_PAIR_pocket].surface[1]].body = TRB_BODY_OUTER_RING;
  CHECK(trb_system_finish(system, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pair pocket: a pair that comes and goes with impacts needs a body with coordinates");
  *system = good;
  /* a second row of pockets has room of its own in details */
  CHECK(system->n_pairs < TRB_MOST_PAIRS);
  system->pairs[system->n_pairs] = system->pairs[TRB_PAIR_pocket];
  system->pairs[system->n_pairs++].name = "second pocket";
  CHECK(trb_system_finish(system, &message) == TRB_OK);
  CHECK(system->pairs[TRB_PAIR_pocket].slots == 0);
  CHECK(system->pairs[system->n_pairs - 1].slots == system->model->n_rollers * system->model->n_slots);
  *system = good;
  rig_free(system);
}

int main(void)
{
  test_bookings();
  test_refused();
  unsigned tried = test_rows();
  guidance = TRB_GUIDANCE_OUTER_LAND;
  tried |= test_rows();
  CHECK(tried == (1U << TRB_N_TAPERED_PAIRS) - 1U);
  guidance = TRB_GUIDANCE_ROLLERS;
  test_switches();
  test_guidance();
  test_equilibrium();
  return check_report();
}
