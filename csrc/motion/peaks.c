#include "motion/peaks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/kernels.h"
#include "motion/peak_track.h"

enum {
#define TRB_PEAK_QUANTITY_ENUM(name, kind, sense) TRB_PEAK_##name,
  TRB_PEAK_QUANTITIES(TRB_PEAK_QUANTITY_ENUM)
#undef TRB_PEAK_QUANTITY_ENUM
      TRB_N_PEAK_QUANTITIES
};
enum { TRB_N_PEAK_LOADS = TRB_PEAK_front_rib_load + 1 };

static const struct {
  trb_field_kind kind;
  trb_peak_sense sense;
} quantities[TRB_N_PEAK_QUANTITIES] = {
#define TRB_PEAK_QUANTITY(name, kind, sense) {TRB_FIELD_##kind, TRB_PEAK_##sense},
    TRB_PEAK_QUANTITIES(TRB_PEAK_QUANTITY)
#undef TRB_PEAK_QUANTITY
};

const trb_peak_field_info trb_peak_field_table[TRB_N_PEAK_FIELDS] = {
#define TRB_PEAK_FIELD_INFO(name, quantity, take, unit, text) {#name, unit, text, TRB_PEAK_##quantity, TRB_TAKE_##take},
    TRB_PEAK_FIELDS(TRB_PEAK_FIELD_INFO)
#undef TRB_PEAK_FIELD_INFO
};

trb_field_kind trb_peak_kind(const trb_peak_field_info *field) { return quantities[field->quantity].kind; }

const char *trb_peak_joined(const trb_peak_field_info *field)
{
  switch (field->take) {
  case TRB_TAKE_EXTREME: return quantities[field->quantity].sense == TRB_PEAK_MOST ? "largest" : "smallest";
  case TRB_TAKE_HARDEST: return "largest";
  case TRB_TAKE_TIME: return "time";
  case TRB_TAKE_MEAN: return "mean";
  case TRB_TAKE_IMPACTS:
  case TRB_TAKE_IMPULSE: return "sum";
  }
  return "";
}

static int size_of(const trb_model *m, trb_field_kind kind)
{
  int shape[2];
  (void)trb_field_shape(m, kind, shape);
  return shape[0] * shape[1];
}

int trb_peak_offset(const trb_model *m, int field)
{
  int offset = 0;
  for (int i = 0; i < field; i++) offset += size_of(m, trb_peak_kind(&trb_peak_field_table[i]));
  return offset;
}

/* Where a roller and the inner ring were when its raceways were evaluated last, and how far they may go until they are evaluated again. */
typedef struct held {
  trb_vec3 x, a, v, omega;
  trb_vec3 apex, axis, ring_v, ring_omega;
  double   way;   /* m; negative: evaluate at once */
  double   speed; /* m/s */
} held;

struct trb_peaks {
  const trb_model *model;
  trb_model        normal; /* the same without friction, which no peak needs; its arrays are those of the model */
  trb_dynamics    *d;      /* of `normal` */
  trb_detail      *detail;
  held            *held;   /* n_rollers */
  int             *chosen; /* rollers whose raceways are evaluated */
  trb_peak_sizes   n;
  int              offset[TRB_N_PEAK_QUANTITIES + 1];
  double          *block;    /* end of the last step, then both tracks, then a track and values for what is asked between */
  double          *end;      /* s */
  double          *value;    /* there */
  trb_peak_track   whole;    /* the run up to the start of the last step */
  trb_peak_track   interval; /* since the last record, up to there or to that record */
  trb_peak_track   asked;
  double          *between;
};

