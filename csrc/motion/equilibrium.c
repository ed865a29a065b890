#include "motion/equilibrium.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bearing/ribs.h"
#include "body/ring.h"
#include "motion/rhs.h"
#include "system/system.h"

/* Near the largest radial load hardly loaded rollers let go and are caught again, and Newton's method is slow: from STEPS_UNTIL_FAIR on it ends
 * at a balance that is good enough for a run, TRB_FAIR_SHARE of the largest load. It goes on so long only where less than
 * TRB_NEAR_SHARE of the largest load is unbalanced then: under a load that nothing carries the ring moves away for ever. From a guess
 * close by it takes a few steps, or never ends there. */
enum { WARM_STEPS = 80, STEPS_UNTIL_FAIR = 300, MOST_STEPS = 3000 };
#define TRB_FAIR_SHARE 1e-5
#define TRB_NEAR_SHARE 1e-2
/* Unbalanced force that counts as balanced: this share of the largest load, and at least this force, N. */
#define TRB_BALANCE_SHARE 1e-10
#define TRB_BALANCE_FORCE 1e-7
/* Share of the imbalance that may be left after a step with a stiffness that is kept for the next one. */
#define TRB_KEEP_STIFFNESS 0.05
/* Stiffness of a loaded contact, N/m, to its order, and the share of it that holds a roller which nothing else holds: it stays where it is as the ring
 * moves. */
#define TRB_CONTACT_STIFFNESS 1e9
#define TRB_LOOSE_SHARE 1e-9
/* Share of it that holds cylindrical rollers in the middle between their ribs, where in a bearing friction does: a thousandth of a newton over
 * their clearance. */
#define TRB_MIDDLE_SHARE 1e-8
/* Share of it from which on ribs hold a cylindrical roller along its axis. Below, friction does: it stays where it is as the ring moves, and
 * the weak spring above, which only names its place, is not eliminated with the rest. */
#define TRB_RIB_SHARE 1e-4
/* Longest steps of differences. Where the contacts' interference is less than ten of them, steps are a tenth of it: a longer one would lift
 * a roller off that its centrifugal force presses lightly. Shorter ones than TRB_STEP_LEAST would be lost in rounding. */
#define TRB_STEP_LENGTH 1e-10
#define TRB_STEP_ANGLE 1e-8
#define TRB_STEP_LEAST 1e-15
/* Centrifugal force with which light rollers are placed, N, and the factor from each such force to the next. */
#define TRB_PLACING_FORCE 1.0
#define TRB_PLACING_STEP 0.01
/* Steps of central differences, in these. */
#define TRB_FINE_STEPS 10.0

/* Coordinates of a roller and of the ring, short within this file. */
enum { N = TRB_ROLLER_FREEDOMS, R = TRB_RING_FREEDOMS };

typedef struct solver {
  const trb_model *m;
  trb_equilibrium *e;
  trb_dynamics    *d;
  double          *forces;  /* per roller (N): generalised force */
  double          *ring;    /* per roller (R): generalised force on the ring */
  double          *shifted; /* the same after a difference */
  double          *ring_shifted;
  double          *own;                                              /* per roller (N x N) stiffness */
  double          *to_ring;                                          /* per roller (N x R): d force of roller / d ring */
  double          *from_ring;                                        /* per roller (R x N): d force on ring / d roller */
  double          *solved;                                           /* per roller (N x (R + 1)): own^-1 [to_ring, force] */
  double          *trial;                                            /* per roller (N) */
  double           stiffness[TRB_RING_FREEDOMS * TRB_RING_FREEDOMS]; /* of the ring at fixed rollers */
  double           total[TRB_RING_FREEDOMS];                         /* generalised force on the ring with its load */
  double           energy;
  double          *elastic;   /* per roller: elastic energy where it was evaluated last, J */
  double          *fine;      /* per roller: its steps of differences over the longest ones */
  double           ring_fine; /* the same of the ring */
  int              held[N];   /* coordinates of the rollers that nothing but friction, or nothing at all, moves */
} solver;

