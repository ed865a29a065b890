#include "motion/peak_look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/kernels.h"
#include "laws/line_contact.h"
#include "motion/hold.h"

const trb_peak_quantity trb_peak_quantities[TRB_N_PEAK_QUANTITIES] = {
#define TRB_PEAK_QUANTITY(name, kind, sense) {TRB_FIELD_##kind, TRB_PEAK_##sense},
    TRB_PEAK_QUANTITIES(TRB_PEAK_QUANTITY)
#undef TRB_PEAK_QUANTITY
};

/* Contacts with rings that are held each for itself. */
enum { HOLD_RACEWAYS, HOLD_RIB, HOLD_FRONT_RIB, N_HOLDS };

struct trb_peak_look {
  trb_model     normal; /* the model without friction; its arrays are those of the model */
  trb_dynamics *d;      /* of `normal` */
  trb_detail   *detail; /* of ribs */
  trb_hold     *holds;  /* of N_HOLDS kinds, n_rollers each */
  trb_hold_arms arms[N_HOLDS];
  int           on[N_HOLDS];
  int          *posed; /* per roller: its pose is that of this look */
  int           offset[TRB_N_PEAK_QUANTITIES + 1];
};

static int count(const trb_model *m, int quantity)
{
  int shape[2];
  (void)trb_field_shape(m, trb_peak_quantities[quantity].kind, shape);
  return shape[0] * shape[1];
}

int trb_peak_look_offset(const trb_model *m, int quantity)
{
  int offset = 0;
  for (int i = 0; i < quantity; i++) offset += count(m, i);
  return offset;
}

trb_peak_sizes trb_peak_look_sizes(const trb_model *m)
{
  return (trb_peak_sizes){trb_peak_look_offset(m, TRB_PEAK_pocket_force + 1), trb_peak_look_offset(m, TRB_PEAK_front_rib_load + 1),
                          trb_peak_look_offset(m, TRB_N_PEAK_QUANTITIES)};
}