trb_status trb_peaks_create(const trb_model *m, const trb_motion *motion, const char *variant, trb_peaks **peaks, trb_message *message)
{
  *peaks = NULL;
  trb_peaks *p = calloc(1, sizeof *p);
  if (p == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  p->model = m;
  p->normal = *m;
  p->normal.friction = p->normal.pocket_friction = 0;
  p->normal.params.rolling_resistance = 0.0;
  for (int i = 0; i < TRB_N_PEAK_QUANTITIES; i++) p->offset[i + 1] = p->offset[i] + size_of(m, quantities[i].kind);
  p->n = (trb_peak_sizes){p->offset[1], p->offset[TRB_N_PEAK_LOADS], p->offset[TRB_N_PEAK_QUANTITIES]};
  const size_t track = (size_t)trb_peak_track_length(&p->n), all = (size_t)p->n.all;
  p->block = trb_zeros(1 + 2 * all + 3 * track, sizeof(double));
  p->held = calloc((size_t)m->n_rollers, sizeof *p->held);
  p->chosen = calloc((size_t)m->n_rollers, sizeof *p->chosen);
  trb_status status = TRB_OK;
  if (!p->block || !p->held || !p->chosen) status = trb_fail(message, TRB_ERR_MEMORY, "out of memory for peaks");
  if (status == TRB_OK) status = trb_dynamics_create(&p->normal, motion, variant, &p->d, message);
  if (status == TRB_OK) status = trb_detail_create(m, &p->detail, message);
  if (status != TRB_OK) {
    trb_peaks_free(p);
    return status;
  }
  p->end = p->block;
  p->value = p->end + 1;
  p->whole = trb_peak_track_in(&p->n, p->value + all);
  p->interval = trb_peak_track_in(&p->n, p->value + all + track);
  p->asked = trb_peak_track_in(&p->n, p->value + all + 2 * track);
  p->between = p->value + all + 3 * track;
  trb_detail_clear(m, p->detail);
  *peaks = p;
  return TRB_OK;
}

void trb_peaks_free(trb_peaks *peaks)
{
  if (peaks == NULL) return;
  trb_dynamics_free(peaks->d);
  trb_detail_free(peaks->detail);
  free(peaks->block);
  free(peaks->held);
  free(peaks->chosen);
  free(peaks);
}

static double size1(trb_vec3 v) { return fabs(v.x) + fabs(v.y) + fabs(v.z); }

/* Farthest node of a flank from the roller's centre of mass. */
static double reach(const trb_model *m, int roller)
{
  const double *centre = m->centre + (size_t)roller * (size_t)m->n_lanes;
  return fmax(fabs(centre[0]), fabs(centre[m->n_nodes - 1]));
}

/* Whether a roller has not gone so far that the loads of its raceways may have changed by more than their share.
 *
 * An interference is rho + sign (e cos - c.k sin): c from the ring's apex to a sphere's centre, k the ring's axis, e = |c - (c.k) k|. To first
 * order it changes by no more than c moves in the axial plane, plus its tangential way times the tangent's share in e, plus what a turn of k
 * moves it by. */
static int still_holds(const trb_dynamics *d, int j, const held *h)
{
  const trb_roller_pose *r = &d->rollers[j];
  const trb_ring_pose   *ring = &d->inner[j];
  if (h->way < 0.0) return 0;
  const double   arm = reach(d->model, j), far = fabs(r->x.z) + arm, out = 0.5 * r->radius;
  const trb_vec3 dx = trb_sub(r->x, h->x), da = trb_sub(r->frame.a, h->a), dp = trb_sub(ring->apex, h->apex), dk = trb_sub(ring->axis, h->axis);
  const double   aside = arm * fabs(da.y) + fabs(dp.y);
  const double   off = arm * fabs(r->frame.a.y) + fabs(ring->apex.y) + far * fabs(ring->axis.y) + aside;
  const double   way = fabs(dx.x) + fabs(dx.z) + arm * (fabs(da.x) + fabs(da.z)) + fabs(dp.x) + fabs(dp.z) + far * size1(dk) + aside * off / out;
  const double   speed = size1(trb_sub(r->v, h->v)) + (arm + d->model->params.roller_diameter) * size1(trb_sub(r->omega, h->omega)) +
                       size1(trb_sub(ring->velocity, h->ring_v)) + 2.0 * r->radius * size1(trb_sub(ring->omega, h->ring_omega));
  return way <= h->way && speed <= h->speed; /* a number that is none holds nothing */
}

/* From the loads of the nodes just evaluated: Palmgren's load goes with the interference to the power 10/9. */
static void hold(trb_peaks *p, int j)
{
  const trb_model       *m = &p->normal;
  const trb_roller_pose *r = &p->d->rollers[j];
  const trb_ring_pose   *ring = &p->d->inner[j];
  held                  *h = &p->held[j];
  *h = (held){r->x, r->frame.a, r->v, r->omega, ring->apex, ring->axis, ring->velocity, ring->omega, INFINITY, INFINITY};
  for (int race = 0; race < TRB_N_RACES; race++) {
    const double *load = trb_detail_lane(m, p->detail, TRB_LANE_load, race, j), *d = trb_detail_lane(m, p->detail, TRB_LANE_interference, race, j);
    const double *mean = trb_detail_lane(m, p->detail, TRB_LANE_mean_speed, race, j);
    double        sum = 0.0, slope = 0.0, slowest = INFINITY;
    for (int k = 0; k < m->n_nodes; k++) {
      if (!(load[k] > 0.0)) continue;
      sum += load[k];
      slope += 10.0 / 9.0 * load[k] / d[k];
      slowest = fmin(slowest, mean[k]);
    }
    h->way = slope > 0.0 ? fmin(h->way, TRB_PEAK_SHARE * sum / slope) : -1.0;
    if (m->film) h->speed = fmin(h->speed, TRB_PEAK_SHARE * slowest);
    if (m->params.damping > 0.0 && m->params.damping_race > 0.0) h->speed = fmin(h->speed, TRB_PEAK_SHARE / m->params.damping_race);
  }
}

static void look_at_raceways(trb_peaks *p, double *value)
{
  const trb_model *m = &p->normal;
  trb_instant      at = trb_dynamics_instant(p->d);
  at.n = 0;
  at.chosen = p->chosen;
  for (int j = 0; j < m->n_rollers; j++)
    if (!still_holds(p->d, j, &p->held[j])) p->chosen[at.n++] = j;
  for (int k = 0; k < at.n; k++)
    for (int race = 0; race < TRB_N_RACES; race++) {
      const double *load = trb_detail_lane(m, p->detail, TRB_LANE_load, race, p->chosen[k]);
      memset(p->detail->lanes + (load - p->detail->lanes), 0, (size_t)m->n_lanes * sizeof(double)); /* stays where there is no contact */
    }
  if (at.n > 0) trb_contact_raceway(m, &at, p->d->work, p->d->loads, p->detail);
  for (int k = 0; k < at.n; k++) {
    const int j = p->chosen[k];
    hold(p, j);
    for (int race = 0; race < TRB_N_RACES; race++) {
      const trb_race_means of = trb_record_race(m, p->detail, race, j);
      const int            outer = race == TRB_RACE_OUTER;
      value[p->offset[outer ? TRB_PEAK_outer_load : TRB_PEAK_inner_load] + j] = of.load;
      value[p->offset[outer ? TRB_PEAK_outer_pressure : TRB_PEAK_inner_pressure] + j] = of.pressure;
      value[p->offset[outer ? TRB_PEAK_outer_film_parameter : TRB_PEAK_inner_film_parameter] + j] =
          m->film && of.load > 0.0 ? -of.film_parameter : -(double)INFINITY;
    }
  }
}

static void look_at_ribs(trb_peaks *p, double *value)
{
  const trb_model  *m = &p->normal;
  const trb_instant at = trb_dynamics_instant(p->d);
  if (m->params.back_rib > 0.0) trb_contact_rib(m, &at, p->d->work, p->d->loads, p->detail);
  if (m->params.front_rib > 0.0) trb_contact_front_rib(m, &at, p->d->work, p->d->loads, p->detail);
  for (int j = 0; j < m->n_rollers; j++) {
    const trb_point_detail *rib = &p->detail->rib[j];
    value[p->offset[TRB_PEAK_rib_load] + j] = rib->load;
    value[p->offset[TRB_PEAK_rib_pressure] + j] = rib->pressure;
    value[p->offset[TRB_PEAK_rib_film_parameter] + j] = m->film && rib->load > 0.0 ? -rib->film_parameter : -(double)INFINITY;
    value[p->offset[TRB_PEAK_front_rib_load] + j] = p->detail->front_rib[j].load;
  }
}

static void look_at_pockets(trb_peaks *p, const double *y, double *value)
{
  const trb_model  *m = &p->normal;
  const trb_instant at = trb_dynamics_instant(p->d);
  trb_detail        forces = *p->detail;
  memset(value, 0, (size_t)p->n.pocket * sizeof *value);
  if (at.cage == NULL) return;
  forces.pocket_force = value + p->offset[TRB_PEAK_pocket_force];
  forces.pocket_interference = NULL;
  for (int j = 0; j < m->n_rollers; j++) {
    trb_roller_load load;
    if (trb_dynamics_clear(p->d, j, y)) continue;
    const trb_pocket_gaps gaps = trb_contact_pocket_of(m, &at, j, &p->d->work->counters, &load, NULL, &forces);
    trb_clearance_set(m, &p->d->clearances[j], &gaps, y + trb_state_roller(j), y + trb_state_cage(m));
  }
}

/* All quantities at a state. Those of raceways that are held stay. */
static void look(trb_peaks *p, double time, const double *y, double *value)
{
  const trb_model *m = &p->normal;
  const int        z = m->n_rollers;
  trb_dynamics_pose(p->d, time, y);
  memset(p->d->loads, 0, (size_t)z * sizeof *p->d->loads);
  look_at_pockets(p, y, value);
  look_at_raceways(p, value);
  look_at_ribs(p, value);
  for (int j = 0; j < z; j++) {
    const double *next = y + trb_state_roller((j + 1) % z), *own = y + trb_state_roller(j);
    const double  spacing = trb_nominal_angle(m, 1) + (next[TRB_ROLLER_psi] - own[TRB_ROLLER_psi]);
    value[p->offset[TRB_PEAK_skew] + j] = fabs(own[TRB_ROLLER_skew]);
    value[p->offset[TRB_PEAK_spacing_largest] + j] = spacing;
    value[p->offset[TRB_PEAK_spacing_smallest] + j] = -spacing;
  }
}

static void forget(trb_peaks *p)
{
  for (int j = 0; j < p->model->n_rollers; j++) p->held[j].way = -1.0;
}

void trb_peaks_begin(trb_peaks *p, double time, const double *y, double end, const double *y_end)
{
  forget(p);
  look(p, time, y, p->value);
  trb_peak_track_start(&p->n, &p->whole, time, p->value, 0);
  trb_peak_track_start(&p->n, &p->interval, time, p->value, 0);
  *p->end = time;
  if (!(end > time)) return;
  look(p, end, y_end, p->value);
  *p->end = end;
}

void trb_peaks_step(trb_peaks *p, double time, const double *y)
{
  trb_peak_track_line(&p->n, &p->whole, *p->end, p->value);
  trb_peak_track_line(&p->n, &p->interval, *p->end, p->value);
  look(p, time, y, p->value);
  *p->end = time;
}

static void write_row(const trb_peaks *p, const trb_peak_track *track, double *row)
{
  const double start = track->span[0], length = track->span[1] - start;
  for (int f = 0; f < TRB_N_PEAK_FIELDS; f++) {
    const trb_peak_field_info *field = &trb_peak_field_table[f];
    const int                  from = p->offset[field->quantity], n = p->offset[field->quantity + 1] - from;
    const double               sign = quantities[field->quantity].sense == TRB_PEAK_LEAST ? -1.0 : 1.0;
    for (int i = from; i < from + n; i++, row++) {
      switch (field->take) {
      case TRB_TAKE_EXTREME: *row = isfinite(track->most[i]) ? sign * track->most[i] : (double)NAN; break;
      case TRB_TAKE_TIME: *row = track->when[i]; break;
      case TRB_TAKE_MEAN: *row = length > 0.0 ? track->integral[i] / length : track->value[i]; break;
      case TRB_TAKE_IMPACTS: *row = track->impacts[i]; break;
      case TRB_TAKE_IMPULSE: *row = track->integral[i]; break;
      case TRB_TAKE_HARDEST: *row = track->hardest[i]; break;
      }
    }
  }
}

void trb_peaks_record(trb_peaks *p, double time, double *row)
{
  /* the line is that of the whole step, so that no record depends on the one before it */
  trb_peak_track_between(&p->n, &p->whole, *p->end, p->value, time, p->between);
  trb_peak_track_line(&p->n, &p->interval, time, p->between);
  write_row(p, &p->interval, row);
  trb_peak_track_start(&p->n, &p->interval, time, p->between, 1);
}

void trb_peaks_whole(const trb_peaks *p, double time, double *row)
{
  trb_peak_track_between(&p->n, &p->whole, *p->end, p->value, time, p->between);
  memcpy(p->asked.span, p->whole.span, (size_t)trb_peak_track_length(&p->n) * sizeof(double));
  trb_peak_track asked = p->asked;
  trb_peak_track_line(&p->n, &asked, time, p->between);
  write_row(p, &asked, row);
}

int trb_peaks_length(const trb_peaks *p) { return 1 + p->n.all + 2 * trb_peak_track_length(&p->n); }

void trb_peaks_save(const trb_peaks *p, double *to) { memcpy(to, p->block, (size_t)trb_peaks_length(p) * sizeof *to); }

void trb_peaks_restore(trb_peaks *p, const double *from)
{
  memcpy(p->block, from, (size_t)trb_peaks_length(p) * sizeof *from);
  forget(p);
}