/* Interference in the contacts of a roller over that where the longest steps of differences are short beside it: from the elastic energy, and
 * from the centrifugal force of a roller that nothing touches yet. */
static double fineness(double elastic, double centrifugal)
{
  const double interference = sqrt(2.0 * fmax(elastic, 0.0) / TRB_CONTACT_STIFFNESS) + fabs(centrifugal) / TRB_CONTACT_STIFFNESS;
  return fmin(1.0, fmax(0.1 * interference, TRB_STEP_LEAST) / TRB_STEP_LENGTH);
}

static const double difference[N] = {TRB_STEP_LENGTH, TRB_STEP_LENGTH, TRB_STEP_ANGLE, TRB_STEP_ANGLE};
static const double ring_difference[TRB_RING_FREEDOMS] = {TRB_STEP_LENGTH, TRB_STEP_LENGTH, TRB_STEP_LENGTH, TRB_STEP_ANGLE,
                                                          TRB_STEP_ANGLE};

/* Loads of the slow pairs where all bodies are placed at rest: without sliding and rolling the contacts have no friction. */
static void load(solver *s, const double *rollers, const double *displacement, trb_detail *detail)
{
  const trb_model *m = s->m;
  trb_drive       *drive = &s->d->drive;
  const double     still[2] = {0.0, 0.0};
  memset(drive, 0, sizeof *drive);
  drive->cosine = 1.0;
  trb_drive_place(m, trb_v(displacement[0], displacement[1], displacement[2]), trb_v(0, 0, 0), displacement + 3, still, 0.0, drive);
  trb_dynamics_place(s->d);
  for (int j = 0; j < m->n_rollers; j++) {
    double y[TRB_ROLLER_SIZE] = {0};
    y[TRB_ROLLER_r] = rollers[N * j];
    y[TRB_ROLLER_z] = rollers[N * j + 1];
    y[TRB_ROLLER_tilt] = rollers[N * j + 2];
    y[TRB_ROLLER_skew] = rollers[N * j + 3];
    y[TRB_ROLLER_psi] = s->e->angles[j] - trb_nominal_angle(m, j);
    trb_dynamics_pose_roller(s->d, j, y);
  }
  const trb_instant at = trb_dynamics_instant(s->d, s->d->everyone, m->n_rollers);
  trb_dynamics_slow(s->d, &at, TRB_ANY_BODY, detail);
}

/* Adds the force that leads a cylindrical roller back along its axis; gives its potential. */
static double keep_in_the_middle(double z, double *force)
{
  const double stiffness = TRB_MIDDLE_SHARE * TRB_CONTACT_STIFFNESS;
  *force -= stiffness * z;
  return 0.5 * stiffness * z * z;
}

/* Angular velocity of the rollers' orbits, rad/s. */
static double orbit_of(const trb_model *m, const trb_equilibrium *e)
{
  return m->geometry.cage_speed_ratio * (e->shaft_speed - e->carried_speed) + e->carried_speed;
}

