#include "motion/peak_look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/kernels.h"
#include "motion/bound.h"
#include "motion/fast_pairs.h"

const trb_peak_quantity trb_peak_quantities[TRB_N_PEAK_QUANTITIES] = {
#define TRB_PEAK_QUANTITY(name, field, sense) {TRB_FIELD_AT_##field, TRB_PEAK_##sense},
    TRB_PEAK_QUANTITIES(TRB_PEAK_QUANTITY)
#undef TRB_PEAK_QUANTITY
};

/* After so many bounds in a row that did not hold 2^4 - 1 evaluations go by without. */
enum { MOST_FAILED = 5 };

struct trb_peak_look {
  trb_model     normal; /* the model without friction; its arrays are those of the model */
  trb_system    system; /* of `normal` */
  trb_dynamics *d;      /* of that system */
  trb_detail   *detail; /* of ribs */
  /* how far what was looked at holds, n_rollers each: interferences of every pair with a ring, and velocities of every batch */
  trb_bound       *bounds;
  trb_speed_bound *speeds;
  trb_arms         arms[TRB_MOST_PAIRS];
  int              reads[TRB_MOST_PAIRS][TRB_N_PEAK_QUANTITIES], n_reads[TRB_MOST_PAIRS]; /* quantities of each pair's contacts */
  int             *known;                                                                 /* [batch][roller]: looked at */
  /* the same: whether bounds were set where the contacts were evaluated last, how often in a row bounds did not hold then, and how many evaluations go
   * by before they are set again */
  int       *bounded, *failed, *waits;
  int       *posed; /* per roller: its pose is that of this look */
  int        offset[TRB_N_PEAK_QUANTITIES + 1];
  trb_memory memory; /* of all arrays */
};

int trb_peak_look_offset(const trb_system *s, int quantity)
{
  int offset = 0;
  for (int i = 0; i < quantity; i++) offset += trb_field_size(s, trb_peak_quantities[i].field);
  return offset;
}

#define ONE(name, field, sense) +1
trb_peak_sizes trb_peak_look_sizes(const trb_system *s)
{
  return (trb_peak_sizes){trb_peak_look_offset(s, TRB_PEAK_pocket_force + 1), trb_peak_look_offset(s, 0 TRB_PEAK_LOADS(ONE)),
                          trb_peak_look_offset(s, TRB_N_PEAK_QUANTITIES)};
}

