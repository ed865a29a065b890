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

struct trb_peak_look {
  trb_model     normal; /* the model without friction; its arrays are those of the model */
  trb_system    system; /* of `normal` */
  trb_dynamics *d;      /* of that system */
  trb_detail   *detail; /* of ribs */
  /* how far what was looked at holds, n_rollers each: interferences of every pair with a ring, and velocities of every batch */
  trb_bound       *bounds;
  trb_speed_bound *speeds;
  trb_arms         arms[TRB_MOST_PAIRS];
  int             *posed; /* per roller: its pose is that of this look */
  int              offset[TRB_N_PEAK_QUANTITIES + 1];
  trb_memory       memory; /* of all arrays */
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
  p->posed = trb_memory_zeros(&p->memory, n, sizeof *p->posed);
  trb_status status = p->memory.lacks ? trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks") : TRB_OK;
  if (status == TRB_OK) status = trb_dynamics_create(&p->system, motion, variant, &p->d, message);
  if (status == TRB_OK) status = trb_detail_create(m, system->pairs, system->n_pairs, &p->detail, message);
  if (status != TRB_OK) {
    trb_peak_look_free(p);
    return status;
  }
  trb_detail_clear(m, p->detail);
  const trb_ring_arms arms = trb_ring_arms_of(system);
  for (int i = 0; i < arms.n; i++) p->arms[arms.row[i]] = arms.of[i];
  for (int i = 0; i <= TRB_N_PEAK_QUANTITIES; i++) p->offset[i] = trb_peak_look_offset(system, i);
  trb_peak_look_forget(p);
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
  for (int i = 0; i < TRB_MOST_PAIRS * look->normal.n_rollers; i++) look->speeds[i].length = -1.0;
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

/* A roller's contacts of a batch, looked at: values are written, and how far they hold. */
static void put(trb_peak_look *p, int batch, int j, const double *y, double *values)
{
  const trb_model *m = &p->normal;
  const trb_batch *b = &p->d->work->batches[batch];
  const double    *own = y + trb_state_roller(p->d->system, j), angle = turn_of(p, j, y);
  double           speed = INFINITY;
  for (int i = 0; i < b->n; i++) {
    const trb_contact *look = &trb_pair_contacts(m, b->pairs[i], p->detail)[j];
    trb_bound_set_on_ring(&p->bounds[b->index[i] * m->n_rollers + j], look->way, &p->d->bodies[b->pairs[i]->b].ring, own, angle);
    speed = fmin(speed, look->speed);
    for (int q = 0; q < TRB_N_PEAK_QUANTITIES; q++) {
      const trb_field_info *field = &trb_field_table[trb_peak_quantities[q].field];
      if (field->pair != b->index[i] || p->offset[q] == p->offset[q + 1]) continue;
      const double value = *(const double *)((const char *)look + field->from);
      const int    there = trb_peak_quantities[q].sense == TRB_PEAK_MOST || (m->film && look->load > 0.0);
      write(p, q, j, there ? value : (double)INFINITY, values);
    }
  }
  trb_speed_bound_set(&p->speeds[batch * m->n_rollers + j], speed, p->d->system, p->d->bodies, own, angle);
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
    for (int j = 0; j < z; j++) {
      /* what is known of a contact knows no change of the surfaces */
      if (!d->uneven[j] && holds(p, offsets, i, j, y)) continue;
      pose(p, j, y);
      memset(&d->loads[j], 0, sizeof d->loads[j]);
      chosen[at.n++] = j;
    }
    if (at.n == 0) continue;
    batch->pairs[0]->kind->look(m, &at, batch, d->work, d->loads, p->detail, TRB_PEAK_SHARE);
    for (int k = 0; k < at.n; k++) {
      put(p, i, chosen[k], y, values);
      if (d->uneven[chosen[k]]) p->speeds[i * z + chosen[k]].length = -1.0;
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
  const int z = p->normal.n_rollers;
  for (int j = 0; j < z; j++) {
    const double *own = y + trb_state_roller(p->d->system, j), *next = y + trb_state_roller(p->d->system, j + 1 < z ? j + 1 : 0);
    const double  spacing = trb_nominal_angle(&p->normal, 1) + (next[TRB_ROLLER_psi] - own[TRB_ROLLER_psi]);
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

void trb_peak_look_at(trb_peak_look *look, double time, const double *y, double *values)
{
  trb_ring_pose before[TRB_MOST_BODIES];
  for (int b = 0; b < look->system.n_bodies; b++) before[b] = look->d->bodies[b].ring;
  trb_dynamics_drive(look->d, time);
  for (int b = 0; b < look->system.n_bodies; b++)
    if (look->system.bodies[b].size == 0 && !ring_rests(&before[b], &look->d->bodies[b].ring)) trb_peak_look_forget(look);
  memset(look->posed, 0, (size_t)look->normal.n_rollers * sizeof *look->posed);
  trb_dynamics_pose_hub(look->d, y);
  for (int j = 0; j < look->normal.n_rollers; j++) look->d->uneven[j] = trb_dynamics_spin_roller(look->d, j, y);
  look_at_fast(look, y, values);
  look_at_hub(look, values);
  look_at_slow(look, y, values);
  look_at_places(look, y, values);
}