/* Generalised forces on rollers and ring at a place; gives the potential. */
static double evaluate(solver *s, const double *rollers, const double *displacement, double *forces, double *ring)
{
  const trb_model    *m = s->m;
  const trb_geometry *g = &m->geometry;
  const trb_rolling   rolling = trb_pure_rolling(m, s->e->shaft_speed - s->e->carried_speed, s->e->carried_speed);
  const double        orbit = orbit_of(s->m, s->e);
  /* gyroscopic moment: rate of the angular momentum of a roller that spins and orbits */
  const double gyro = orbit * cos(g->roller_axis_angle) * g->roller_inertia_transverse * rolling.omega_n -
                      rolling.omega_n * g->roller_inertia_axial * rolling.omega_a;
  /* the same for a skewed roller, about n */
  const double spin = orbit * cos(g->roller_axis_angle) * g->roller_inertia_axial * rolling.omega_a;
  double       energy = 0.0;
  load(s, rollers, displacement, NULL);
  for (int j = 0; j < m->n_rollers; j++) {
    const trb_wrench      *l = &s->d->loads[j].roller, *on_ring = &s->d->loads[j].on[s->d->system->driven];
    const trb_roller_pose *r = &s->d->rollers[j];
    double                *f = forces + (size_t)N * j;
    f[0] = l->force.x + g->roller_mass * orbit * orbit * r->radius;
    f[1] = l->force.z;
    /* tilt turns about the tangent of the orbit, skew against the normal n of the roller's frame */
    f[2] = l->moment.y - gyro;
    f[3] = -trb_dot(l->moment, r->frame.n) - spin * sin(rollers[N * j + 3]);
    if (trb_has_cylinders(m)) energy += keep_in_the_middle(rollers[N * j + 1], &f[1]);
    for (int i = 0; i < N; i++)
      if (s->held[i]) f[i] = 0.0;
    s->elastic[j] = s->d->loads[j].elastic;
    energy += s->elastic[j] - 0.5 * g->roller_mass * orbit * orbit * r->radius * r->radius + gyro * rollers[N * j + 2] -
              spin * cos(rollers[N * j + 3]);
    const trb_vec3 force = trb_turn_z(on_ring->force, r->cosine, r->sine), torque = trb_turn_z(on_ring->moment, r->cosine, r->sine);
    double        *q = ring + TRB_RING_FREEDOMS * j;
    q[0] = force.x, q[1] = force.y, q[2] = force.z, q[3] = torque.x, q[4] = torque.y;
  }
  for (int i = 0; i < TRB_RING_FREEDOMS; i++) energy -= s->e->load[i] * displacement[i];
  return energy;
}

static void sum_ring(solver *s)
{
  for (int i = 0; i < TRB_RING_FREEDOMS; i++) {
    s->total[i] = s->e->fixed[i] ? 0.0 : s->e->load[i];
    for (int j = 0; j < s->m->n_rollers && !s->e->fixed[i]; j++) s->total[i] += s->ring[TRB_RING_FREEDOMS * j + i];
  }
}

/* Largest unbalanced force; moments as forces at half the contact's length or at the pitch radius. */
static double imbalance(const solver *s)
{
  const double half = 0.5 * s->m->params.roller.effective_length, arm[N] = {1.0, 1.0, half, half};
  double       worst = 0.0;
  for (int j = 0; j < s->m->n_rollers; j++)
    for (int i = 0; i < TRB_ROLLER_FREEDOMS; i++) worst = fmax(worst, fabs(s->forces[N * j + i]) / arm[i]);
  for (int i = 0; i < TRB_RING_FREEDOMS; i++)
    worst = fmax(worst, fabs(s->total[i]) / (i < 3 ? 1.0 : 0.5 * s->m->params.bearing.pitch_diameter));
  return worst;
}

/* Forces with one coordinate of every roller, or of the ring, moved. */
static void evaluate_moved(solver *s, int of_ring, int c, double by, double *forces, double *ring)
{
  double moved[TRB_RING_FREEDOMS];
  memcpy(moved, s->e->displacement, sizeof moved);
  memcpy(s->trial, s->e->rollers, (size_t)s->m->n_rollers * TRB_ROLLER_FREEDOMS * sizeof(double));
  if (of_ring) moved[c] += by * s->ring_fine;
  for (int j = 0; j < s->m->n_rollers && !of_ring; j++) s->trial[N * j + c] += by * s->fine[j];
  (void)evaluate(s, s->trial, moved, forces, ring);
}

