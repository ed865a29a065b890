#include "motion/ring_motion.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "body/ring.h"
#include "laws/smooth.h"

static const double *row_of(const trb_motion *motion, int i) { return motion->table + (size_t)i * TRB_MOTION_COLUMNS; }

/* Whether the time of a knot is above that of the knot before it, or the same, once: a kink or a step. */
static int follows(const double *table, int i)
{
  const double *row = table + (size_t)i * TRB_MOTION_COLUMNS, *before = row - TRB_MOTION_COLUMNS;
  if (row[0] > before[0]) return 1;
  return row[0] == before[0] && i > 1 && before[-TRB_MOTION_COLUMNS] < row[0];
}

/* The first and the last knot are joints whatever they say, and so are the two of a kink. */
static void find_joints(trb_motion *m)
{
  for (int i = 1; i < m->n; i++) {
    const double *row = m->table + (size_t)i * TRB_MOTION_COLUMNS;
    const int     kink = row[0] == row[-TRB_MOTION_COLUMNS];
    m->joint[i] = row[TRB_MOTION_SMOOTH] > 0.0 && !kink && i < m->n - 1 ? m->joint[i - 1] : i;
  }
  m->next[m->n - 1] = m->n;
  for (int i = m->n - 2; i >= 0; i--) m->next[i] = m->joint[i + 1] == i + 1 ? i + 1 : m->next[i + 1];
}

/* Channels whose integrals are kept. */
enum { N_TURNING = 2 };
static const int turning[N_TURNING] = {TRB_CHANNEL_shaft_speed, TRB_CHANNEL_outer_speed};

static double *angle_at(const trb_motion *motion, int knot) { return motion->angle + (size_t)knot * N_TURNING; }

/* Angle within the part that repeats. */
static double turn_of_tail(const trb_motion *motion, int k)
{
  return angle_at(motion, motion->n - 1)[k] - angle_at(motion, motion->tail)[k];
}