trb_status trb_peak_look_create(const trb_system *system, const trb_motion *motion, const char *variant, trb_peak_look **look,
                                trb_message *message)
{
  const trb_model *m = system->model;
  const size_t     n = (size_t)m->n_rollers;
  *look = NULL;
  trb_peak_look *p = calloc(1, sizeof *p);
  if (p == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  p->normal = *m;
  p->system = *system;
  p->system.model = &p->normal;
  p->normal.friction = p->normal.pocket_friction = 0;
  p->normal.params.effects.rolling_resistance = 0.0;
  p->bounds = trb_memory_zeros(&p->memory, TRB_MOST_PAIRS * n, sizeof *p->bounds);
  p->speeds = trb_memory_zeros(&p->memory, TRB_MOST_PAIRS * n, sizeof *p->speeds);
  p->known = trb_memory_zeros(&p->memory, TRB_MOST_PAIRS * n, sizeof *p->known);
  p->bounded = trb_memory_zeros(&p->memory, TRB_MOST_PAIRS * n, sizeof *p->bounded);
  p->failed = trb_memory_zeros(&p->memory, TRB_MOST_PAIRS * n, sizeof *p->failed);
  p->waits = trb_memory_zeros(&p->memory, TRB_MOST_PAIRS * n, sizeof *p->waits);
  p->posed = trb_memory_zeros(&p->memory, n, sizeof *p->posed);
  trb_status status = p->memory.lacks ? trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks") : TRB_OK;
  if (status == TRB_OK) status = trb_dynamics_create(&p->system, motion, variant, &p->d, message);
  if (status == TRB_OK) {
    trb_looks_create(&p->normal, &p->memory, p->d->work);
    if (p->memory.lacks) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  }
  if (status == TRB_OK) status = trb_detail_create(m, system->pairs, system->n_pairs, &p->detail, message);
  if (status != TRB_OK) {
    trb_peak_look_free(p);
    return status;
  }
  trb_detail_clear(m, p->detail);
  const trb_ring_arms arms = trb_ring_arms_of(system);
  for (int i = 0; i < arms.n; i++) p->arms[arms.row[i]] = arms.of[i];
  for (int i = 0; i <= TRB_N_PEAK_QUANTITIES; i++) p->offset[i] = trb_peak_look_offset(system, i);
  for (int q = 0; q < TRB_N_PEAK_QUANTITIES; q++) {
    const int pair = trb_field_table[trb_peak_quantities[q].field].pair;
    if (pair >= 0 && p->offset[q] < p->offset[q + 1]) p->reads[pair][p->n_reads[pair]++] = q;
  }
  *look = p;
  return TRB_OK;
}

void trb_peak_look_free(trb_peak_look *look)
{
  if (look == NULL) return;
  trb_dynamics_free(look->d);
  trb_detail_free(look->detail);
  trb_memory_free(&look->memory);
  free(look);
}

void trb_peak_look_forget(trb_peak_look *look)
{
  int *const   all[] = {look->known, look->bounded, look->failed, look->waits};
  const size_t size = TRB_MOST_PAIRS * (size_t)look->normal.n_rollers * sizeof *look->known;
  for (int i = 0; i < 4; i++) memset(all[i], 0, size);
}

/* Places of the values of a quantity. */
static double *of(const trb_peak_look *p, int quantity, double *values) { return values + p->offset[quantity]; }

/* Writes a value. The largest of all is kept: of a quantity whose smallest value is wanted, that is the one with the other sign. */
static void write(const trb_peak_look *p, int quantity, int place, double value, double *values)
{
  of(p, quantity, values)[place] = trb_peak_quantities[quantity].sense == TRB_PEAK_LEAST ? -value : value;
}

void trb_peak_look_start(const trb_peak_look *p, double *values)
{
  for (int q = 0; q < TRB_N_PEAK_QUANTITIES; q++) {
    if (trb_field_table[trb_peak_quantities[q].field].pair < 0 || trb_peak_quantities[q].sense != TRB_PEAK_LEAST) continue;
    for (int i = 0; i < p->offset[q + 1] - p->offset[q]; i++) write(p, q, i, (double)INFINITY, values);
  }
}

/* Of a roller about the bearing's axis. */
static double turn_of(const trb_peak_look *p, int j, const double *y)
{
  return p->d->drive.frame_angle + trb_nominal_angle(&p->normal, j) + y[trb_state_roller(p->d->system, j) + TRB_ROLLER_psi];
}

/* Values of a roller's contacts of a batch. */
static void put(const trb_peak_look *p, const trb_batch *b, int j, double *values)
{
  const trb_model *m = &p->normal;
  for (int i = 0; i < b->n; i++) {
    const trb_contact *look = &trb_pair_contacts(m, b->pairs[i], p->detail)[j];
    const int          there = m->film && look->load > 0.0;
    for (int k = 0; k < p->n_reads[b->index[i]]; k++) {
      const int    q = p->reads[b->index[i]][k];
      const double value = *(const double *)((const char *)look + trb_field_table[trb_peak_quantities[q].field].from);
      write(p, q, j, there || trb_peak_quantities[q].sense == TRB_PEAK_MOST ? value : (double)INFINITY, values);
    }
  }
}

/* How far they hold; not each time where bounds have not held for long. */
static void bound(trb_peak_look *p, int batch, int j, const double *y)
{
  const trb_model *m = &p->normal;
  const trb_batch *b = &p->d->work->batches[batch];
  const double    *own = y + trb_state_roller(p->d->system, j), angle = turn_of(p, j, y);
  const int        at = batch * m->n_rollers + j;
  double           speed = INFINITY;
  p->bounded[at] = p->waits[at] == 0;
  if (!p->bounded[at]) {
    p->waits[at]--;
    return;
  }
  for (int i = 0; i < b->n; i++) {
    const trb_contact *look = &trb_pair_contacts(m, b->pairs[i], p->detail)[j];
    trb_bound_set_on_ring(&p->bounds[b->index[i] * m->n_rollers + j], look->way, &p->d->bodies[b->pairs[i]->b].ring, own, angle);
    speed = fmin(speed, look->speed);
  }
  trb_speed_bound_set(&p->speeds[at], speed, p->d->system, p->d->bodies, own, angle);
}

/* Whether a roller's contacts of a batch are as they were when they were looked at. */
static int holds(const trb_peak_look *p, const trb_ring_offset *offsets, int batch, int j, const double *y)
{
  const int        z = p->normal.n_rollers;
  const trb_batch *b = &p->d->work->batches[batch];
  const double    *own = y + trb_state_roller(p->d->system, j), angle = turn_of(p, j, y);
  for (int i = 0; i < b->n; i++) {
    const int row = b->index[i], ring = b->pairs[i]->b;
    /* where a ring without coordinates has moved, everything was forgotten */
    const trb_ring_pose *moved = p->system.bodies[ring].size > 0 ? &p->d->bodies[ring].ring : NULL;
    if (!trb_bound_holds_on_ring(&p->bounds[row * z + j], &p->arms[row], &offsets[ring], moved, own, angle)) return 0;
  }
  return trb_speed_bound_holds(&p->speeds[batch * z + j], p->d->system, offsets, p->d->bodies, own, angle);
}

static int rests(trb_peak_look *p, const trb_ring_offset *offsets, int batch, int j, const double *y)
{
  const int at = batch * p->normal.n_rollers + j;
  if (!p->bounded[at]) return 0;
  if (holds(p, offsets, batch, j, y)) {
    p->failed[at] = 0;
    return 1;
  }
  if (p->failed[at] < MOST_FAILED) p->failed[at]++;
  p->waits[at] = (1 << (p->failed[at] - 1)) - 1;
  return 0;
}

/* Whether they could follow what the roller has done since then. */
static int follows(trb_peak_look *p, const trb_instant *at, const trb_batch *b, int j)
{
  for (int i = 0; i < b->n; i++)
    if (!b->pairs[i]->kind->follow(&p->normal, at, b->pairs[i], j, p->d->work, TRB_PEAK_SHARE, p->detail)) return 0;
  return 1;
}

static void pose(trb_peak_look *p, int j, const double *y)
{
  if (p->posed[j]) return;
  trb_dynamics_pose_roller(p->d, j, y + trb_state_roller(p->d->system, j));
  p->posed[j] = 1;
}

/* Pairs without a roller; the poses of the bodies are kept. */
static void look_at_hub(trb_peak_look *p, double *values)
{
  if (p->d->work->n_hub > 0) trb_dynamics_hub(p->d, p->detail);
  write(p, TRB_PEAK_land_force, 0, p->detail->land.force, values);
  write(p, TRB_PEAK_land_gap, 0, p->detail->land.gap, values);
}

static void look_at_slow(trb_peak_look *p, const double *y, double *values)
{
  const trb_model *m = &p->normal;
  const int        z = m->n_rollers;
  trb_dynamics    *d = p->d;
  int              chosen[TRB_TILE_LANES];
  trb_instant      at = trb_dynamics_instant(d, chosen, 0);
  trb_ring_offset  offsets[TRB_MOST_BODIES];
  trb_ring_offsets_of(d->system, d->bodies, offsets);
  at.spin = d->spin;
  for (int i = 0; i < d->work->n_batches; i++) {
    const trb_batch *batch = &d->work->batches[i];
    if (batch->pairs[0]->kind->look == NULL) continue;
    at.n = 0;
    const int follow = batch->pairs[0]->kind->follow != NULL;
    for (int j = 0; j < z; j++) {
      const int known = p->known[i * z + j] && !d->uneven[j];
      if (known && rests(p, offsets, i, j, y)) continue;
      pose(p, j, y);
      if (known && follow && follows(p, &at, batch, j)) {
        put(p, batch, j, values);
        bound(p, i, j, y);
        continue;
      }
      memset(&d->loads[j], 0, sizeof d->loads[j]);
      chosen[at.n++] = j;
    }
    if (at.n == 0) continue;
    batch->pairs[0]->kind->look(m, &at, batch, d->work, d->loads, p->detail, TRB_PEAK_SHARE);
    for (int k = 0; k < at.n; k++) {
      put(p, batch, chosen[k], values);
      bound(p, i, chosen[k], y);
      /* what is known of a contact knows no change of the surfaces */
      p->known[i * z + chosen[k]] = !d->uneven[chosen[k]];
    }
  }
}

static void look_at_fast(trb_peak_look *p, const double *y, double *values)
{
  const trb_model *m = &p->normal;
  trb_detail       forces = *p->detail;
  double          *to = of(p, TRB_PEAK_pocket_force, values);
  memset(forces.pocket_force, 0, (size_t)forces.n_slots * sizeof *forces.pocket_force);
  forces.pocket_interference = NULL;
  for (int j = 0; j < m->n_rollers; j++) {
    const unsigned near = trb_fast_near(p->d, j, y);
    if (near == 0) continue;
    pose(p, j, y);
    for (int f = 0; f < p->d->n_fast; f++) {
      trb_load load;
      if (near >> f & 1U) (void)trb_fast_touch(p->d, f, j, y, &load, NULL, &forces);
    }
  }
  /* of the first row of pockets */
  memcpy(to, forces.pocket_force, (size_t)(m->n_rollers * m->n_slots) * sizeof *to);
}

static void look_at_places(const trb_peak_look *p, const double *y, double *values)
{
  const int    z = p->normal.n_rollers;
  const double pitch = trb_nominal_angle(&p->normal, 1);
  for (int j = 0; j < z; j++) {
    const double *own = y + trb_state_roller(p->d->system, j), *next = y + trb_state_roller(p->d->system, j + 1 < z ? j + 1 : 0);
    const double  spacing = pitch + (next[TRB_ROLLER_psi] - own[TRB_ROLLER_psi]);
    write(p, TRB_PEAK_skew, j, fabs(own[TRB_ROLLER_skew]), values);
    write(p, TRB_PEAK_spacing_largest, j, spacing, values);
    write(p, TRB_PEAK_spacing_smallest, j, spacing, values);
  }
}

static int same(trb_vec3 a, trb_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Whether a ring has the place and speed of the evaluation before. */
static int ring_rests(const trb_ring_pose *a, const trb_ring_pose *b)
{
  return same(a->centre, b->centre) && same(a->axis, b->axis) && same(a->velocity, b->velocity) && same(a->omega, b->omega);
}

/* Bounds hold with rings that have no coordinates as long as these rest. */
static void forget_bounds(trb_peak_look *look)
{
  const size_t z = (size_t)look->normal.n_rollers;
  for (int i = 0; i < look->d->work->n_batches; i++)
    if (look->d->work->batches[i].pairs[0]->kind->follow == NULL) memset(look->known + (size_t)i * z, 0, z * sizeof *look->known);
  memset(look->bounded, 0, TRB_MOST_PAIRS * z * sizeof *look->bounded);
}

void trb_peak_look_at(trb_peak_look *look, double time, const double *y, double *values)
{
  trb_ring_pose before[TRB_MOST_BODIES];
  for (int b = 0; b < look->system.n_bodies; b++) before[b] = look->d->bodies[b].ring;
  trb_dynamics_drive(look->d, time);
  for (int b = 0; b < look->system.n_bodies; b++)
    if (look->system.bodies[b].size == 0 && !ring_rests(&before[b], &look->d->bodies[b].ring)) forget_bounds(look);
  memset(look->posed, 0, (size_t)look->normal.n_rollers * sizeof *look->posed);
  trb_dynamics_pose_hub(look->d, y);
  for (int j = 0; j < look->normal.n_rollers; j++) look->d->uneven[j] = trb_dynamics_spin_roller(look->d, j, y);
  look_at_fast(look, y, values);
  look_at_hub(look, values);
  look_at_slow(look, y, values);
  look_at_places(look, y, values);
}