/* A column of the stiffness: the change from other forces to those that are shifted, over a step. */
static void put_column(solver *s, int of_ring, int c, double step, const double *forces, const double *ring)
{
  for (int j = 0; j < s->m->n_rollers; j++) {
    double      *own = s->own + (size_t)N * N * j, *from_ring = s->from_ring + (size_t)N * R * j, *to_ring = s->to_ring + (size_t)N * R * j;
    const double by = step * (of_ring ? s->ring_fine : s->fine[j]);
    for (int i = 0; i < N; i++) {
      const double slope = -(s->shifted[N * j + i] - forces[N * j + i]) / by;
      *(of_ring ? &to_ring[R * i + c] : &own[N * i + c]) = slope;
    }
    for (int i = 0; i < R; i++) {
      const double change = (s->ring_shifted[R * j + i] - ring[R * j + i]) / by;
      if (of_ring) s->stiffness[R * i + c] -= change;
      else from_ring[N * i + c] = -change;
    }
  }
}

/* Steps of differences at the place that was evaluated last, that of the ring for the heaviest roller. */
static void choose_steps(solver *s)
{
  const trb_geometry *g = &s->m->geometry;
  const double        orbit = orbit_of(s->m, s->e);
  s->ring_fine = 0.0;
  for (int j = 0; j < s->m->n_rollers; j++) {
    s->fine[j] = fineness(s->elastic[j], g->roller_mass * orbit * orbit * g->roller_centre_radius);
    s->ring_fine = fmax(s->ring_fine, s->fine[j]);
  }
}

/* Stiffness by differences: one evaluation of all contacts for each column, with all rollers moved at once. finely: by central differences at the
 * solution, for those who read it; forces and ring are then written to. */
static void differentiate(solver *s, int finely)
{
  choose_steps(s);
  memset(s->stiffness, 0, sizeof s->stiffness);
  for (int c = 0; c < N + R; c++) {
    const int    of_ring = c >= N, at = of_ring ? c - N : c;
    const double step = (finely ? TRB_FINE_STEPS : 1.0) * (of_ring ? ring_difference[at] : difference[at]);
    if (finely) evaluate_moved(s, of_ring, at, -step, s->forces, s->ring);
    evaluate_moved(s, of_ring, at, step, s->shifted, s->ring_shifted);
    put_column(s, of_ring, at, finely ? 2.0 * step : step, s->forces, s->ring);
  }
}

/* Gaussian elimination with row pivoting on a small system of n equations and k right-hand sides, row-major [A | B]. */
static int eliminate(double *a, int n, int k)
{
  const int width = n + k;
  for (int c = 0; c < n; c++) {
    int pivot = c;
    for (int i = c + 1; i < n; i++)
      if (fabs(a[i * width + c]) > fabs(a[pivot * width + c])) pivot = i;
    if (!(fabs(a[pivot * width + c]) > 0.0)) return 0;
    for (int i = 0; i < width; i++) {
      const double keep = a[c * width + i];
      a[c * width + i] = a[pivot * width + i];
      a[pivot * width + i] = keep;
    }
    for (int i = 0; i < n; i++) {
      if (i == c) continue;
      const double factor = a[i * width + c] / a[c * width + c];
      for (int q = c; q < width; q++) a[i * width + q] -= factor * a[c * width + q];
    }
  }
  for (int c = 0; c < n; c++)
    for (int q = n; q < width; q++) a[c * width + q] /= a[c * width + c];
  return 1;
}

/* The equation "this unknown does not move". */
static void hold_row(double *row, int width, int unknown)
{
  for (int c = 0; c < width; c++) row[c] = 0.0;
  row[unknown] = 1.0;
}

/* That stiffness against a coordinate of a roller. */
static double stiffness_against(const trb_model *m, int coordinate)
{
  const double arm = 0.5 * m->params.roller.effective_length;
  return coordinate < 2 ? TRB_CONTACT_STIFFNESS : TRB_CONTACT_STIFFNESS * arm * arm / 3.0;
}

