#include "motion/ring_motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

trb_status trb_motion_create(const double *table, int n, trb_motion **motion, trb_message *message)
{
  *motion = NULL;
  if (n < 1) return trb_fail(message, TRB_ERR_INPUT, "motion: no knots given, at least one needed");
  for (int i = 0; i < n * TRB_MOTION_COLUMNS; i++)
    if (!isfinite(table[i]))
      return trb_fail(message, TRB_ERR_INPUT, "motion: knot %d, column %d is not finite", i / TRB_MOTION_COLUMNS, i % TRB_MOTION_COLUMNS);
  for (int i = 1; i < n; i++)
    if (!(table[i * TRB_MOTION_COLUMNS] > table[(i - 1) * TRB_MOTION_COLUMNS]))
      return trb_fail(message, TRB_ERR_INPUT, "motion: time of knot %d = %g s: must be above the one before", i,
                      table[i * TRB_MOTION_COLUMNS]);
  trb_motion *m = calloc(1, sizeof *m);
  if (m == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for prescribed motion");
  m->n = n;
  m->tail = n - 1;
  m->table = malloc((size_t)n * TRB_MOTION_COLUMNS * sizeof(double));
  m->angle = calloc((size_t)n, sizeof(double));
  if (m->table == NULL || m->angle == NULL) {
    trb_motion_free(m);
    return trb_fail(message, TRB_ERR_MEMORY, "out of memory for prescribed motion");
  }
  memcpy(m->table, table, (size_t)n * TRB_MOTION_COLUMNS * sizeof(double));
  for (int i = 1; i < n; i++) {
    const double *a = m->table + (size_t)(i - 1) * TRB_MOTION_COLUMNS, *b = a + TRB_MOTION_COLUMNS, h = b[0] - a[0];
    const int     c = 1 + 2 * TRB_CHANNEL_shaft_speed;
    m->angle[i] = m->angle[i - 1] + h * (0.5 * (a[c] + b[c]) + h * (a[c + 1] - b[c + 1]) / 12.0);
  }
  *motion = m;
  return TRB_OK;
}

void trb_motion_free(trb_motion *motion)
{
  if (motion == NULL) return;
  free(motion->table);
  free(motion->angle);
  free(motion);
}

static const double *row_of(const trb_motion *motion, int i) { return motion->table + (size_t)i * TRB_MOTION_COLUMNS; }
static double        knot(const trb_motion *motion, int i) { return row_of(motion, i)[0]; }
static double        first_time(const trb_motion *motion) { return knot(motion, 0); }
static double        last_time(const trb_motion *motion) { return knot(motion, motion->n - 1); }
static int           repeats(const trb_motion *motion) { return motion->tail < motion->n - 1; }

/* Times of knots that belong together differ by rounding at most: this share of an interval. */
#define TRB_SAME_TIME 1e-9

trb_status trb_motion_repeat(trb_motion *motion, double period, trb_message *message)
{
  const int     last = motion->n - 1;
  const double *end = row_of(motion, last);
  int           tail = last - 1;
  if (!(period > 0.0) || last < 1)
    return trb_fail(message, TRB_ERR_INPUT, "motion: period = %g s: must be > 0, with at least two knots", period);
  while (tail > 0 && end[0] - knot(motion, tail) < period * (1.0 - TRB_SAME_TIME)) tail--;
  if (fabs(end[0] - knot(motion, tail) - period) > TRB_SAME_TIME * period)
    return trb_fail(message, TRB_ERR_INPUT, "motion: period = %g s: there must be a knot this long before the last one", period);
  for (int c = 1; c < TRB_MOTION_COLUMNS; c++)
    if (row_of(motion, tail)[c] != end[c])
      return trb_fail(message, TRB_ERR_INPUT, "motion: column %d is %g at the start of the period and %g at its end: must be the same", c,
                      row_of(motion, tail)[c], end[c]);
  motion->tail = tail;
  return TRB_OK;
}

/* Time within the table, of which a time after the last knot is a repetition; turns: how many periods lie between them. */
static double time_in_table(const trb_motion *motion, double time, double *turns)
{
  *turns = 0.0;
  if (!repeats(motion) || time < last_time(motion)) return time;
  const double begin = knot(motion, motion->tail), period = last_time(motion) - begin;
  *turns = floor((time - begin) / period);
  double inside = time - *turns * period;
  /* rounding never leaves a time just before the last knot, from where no step could get on */
  if (inside >= last_time(motion) - TRB_SAME_TIME * (last_time(motion) - knot(motion, motion->n - 2))) {
    inside -= period;
    *turns += 1.0;
  }
  return fmax(inside, begin);
}

typedef struct hermite {
  double value, rate;
} hermite;

/* Value and rate of a channel in the interval that starts at knot row a, at the fraction s of its length h. */
static hermite channel_at(const double *a, int channel, double s, double h)
{
  const double *b = a + TRB_MOTION_COLUMNS;
  const int     c = 1 + 2 * channel;
  const double  s2 = s * s, s3 = s2 * s;
  hermite       out;
  out.value = (2 * s3 - 3 * s2 + 1) * a[c] + (s3 - 2 * s2 + s) * h * a[c + 1] + (3 * s2 - 2 * s3) * b[c] + (s3 - s2) * h * b[c + 1];
  out.rate = (6 * s2 - 6 * s) / h * (a[c] - b[c]) + (3 * s2 - 4 * s + 1) * a[c + 1] + (3 * s2 - 2 * s) * b[c + 1];
  return out;
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

/* Parts of an interval between two knots at whose ends a step ends; steps that it takes at least where these are no shorter than a step that
 * bearings take at usual speeds, s. */
enum { STEPS_AN_INTERVAL = 8, STEPS_FOR_POWERS = 32 };
static const double usual_step = 5e-5;

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

double trb_motion_stop(const trb_motion *motion, double time)
{
  double turns;
  if (motion->n == 1 || (time >= last_time(motion) && !repeats(motion))) return INFINITY;
  if (time < first_time(motion)) return first_time(motion);
  double       inside = time_in_table(motion, time, &turns);
  const double shift = turns * (last_time(motion) - knot(motion, motion->tail));
  int          low = interval_of(motion, inside);
  /* in a repetition a step that ended at a knot may lie before it by rounding */
  if (turns > 0.0 && low + 2 < motion->n && knot(motion, low + 1) - inside < TRB_SAME_TIME * (knot(motion, low + 1) - knot(motion, low)))
    inside = knot(motion, ++low);
  const double next = knot(motion, low + 1), part = inside + (next - knot(motion, low)) / STEPS_AN_INTERVAL;
  /* no sliver of a step is left before the knot */
  return shift + (part < next - 0.5 * (part - inside) ? part : next);
}

double trb_motion_longest_step(const trb_motion *motion, double time)
{
  double turns;
  if (motion->n == 1 || time < first_time(motion) || (time >= last_time(motion) && !repeats(motion))) return INFINITY;
  const int    low = interval_of(motion, time_in_table(motion, time, &turns));
  const double length = knot(motion, low + 1) - knot(motion, low);
  return fmax(length / STEPS_FOR_POWERS, fmin(length / STEPS_AN_INTERVAL, usual_step));
}

int trb_motion_changes(const trb_motion *motion, double from, double to)
{
  return motion->n > 1 && to > first_time(motion) && (repeats(motion) || from < last_time(motion));
}

int trb_motion_under_way(const trb_motion *motion, double time) { return trb_motion_changes(motion, time, time); }

/* Channels at a time, and the angle that the shaft has turned by. */
static double channels_at(const trb_motion *motion, double time, hermite c[TRB_N_CHANNELS])
{
  double       turns;
  const int    last = motion->n - 1;
  const double inside = time_in_table(motion, time, &turns);
  if (inside <= first_time(motion) || inside >= last_time(motion) || last == 0) {
    const int     late = inside >= last_time(motion);
    const double *row = row_of(motion, late ? last : 0);
    for (int i = 0; i < TRB_N_CHANNELS; i++) c[i] = (hermite){row[1 + 2 * i], inside == row[0] ? row[2 + 2 * i] : 0.0};
    return motion->angle[late ? last : 0] + row[1 + 2 * TRB_CHANNEL_shaft_speed] * (inside - row[0]) +
           turns * (motion->angle[last] - motion->angle[motion->tail]);
  }
  const int     low = interval_of(motion, inside);
  const double *a = row_of(motion, low);
  const double  h = a[TRB_MOTION_COLUMNS] - a[0], s = (inside - a[0]) / h;
  for (int i = 0; i < TRB_N_CHANNELS; i++) c[i] = channel_at(a, i, s, h);
  return motion->angle[low] + channel_integral(a, TRB_CHANNEL_shaft_speed, s, h) +
         turns * (motion->angle[last] - motion->angle[motion->tail]);
}

void trb_motion_set_angle(trb_motion *motion, double time, double angle)
{
  hermite      c[TRB_N_CHANNELS];
  const double shift = angle - channels_at(motion, time, c);
  for (int i = 0; i < motion->n; i++) motion->angle[i] += shift;
}

void trb_motion_at(const trb_motion *motion, const trb_model *m, double time, trb_drive *drive)
{
  hermite c[TRB_N_CHANNELS];
  drive->shaft_angle = channels_at(motion, time, c);
  const double ratio = m->geometry.cage_speed_ratio;
  drive->time = time;
  drive->shaft_speed = c[TRB_CHANNEL_shaft_speed].value;
  drive->shaft_rate = c[TRB_CHANNEL_shaft_speed].rate;
  drive->frame_angle = ratio * drive->shaft_angle;
  drive->frame_speed = ratio * drive->shaft_speed;
  drive->frame_rate = ratio * drive->shaft_rate;
  drive->cosine = cos(drive->frame_angle);
  drive->sine = sin(drive->frame_angle);
  drive->gravity = trb_v(c[TRB_CHANNEL_gravity_x].value, c[TRB_CHANNEL_gravity_y].value, c[TRB_CHANNEL_gravity_z].value);
  const double rotation[2] = {c[TRB_CHANNEL_rotation_x].value, c[TRB_CHANNEL_rotation_y].value};
  const double rate[2] = {c[TRB_CHANNEL_rotation_x].rate, c[TRB_CHANNEL_rotation_y].rate};
  trb_ring_place(m, trb_v(c[TRB_CHANNEL_displacement_x].value, c[TRB_CHANNEL_displacement_y].value, c[TRB_CHANNEL_displacement_z].value),
                 trb_v(c[TRB_CHANNEL_displacement_x].rate, c[TRB_CHANNEL_displacement_y].rate, c[TRB_CHANNEL_displacement_z].rate),
                 rotation, rate, drive->shaft_speed, drive);
}