trb_status trb_motion_create(const double *table, int n, trb_motion **motion, trb_message *message)
{
  *motion = NULL;
  if (n < 1) return trb_fail(message, TRB_ERR_INPUT, "motion: no knots given, at least one needed");
  for (int i = 0; i < n * TRB_MOTION_COLUMNS; i++)
    if (!isfinite(table[i]))
      return trb_fail(message, TRB_ERR_INPUT, "motion: knot %d, column %d is not finite", i / TRB_MOTION_COLUMNS, i % TRB_MOTION_COLUMNS);
  for (int i = 1; i < n; i++)
    if (!follows(table, i))
      return trb_fail(message, TRB_ERR_INPUT, "motion: time of knot %d = %g s: must be above the one before, or twice the same", i,
                      table[i * TRB_MOTION_COLUMNS]);
  trb_motion *m = calloc(1, sizeof *m);
  if (m == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for prescribed motion");
  m->n = n;
  m->tail = n - 1;
  m->table = trb_memory_zeros(&m->memory, (size_t)n * TRB_MOTION_COLUMNS, sizeof(double));
  m->angle = trb_memory_zeros(&m->memory, (size_t)n * N_TURNING, sizeof(double));
  m->joint = trb_memory_zeros(&m->memory, (size_t)n, sizeof(int));
  m->next = trb_memory_zeros(&m->memory, (size_t)n, sizeof(int));
  if (m->memory.lacks) {
    trb_motion_free(m);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for prescribed motion");
  }
  memcpy(m->table, table, (size_t)n * TRB_MOTION_COLUMNS * sizeof(double));
  for (int i = 1; i < n; i++) {
    const double *a = m->table + (size_t)(i - 1) * TRB_MOTION_COLUMNS, *b = a + TRB_MOTION_COLUMNS, h = b[0] - a[0];
    for (int k = 0; k < N_TURNING; k++) {
      const int c = 1 + 2 * turning[k];
      angle_at(m, i)[k] = angle_at(m, i - 1)[k] + h * (0.5 * (a[c] + b[c]) + h * (a[c + 1] - b[c + 1]) / 12.0);
    }
  }
  for (int i = 1; i < n; i++)
    for (int c = 1; c < 1 + 2 * TRB_FIRST_LOAD_CHANNEL; c++)
      m->moves |= row_of(m, i)[c] != row_of(m, 0)[c] || (c % 2 == 0 && row_of(m, i)[c] != 0.0);
  find_joints(m);
  *motion = m;
  return TRB_OK;
}

void trb_motion_free(trb_motion *motion)
{
  if (motion == NULL) return;
  trb_memory_free(&motion->memory);
  free(motion);
}

static double knot(const trb_motion *motion, int i) { return row_of(motion, i)[0]; }
static double first_time(const trb_motion *motion) { return knot(motion, 0); }
static double last_time(const trb_motion *motion) { return knot(motion, motion->n - 1); }
static int    repeats(const trb_motion *motion) { return motion->tail < motion->n - 1; }

/* Times of knots that belong together differ by rounding at most: by this share of an interval, and by a few units in the last place of
 * the times themselves, which are as large as the histories' times are. */
#define TRB_SAME_TIME 1e-9
static double same_time(double interval, double time) { return TRB_SAME_TIME * interval + 8.0 * DBL_EPSILON * fabs(time); }

trb_status trb_motion_repeat(trb_motion *motion, double period, trb_message *message)
{
  const int     last = motion->n - 1;
  const double *end = row_of(motion, last);
  int           tail = last - 1;
  if (!(period > 0.0) || last < 1)
    return trb_fail(message, TRB_ERR_INPUT, "motion: period = %g s: must be > 0, with at least two knots", period);
  const double off = same_time(period, fmax(fabs(first_time(motion)), fabs(end[0])));
  while (tail > 0 && end[0] - knot(motion, tail) < period - off) tail--;
  if (fabs(end[0] - knot(motion, tail) - period) > off)
    return trb_fail(message, TRB_ERR_INPUT, "motion: period = %g s: there must be a knot this long before the last one", period);
  for (int c = 1; c < TRB_MOTION_SMOOTH; c++)
    if (row_of(motion, tail)[c] != end[c])
      return trb_fail(message, TRB_ERR_INPUT, "motion: column %d is %g at the start of the period and %g at its end: must be the same", c,
                      row_of(motion, tail)[c], end[c]);
  motion->tail = tail;
  motion->table[(size_t)tail * TRB_MOTION_COLUMNS + TRB_MOTION_SMOOTH] = 0.0;
  find_joints(motion);
  return TRB_OK;
}

/* Time within the table, of which a time after the last knot is a repetition; turns: how many periods lie between them. */
static double time_in_table(const trb_motion *motion, double time, double *turns)
{
  *turns = 0.0;
  if (!repeats(motion) || time < last_time(motion)) return time;
  const double begin = knot(motion, motion->tail), period = last_time(motion) - begin;
  *turns = floor((time - begin) / period);
  const double inside = time - *turns * period;
  /* by rounding it may lie a little outside of the part that repeats */
  return fmin(fmax(inside, begin), last_time(motion));
}

/* Integral of a channel from the start of the interval to the fraction s. */
static double channel_integral(const double *a, int channel, double s, double h)
{
  const double *b = a + TRB_MOTION_COLUMNS;
  const int     c = 1 + 2 * channel;
  const double  s2 = s * s, s3 = s2 * s, s4 = s3 * s;
  return h * ((0.5 * s4 - s3 + s) * a[c] + (0.25 * s4 - 2.0 / 3.0 * s3 + 0.5 * s2) * h * a[c + 1] + (s3 - 0.5 * s4) * b[c] +
              (0.25 * s4 - s3 / 3.0) * h * b[c + 1]);
}

/* Parts of what lies between two joints at whose ends a step ends; steps that it takes at least where these are no shorter than a step that
 * bearings take at usual speeds, s. */
enum { STEPS_AN_INTERVAL = 8, STEPS_FOR_POWERS = 32 };
static const double common_step = 5e-5;
/* What the number of steps to a joint may be above a whole number. */
#define SAME_NUMBER 1e-6

/* Index of the last knot at or before a time between the first and the last. */
static int interval_of(const trb_motion *motion, double time)
{
  int low = 0, high = motion->n - 1;
  while (high - low > 1) {
    const int mid = (low + high) / 2;
    if (time >= knot(motion, mid)) low = mid;
    else high = mid;
  }
  return low;
}

/* What lies between two joints: how long it is, when it ends, and how far a time lies from there, s. A time just before a joint, by
 * rounding, belongs to what comes after that joint: from there no step could get on. */
typedef struct stretch {
  double length, end, left;
} stretch;

static stretch stretch_at(const trb_motion *motion, double time)
{
  double       turns;
  const double inside = time_in_table(motion, time, &turns), period = last_time(motion) - knot(motion, motion->tail);
  int          end = motion->next[interval_of(motion, inside)], begin = motion->joint[end - 1];
  double       length = knot(motion, end) - knot(motion, begin), left = knot(motion, end) - inside;
  for (int i = 0; i < 2 * motion->n && left <= same_time(length, time); i++) {
    if (end == motion->n - 1) {
      if (!repeats(motion)) break;
      end = motion->joint[motion->tail];
      left += knot(motion, end) - last_time(motion);
      turns += 1.0;
    }
    begin = end;
    end = motion->next[begin];
    length = knot(motion, end) - knot(motion, begin);
    left += length;
  }
  if (!(left > 0.0)) return (stretch){length, time + length, length};
  /* from wherever it is looked for, a joint has one time to the last bit: else steps that are to end there end beside it */
  const int again = repeats(motion) && end == motion->n - 1;
  return (stretch){length, again ? knot(motion, motion->tail) + (turns + 1.0) * period : knot(motion, end) + turns * period, left};
}

double trb_motion_stop(const trb_motion *motion, double time)
{
  if (motion->n == 1 || (time >= last_time(motion) && !repeats(motion))) return INFINITY;
  if (time < first_time(motion)) return first_time(motion);
  const stretch at = stretch_at(motion, time);
  const double  part = at.length / STEPS_AN_INTERVAL;
  /* no sliver of a step is left before the joint */
  return part < at.left - 0.5 * part ? time + part : at.end;
}

double trb_motion_longest_step(const trb_motion *motion, double time, double most)
{
  if (motion->n == 1 || time < first_time(motion) || (time >= last_time(motion) && !repeats(motion))) return most;
  const stretch at = stretch_at(motion, time);
  const double  longest = fmin(most, fmax(at.length / STEPS_FOR_POWERS, fmin(at.length / STEPS_AN_INTERVAL, common_step)));
  /* a hair more, so that by rounding the last of them does not end almost there */
  return (1.0 + TRB_SAME_TIME) * at.left / fmax(ceil(at.left / longest - SAME_NUMBER), 1.0);
}

int trb_motion_changes(const trb_motion *motion, double from, double to)
{
  return motion->n > 1 && motion->moves && to > first_time(motion) && (repeats(motion) || from < last_time(motion));
}

int trb_motion_under_way(const trb_motion *motion, double time) { return trb_motion_changes(motion, time, time); }

/* Channels at a time, and the angles that shaft and outer ring have turned by. */
static void channels_at(const trb_motion *motion, double time, trb_curve c[TRB_N_CHANNELS], double angle[N_TURNING])
{
  double       turns;
  const int    last = motion->n - 1;
  const double inside = time_in_table(motion, time, &turns);
  if (inside <= first_time(motion) || inside >= last_time(motion) || last == 0) {
    const int     late = inside >= last_time(motion);
    const double *row = row_of(motion, late ? last : 0);
    for (int i = 0; i < TRB_N_CHANNELS; i++) c[i] = (trb_curve){row[1 + 2 * i], inside == row[0] ? row[2 + 2 * i] : 0.0};
    for (int k = 0; k < N_TURNING; k++)
      angle[k] = angle_at(motion, late ? last : 0)[k] + row[1 + 2 * turning[k]] * (inside - row[0]) + turns * turn_of_tail(motion, k);
    return;
  }
  const int     low = interval_of(motion, inside);
  const double *a = row_of(motion, low), *b = a + TRB_MOTION_COLUMNS;
  const double  h = a[TRB_MOTION_COLUMNS] - a[0], s = (inside - a[0]) / h;
  for (int i = 0; i < TRB_N_CHANNELS; i++) c[i] = trb_hermite(s, h, a[1 + 2 * i], a[2 + 2 * i], b[1 + 2 * i], b[2 + 2 * i]);
  for (int k = 0; k < N_TURNING; k++)
    angle[k] = angle_at(motion, low)[k] + channel_integral(a, turning[k], s, h) + turns * turn_of_tail(motion, k);
}

void trb_motion_set_angles(trb_motion *motion, double time, double shaft, double carried)
{
  const double wanted[N_TURNING] = {shaft, carried};
  trb_curve    c[TRB_N_CHANNELS];
  double       angle[N_TURNING];
  channels_at(motion, time, c, angle);
  for (int i = 0; i < motion->n; i++)
    for (int k = 0; k < N_TURNING; k++) angle_at(motion, i)[k] += wanted[k] - angle[k];
}

void trb_motion_at(const trb_motion *motion, const trb_model *m, double time, trb_drive *drive)
{
  trb_curve c[TRB_N_CHANNELS];
  double    angle[N_TURNING];
  channels_at(motion, time, c, angle);
  const double    ratio = m->geometry.cage_speed_ratio;
  const trb_curve carried = c[TRB_CHANNEL_outer_speed];
  drive->shaft_angle = angle[0];
  drive->carried_angle = angle[1];
  drive->rolling_angle = angle[0] - angle[1];
  drive->time = time;
  drive->shaft_speed = c[TRB_CHANNEL_shaft_speed].value;
  drive->shaft_rate = c[TRB_CHANNEL_shaft_speed].slope;
  drive->carried_speed = carried.value;
  drive->carried_rate = carried.slope;
  drive->rolling_speed = drive->shaft_speed - carried.value;
  drive->rolling_rate = drive->shaft_rate - carried.slope;
  drive->frame_angle = ratio * (angle[0] - angle[1]) + angle[1];
  drive->frame_speed = ratio * drive->rolling_speed + carried.value;
  drive->frame_rate = ratio * drive->rolling_rate + carried.slope;
  drive->cosine = cos(drive->frame_angle);
  drive->sine = sin(drive->frame_angle);
  drive->load.force = trb_v(c[TRB_CHANNEL_force_x].value, c[TRB_CHANNEL_force_y].value, c[TRB_CHANNEL_force_z].value);
  drive->load.moment = trb_v(c[TRB_CHANNEL_moment_x].value, c[TRB_CHANNEL_moment_y].value, 0.0);
  drive->torque = c[TRB_CHANNEL_torque].value;
  drive->housing_load.force =
      trb_v(c[TRB_CHANNEL_housing_force_x].value, c[TRB_CHANNEL_housing_force_y].value, c[TRB_CHANNEL_housing_force_z].value);
  drive->housing_load.moment = trb_v(c[TRB_CHANNEL_housing_moment_x].value, c[TRB_CHANNEL_housing_moment_y].value, 0.0);
  drive->gravity = trb_v(c[TRB_CHANNEL_gravity_x].value, c[TRB_CHANNEL_gravity_y].value, c[TRB_CHANNEL_gravity_z].value);
  const double rotation[2] = {c[TRB_CHANNEL_rotation_x].value, c[TRB_CHANNEL_rotation_y].value};
  const double rate[2] = {c[TRB_CHANNEL_rotation_x].slope, c[TRB_CHANNEL_rotation_y].slope};
  trb_drive_place(m, trb_v(c[TRB_CHANNEL_displacement_x].value, c[TRB_CHANNEL_displacement_y].value, c[TRB_CHANNEL_displacement_z].value),
                  trb_v(c[TRB_CHANNEL_displacement_x].slope, c[TRB_CHANNEL_displacement_y].slope, c[TRB_CHANNEL_displacement_z].slope),
                  rotation, rate, drive->shaft_speed, drive);
}