/* Rows of a roller's stiffness with what the ring does to it, `width` apart, with a share of the stiffness of loaded contacts added. */
static void fill_rows(const solver *s, int roller, double damping, int width, double *a)
{
  for (int i = 0; i < N; i++) {
    for (int c = 0; c < N; c++) a[width * i + c] = s->own[N * N * roller + N * i + c];
    for (int c = 0; c < R; c++) a[width * i + N + c] = s->to_ring[N * R * roller + R * i + c];
    a[width * i + i] += damping * stiffness_against(s->m, i);
  }
}

/* Damped Newton step: (K + damping D) step = force, rollers eliminated onto the ring. D is the stiffness of a typical contact. */
static int newton_step(solver *s, double damping, double *step_rollers, double *step_ring)
{
  const int    n = s->m->n_rollers;
  const double radius = 0.5 * s->m->params.bearing.pitch_diameter, across = TRB_CONTACT_STIFFNESS * radius * radius;
  const double ring_scale[R] = {TRB_CONTACT_STIFFNESS, TRB_CONTACT_STIFFNESS, TRB_CONTACT_STIFFNESS, across, across};
  enum { WIDTH = N + R + 1 };
  double ring[R * (R + 1)];
  for (int i = 0; i < R; i++) {
    for (int c = 0; c < R; c++) ring[(R + 1) * i + c] = s->stiffness[R * i + c];
    ring[(R + 1) * i + i] += damping * ring_scale[i];
    ring[(R + 1) * i + R] = s->total[i];
  }
  for (int j = 0; j < n; j++) {
    double        a[N * WIDTH];
    double       *solved = s->solved + (size_t)j * N * (R + 1);
    const double *from_ring = s->from_ring + (size_t)j * N * R;
    fill_rows(s, j, damping, WIDTH, a);
    for (int i = 0; i < N; i++) {
      a[WIDTH * i + N + R] = s->forces[N * j + i];
      if (s->held[i]) hold_row(a + (size_t)WIDTH * i, WIDTH, i);
    }
    if (!eliminate(a, N, R + 1)) return 0;
    for (int i = 0; i < N; i++)
      for (int c = 0; c <= R; c++) solved[(R + 1) * i + c] = a[WIDTH * i + N + c];
    for (int i = 0; i < R; i++)
      for (int q = 0; q < N; q++)
        for (int c = 0; c <= R; c++) ring[(R + 1) * i + c] -= from_ring[N * i + q] * solved[(R + 1) * q + c];
  }
  for (int i = 0; i < R; i++)
    if (s->e->fixed[i]) hold_row(ring + (size_t)(R + 1) * i, R + 1, i);
  if (!eliminate(ring, R, 1)) return 0;
  /* what is held does not move by rounding either */
  for (int i = 0; i < R; i++) step_ring[i] = s->e->fixed[i] ? 0.0 : ring[(R + 1) * i + R];
  for (int j = 0; j < n; j++)
    for (int i = 0; i < N; i++) {
      const double *solved = s->solved + (size_t)j * N * (R + 1) + (size_t)i * (R + 1);
      double        value = solved[R];
      for (int c = 0; c < R; c++) value -= solved[c] * step_ring[c];
      step_rollers[N * j + i] = value;
    }
  return 1;
}

/* Steps longer than a contact's interference by far are shortened: the stiffness says nothing about them. */
static double shorten(const solver *s, const double *step_rollers, const double *step_ring)
{
  const double most = 5e-5, arm = 0.5 * s->m->params.roller.effective_length, radius = 0.5 * s->m->params.bearing.pitch_diameter;
  double       longest = 0.0;
  for (int j = 0; j < s->m->n_rollers; j++)
    for (int i = 0; i < N; i++) longest = fmax(longest, fabs(step_rollers[N * j + i]) * (i < 2 ? 1.0 : arm));
  for (int i = 0; i < 5; i++) longest = fmax(longest, fabs(step_ring[i]) * (i < 3 ? 1.0 : radius));
  return longest > most ? most / longest : 1.0;
}