trb_status trb_peak_look_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_peak_look **look,
                                trb_message *message)
{
  const size_t n = (size_t)m->n_rollers;
  *look = NULL;
  trb_peak_look *p = calloc(1, sizeof *p);
  if (p == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  p->normal = *m;
  p->normal.friction = p->normal.pocket_friction = 0;
  p->normal.params.rolling_resistance = 0.0;
  p->holds = calloc(N_HOLDS * n, sizeof *p->holds);
  p->posed = calloc(n, sizeof *p->posed);
  trb_status status = p->holds != NULL && p->posed != NULL ? TRB_OK : trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  if (status == TRB_OK) status = trb_dynamics_create(&p->normal, motion, variant, &p->d, message);
  if (status == TRB_OK) status = trb_detail_create(m, &p->detail, message);
  if (status != TRB_OK) {
    trb_peak_look_free(p);
    return status;
  }
  trb_detail_clear(m, p->detail);
  p->arms[HOLD_RACEWAYS] = trb_hold_arms_raceway(m);
  p->arms[HOLD_RIB] = trb_hold_arms_rib(m);
  p->arms[HOLD_FRONT_RIB] = trb_hold_arms_front_rib(m);
  p->on[HOLD_RACEWAYS] = 1;
  p->on[HOLD_RIB] = m->params.back_rib > 0.0;
  p->on[HOLD_FRONT_RIB] = m->params.front_rib > 0.0;
  for (int i = 0; i <= TRB_N_PEAK_QUANTITIES; i++) p->offset[i] = trb_peak_look_offset(m, i);
  trb_peak_look_forget(p);
  *look = p;
  return TRB_OK;
}

void trb_peak_look_free(trb_peak_look *look)
{
  if (look == NULL) return;
  trb_dynamics_free(look->d);
  trb_detail_free(look->detail);
  free(look->holds);
  free(look->posed);
  free(look);
}

void trb_peak_look_forget(trb_peak_look *look)
{
  for (int i = 0; i < N_HOLDS * look->normal.n_rollers; i++) look->holds[i].way = -1.0;
}

/* Places of the values of a quantity. */
static double *of(const trb_peak_look *p, int quantity, double *values) { return values + p->offset[quantity]; }

/* With the sign of quantities whose smallest value is wanted. Without a film there is none. */
static double film(const trb_model *m, double load, double parameter) { return m->film && load > 0.0 ? -parameter : -(double)INFINITY; }

/* Change of velocity that films and damping may bear. */
static double speed_share(const trb_model *m, double mean_speed)
{
  double speed = m->film ? TRB_PEAK_SHARE * mean_speed : (double)INFINITY;
  if (m->params.damping > 0.0 && m->params.damping_race > 0.0) speed = fmin(speed, TRB_PEAK_SHARE / m->params.damping_race);
  return speed;
}

/* Of a roller about the bearing's axis. */
static double turn_of(const trb_peak_look *p, int j, const double *y)
{
  return p->d->drive.frame_angle + trb_nominal_angle(&p->normal, j) + y[trb_state_roller(j) + TRB_ROLLER_psi];
}

static void hold(trb_peak_look *p, int kind, int j, const double *y, double way, double speed)
{
  trb_hold_set(y + trb_state_roller(j), turn_of(p, j, y), way, speed, &p->holds[kind * p->normal.n_rollers + j]);
}

static void raceways(trb_peak_look *p, const trb_instant *at, int j, const double *y, double *values)
{
  const trb_model *m = &p->normal;
  const trb_lanes *l = p->d->work->lanes;
  double           way = INFINITY, slowest = INFINITY;
  for (int race = 0; race < TRB_N_RACES; race++) {
    const int       outer = race == TRB_RACE_OUTER;
    double          load = 0.0, pressure = 0.0, parameter = 0.0, slope = 0.0;
    trb_race_output out;
    trb_contact_raceway_of(m, at, j, race, p->d->work, &out);
    for (int k = 0; out.loaded && k < m->n_nodes; k++) {
      const double q = l->load[k];
      if (!(q > 0.0)) continue;
      load += q;
      pressure = fmax(pressure, l->pressure[k]);
      slope += TRB_PALMGREN_EXPONENT * q / l->interference[k];
      slowest = fmin(slowest, l->mean_speed[k]);
      if (m->film) parameter += q * l->film_parameter[k];
    }
    way = load > 0.0 ? fmin(way, TRB_PEAK_SHARE * load / slope) : -1.0;
    of(p, outer ? TRB_PEAK_outer_load : TRB_PEAK_inner_load, values)[j] = load;
    of(p, outer ? TRB_PEAK_outer_pressure : TRB_PEAK_inner_pressure, values)[j] = pressure;
    of(p, outer ? TRB_PEAK_outer_film_parameter : TRB_PEAK_inner_film_parameter, values)[j] = film(m, load, parameter / load);
  }
  hold(p, HOLD_RACEWAYS, j, y, way, speed_share(m, slowest));
}

/* How far a point contact, with a load that goes with the interference to the power 1.5, or without a load, may go. */
static double point_way(const trb_point_detail *c)
{
  return c->interference > 0.0 ? TRB_PEAK_SHARE * c->interference / 1.5 : -c->interference;
}

static void rib(trb_peak_look *p, int j, const double *y, double *values)
{
  const trb_model        *m = &p->normal;
  const trb_point_detail *c = &p->detail->rib[j];
  const double            speed = c->load > 0.0 ? speed_share(m, c->mean_speed) : (double)INFINITY;
  of(p, TRB_PEAK_rib_load, values)[j] = c->load;
  of(p, TRB_PEAK_rib_pressure, values)[j] = c->pressure;
  of(p, TRB_PEAK_rib_film_parameter, values)[j] = film(m, c->load, c->film_parameter);
  hold(p, HOLD_RIB, j, y, point_way(c), speed);
}

static void front_rib(trb_peak_look *p, int j, const double *y, double *values)
{
  const trb_point_detail *c = &p->detail->front_rib[j];
  of(p, TRB_PEAK_front_rib_load, values)[j] = c->load;
  hold(p, HOLD_FRONT_RIB, j, y, c->interference > 0.0 ? -1.0 : point_way(c), INFINITY);
}

static void pose(trb_peak_look *p, int j, const double *y)
{
  if (p->posed[j]) return;
  trb_dynamics_pose_roller(p->d, j, y + trb_state_roller(j));
  p->posed[j] = 1;
}

static void look_at_rings(trb_peak_look *p, const double *y, double *values)
{
  const trb_model *m = &p->normal;
  const int        z = m->n_rollers;
  trb_dynamics    *d = p->d;
  trb_instant      at = trb_dynamics_instant(d);
  int              chosen[TRB_TILE_LANES];

  const trb_hold_ring ring = trb_hold_ring_of(m, &d->drive);
  at.chosen = chosen;
  for (int kind = 0; kind < N_HOLDS; kind++) {
    if (!p->on[kind]) continue;
    at.n = 0;
    for (int j = 0; j < z; j++) {
      if (trb_hold_holds(&p->holds[kind * z + j], &p->arms[kind], &ring, y + trb_state_roller(j), turn_of(p, j, y))) continue;
      pose(p, j, y);
      memset(&d->loads[j], 0, sizeof d->loads[j]);
      chosen[at.n++] = j;
    }
    if (at.n == 0) continue;
    if (kind == HOLD_RIB) trb_contact_rib(m, &at, d->work, d->loads, p->detail);
    if (kind == HOLD_FRONT_RIB) trb_contact_front_rib(m, &at, d->work, d->loads, p->detail);
    for (int k = 0; k < at.n; k++) {
      if (kind == HOLD_RACEWAYS) raceways(p, &at, chosen[k], y, values);
      if (kind == HOLD_RIB) rib(p, chosen[k], y, values);
      if (kind == HOLD_FRONT_RIB) front_rib(p, chosen[k], y, values);
    }
  }
}

static void look_at_pockets(trb_peak_look *p, const double *y, double *values)
{
  const trb_model  *m = &p->normal;
  const trb_instant at = trb_dynamics_instant(p->d);
  trb_detail        forces = *p->detail;
  double           *to = of(p, TRB_PEAK_pocket_force, values);
  memset(to, 0, (size_t)(m->n_rollers * m->n_slots) * sizeof *to);
  if (at.cage == NULL) return;
  trb_cage_pose_unpack(m, &p->d->drive, y + trb_state_cage(m), &p->d->cage);
  forces.pocket_force = to;
  forces.pocket_interference = NULL;
  for (int j = 0; j < m->n_rollers; j++) {
    trb_roller_load load;
    if (trb_dynamics_clear(p->d, j, y)) continue;
    pose(p, j, y);
    const trb_pocket_gaps gaps = trb_contact_pocket_of(m, &at, j, &p->d->work->counters, &load, NULL, &forces);
    trb_clearance_set(m, &p->d->clearances[j], &gaps, y + trb_state_roller(j), y + trb_state_cage(m));
  }
}

static void look_at_places(const trb_peak_look *p, const double *y, double *values)
{
  const int z = p->normal.n_rollers;
  for (int j = 0; j < z; j++) {
    const double *own = y + trb_state_roller(j), *next = y + trb_state_roller((j + 1) % z);
    const double  spacing = trb_nominal_angle(&p->normal, 1) + (next[TRB_ROLLER_psi] - own[TRB_ROLLER_psi]);
    of(p, TRB_PEAK_skew, values)[j] = fabs(own[TRB_ROLLER_skew]);
    of(p, TRB_PEAK_spacing_largest, values)[j] = spacing;
    of(p, TRB_PEAK_spacing_smallest, values)[j] = -spacing;
  }
}

static int same(trb_vec3 a, trb_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Whether the ring stands where it stood at the look before, and turns as fast. */
static int ring_rests(const trb_drive *a, const trb_drive *b)
{
  return same(a->inner.apex, b->inner.apex) && same(a->inner.axis, b->inner.axis) && same(a->inner.velocity, b->inner.velocity) &&
         same(a->inner.omega, b->inner.omega);
}

void trb_peak_look_at(trb_peak_look *look, double time, const double *y, double *values)
{
  const trb_drive before = look->d->drive;
  trb_motion_at(look->d->motion, &look->normal, time, &look->d->drive);
  if (!ring_rests(&before, &look->d->drive)) trb_peak_look_forget(look);
  memset(look->posed, 0, (size_t)look->normal.n_rollers * sizeof *look->posed);
  look_at_pockets(look, y, values);
  look_at_rings(look, y, values);
  look_at_places(look, y, values);
}