/* Largest force on the ring, of its load or of a roller: the net force on a roller in equilibrium says nothing. */
static double largest_load(const solver *s)
{
  double largest = 0.0;
  for (int i = 0; i < 3; i++) {
    largest = fmax(largest, fabs(s->e->load[i]));
    for (int j = 0; j < s->m->n_rollers; j++) largest = fmax(largest, fabs(s->ring[R * j + i]));
  }
  return largest;
}

static int is_fair(const solver *s, double off) { return off < TRB_FAIR_SHARE * fmax(largest_load(s), 1e-3); }

static trb_status iterate(solver *s, double *step_rollers, double *step_ring, trb_message *message)
{
  trb_equilibrium *e = s->e;
  const int        n = s->m->n_rollers;
  int              known = 0; /* the stiffness is still good enough */
  double           damping = e->warm ? 0.0 : 1e-3, ring_trial[TRB_RING_FREEDOMS];
  s->energy = evaluate(s, e->rollers, e->displacement, s->forces, s->ring);
  sum_ring(s);
  double off = imbalance(s);
  for (e->iterations = 0; e->iterations < MOST_STEPS; e->iterations++) {
    e->residual = off;
    if (off < fmax(TRB_BALANCE_FORCE, TRB_BALANCE_SHARE * largest_load(s))) return TRB_OK;
    if (e->iterations >= STEPS_UNTIL_FAIR && is_fair(s, off)) return TRB_OK;
    if (e->warm && e->iterations == WARM_STEPS) break;
    if (e->iterations == STEPS_UNTIL_FAIR && !(off < TRB_NEAR_SHARE * largest_load(s))) break;
    if (!known) differentiate(s, 0);
    int          accepted = 0;
    const int    reused = known;
    const double before = off;
    for (int attempt = 0; attempt < (reused ? 1 : 40) && !accepted; attempt++) {
      if (!newton_step(s, damping, step_rollers, step_ring)) {
        damping = fmax(10.0 * damping, 1e-12);
        continue;
      }
      const double scale = shorten(s, step_rollers, step_ring);
      for (int i = 0; i < N * n; i++) s->trial[i] = e->rollers[i] + scale * step_rollers[i];
      for (int i = 0; i < 5; i++) ring_trial[i] = e->displacement[i] + scale * step_ring[i];
      const double energy = evaluate(s, s->trial, ring_trial, s->shifted, s->ring_shifted);
      double       keep_total[5];
      memcpy(keep_total, s->total, sizeof keep_total);
      double *const old_forces = s->forces, *const old_ring = s->ring;
      s->forces = s->shifted, s->ring = s->ring_shifted;
      sum_ring(s);
      const double next = imbalance(s);
      /* downhill, or, where the potential no longer resolves it, closer to balance */
      accepted = isfinite(energy) && isfinite(next) && (energy < s->energy - 1e-13 * fabs(s->energy) || next < off);
      if (accepted) {
        s->shifted = old_forces, s->ring_shifted = old_ring;
        memcpy(e->rollers, s->trial, (size_t)(N * n) * sizeof(double));
        memcpy(e->displacement, ring_trial, sizeof ring_trial);
        s->energy = energy;
        off = next;
        damping = damping < 1e-13 ? 0.0 : 0.1 * damping;
      } else {
        s->forces = old_forces, s->ring = old_ring;
        memcpy(s->total, keep_total, sizeof keep_total);
        damping = fmax(10.0 * damping, 1e-10);
      }
    }
    if (!accepted && !reused) break;
    if (!accepted) damping = 0.0;
    /* close to the solution the stiffness is kept as long as each step takes most of the imbalance away */
    known = e->warm && accepted && off < TRB_KEEP_STIFFNESS * before;
  }
  e->residual = off;
  if (is_fair(s, off)) return TRB_OK;
  return trb_fail(
      message, TRB_ERR_LOAD,
      "no equilibrium: after %d steps %g N stay unbalanced under force (%g, %g, %g) N, moment (%g, %g) N m; the bearing cannot carry this "
      "load%s",
      e->iterations, off, e->load[0], e->load[1], e->load[2], e->load[3], e->load[4],
      trb_has_cylinders(s->m) ? "" : " (an axial load towards -z must seat the rollers)");
}

/* Normal loads of the contacts at the solution. */
static trb_status read_loads(solver *s, trb_message *message)
{
  const trb_system *system = s->d->system;
  trb_detail       *detail;
  trb_status        status = trb_detail_create(s->m, system->pairs, system->n_pairs, &detail, message);
  if (status != TRB_OK) return status;
  trb_detail_clear(s->m, detail);
  load(s, s->e->rollers, s->e->displacement, detail);
  for (int j = 0; j < s->m->n_rollers; j++)
    for (int row = 0; row < TRB_EQUILIBRIUM_LOADS; row++) {
      const trb_contact *contact = &trb_pair_contacts(s->m, &system->pairs[row], detail)[j];
      s->e->loads[TRB_EQUILIBRIUM_LOADS * j + row] = contact->load;
    }
  trb_detail_free(detail);
  return TRB_OK;
}

/* What rollers do to the ring that is not driven at the solution. */
static void read_other(solver *s)
{
  double *sum = s->e->on_other;
  memset(sum, 0, sizeof s->e->on_other);
  load(s, s->e->rollers, s->e->displacement, NULL);
  for (int b = 0; b < s->d->system->n_bodies; b++)
    for (int j = 0; j < s->m->n_rollers && b != s->d->system->driven && trb_is_ring(s->d->system->bodies[b].kind); j++) {
      const trb_wrench      *on = &s->d->loads[j].on[b];
      const trb_roller_pose *r = &s->d->rollers[j];
      const trb_vec3         force = trb_turn_z(on->force, r->cosine, r->sine), moment = trb_turn_z(on->moment, r->cosine, r->sine);
      sum[0] += force.x, sum[1] += force.y, sum[2] += force.z, sum[3] += moment.x, sum[4] += moment.y;
    }
}

/* What holds the ring at the solution, and the potential without that of its load. */
static void read_reaction(const solver *s)
{
  trb_equilibrium *e = s->e;
  e->energy = s->energy;
  for (int i = 0; i < R; i++) {
    e->reaction[i] = 0.0;
    e->energy += e->load[i] * e->displacement[i];
    for (int j = 0; j < s->m->n_rollers; j++) e->reaction[i] -= s->ring[R * j + i];
  }
}

/* Stiffness of the ring whose rollers follow it, and how they follow: K = K_ring - F own^-1 T with the borders F and T. */
static trb_status condense(solver *s, trb_message *message)
{
  enum { WIDTH = N + R };
  differentiate(s, 1);
  memcpy(s->e->stiffness, s->stiffness, sizeof s->stiffness);
  for (int j = 0; j < s->m->n_rollers; j++) {
    const double *from_ring = s->from_ring + (size_t)N * R * j;
    double        a[N * WIDTH];
    fill_rows(s, j, TRB_LOOSE_SHARE, WIDTH, a);
    for (int i = 0; i < N; i++) {
      const int by_friction = i == 1 && trb_has_cylinders(s->m) && a[WIDTH * i + i] < TRB_RIB_SHARE * TRB_CONTACT_STIFFNESS;
      if (s->held[i] || by_friction) hold_row(a + (size_t)WIDTH * i, WIDTH, i);
    }
    if (!eliminate(a, N, R))
      return trb_fail(message, TRB_ERR_LOAD, "no stiffness: nothing holds roller %d at its place (standstill without load?)", j);
    for (int i = 0; i < N; i++)
      for (int c = 0; c < R; c++) s->e->follow[N * R * j + R * i + c] = -a[WIDTH * i + N + c];
    for (int i = 0; i < R; i++)
      for (int q = 0; q < N; q++)
        for (int c = 0; c < R; c++) s->e->stiffness[R * i + c] -= from_ring[N * i + q] * a[WIDTH * q + N + c];
  }
  return TRB_OK;
}

/* Rollers that a small centrifugal force alone moves lie in a valley that is as narrow as the interference it makes: Newton's method goes along
 * it in tiny steps. With the ring held where the search begins they are placed at a speed at which that force is TRB_PLACING_FORCE, and then at
 * lower ones down to their own. A failure says nothing: the search itself follows. */
static void place_light_rollers(solver *s, double *step_rollers, double *step_ring)
{
  trb_equilibrium    *e = s->e;
  const trb_geometry *g = &s->m->geometry;
  const double        orbit = orbit_of(s->m, e);
  const double        force = g->roller_mass * orbit * orbit * g->roller_centre_radius;
  const double        shaft = e->shaft_speed, carried = e->carried_speed;
  int                 fixed[R];
  trb_message         ignored = {TRB_OK, ""};
  if (!(force > 0.0 && force < TRB_PLACING_FORCE)) return;
  memcpy(fixed, e->fixed, sizeof fixed);
  for (int i = 0; i < R; i++) e->fixed[i] = 1;
  double at = TRB_PLACING_FORCE;
  while (at > force) {
    e->shaft_speed = shaft * sqrt(at / force), e->carried_speed = carried * sqrt(at / force);
    (void)iterate(s, step_rollers, step_ring, &ignored);
    at *= TRB_PLACING_STEP;
  }
  e->shaft_speed = shaft, e->carried_speed = carried;
  memcpy(e->fixed, fixed, sizeof fixed);
}

trb_status trb_equilibrium_solve(const trb_system *system, trb_equilibrium *e, trb_message *message)
{
  const trb_model *m = system->model;
  const size_t     n = (size_t)m->n_rollers;
  solver           s = {.m = m, .e = e};
  double           step_ring[TRB_RING_FREEDOMS] = {0}, *step_rollers;
  /* without a pair that seats it nothing but friction holds a roller along its axis, and a cylinder without ribs at both ends; in planar motion
   * it does not skew, nor does a cylinder but by friction */
  s.held[1] = !trb_system_seats(system) || (trb_has_cylinders(m) && !trb_between_ribs(&m->params));
  s.held[3] = m->params.effects.planar > 0.0 || trb_has_cylinders(m);
  trb_status status = trb_dynamics_create(system, NULL, "scalar", &s.d, message);
  if (status != TRB_OK) return status;
  trb_memory     memory = {0};
  double **const parts[] = {&s.forces,    &s.ring,   &s.shifted, &s.ring_shifted, &s.own,  &s.to_ring,
                            &s.from_ring, &s.solved, &s.trial,   &s.elastic,      &s.fine, &step_rollers};
  const size_t   sizes[] = {N, R, N, R, N * N, N * R, N * R, N * (R + 1), N, 1, 1, N};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) *parts[i] = trb_memory_zeros(&memory, n * sizes[i], sizeof(double));
  if (memory.lacks) {
    trb_memory_free(&memory);
    trb_dynamics_free(s.d);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the equilibrium");
  }
  if (!e->warm) place_light_rollers(&s, step_rollers, step_ring);
  status = iterate(&s, step_rollers, step_ring, message);
  read_reaction(&s);
  read_other(&s);
  if (status == TRB_OK && e->loads != NULL) status = read_loads(&s, message);
  if (status == TRB_OK && e->stiffness != NULL) status = condense(&s, message);
  trb_memory_free(&memory);
  trb_dynamics_free(s.d);
  return status;
}
