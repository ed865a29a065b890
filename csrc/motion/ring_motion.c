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

void trb_ring_place(const trb_model *m, trb_vec3 displacement, trb_vec3 velocity, const double rotation[2], const double rotation_rate[2],
                    double shaft_speed, trb_drive *drive)
{
  const double   rx = rotation[0], ry = rotation[1], angle = sqrt(rx * rx + ry * ry);
  const double   sinc = angle > 1e-8 ? sin(angle) / angle : 1.0 - angle * angle / 6.0;
  const double   slope = angle > 1e-4 ? (cos(angle) - sinc) / (angle * angle) : -1.0 / 3.0; /* d sinc / d(angle^2/2) */
  const trb_vec3 axis = trb_v(sinc * ry, -sinc * rx, cos(angle)), centre = trb_v(0.0, 0.0, m->geometry.centre_plane);
  const double   turn = rx * rotation_rate[0] + ry * rotation_rate[1];
  const trb_vec3 axis_rate = trb_v(sinc * rotation_rate[1] + slope * turn * ry, -sinc * rotation_rate[0] - slope * turn * rx, -sinc * turn);
  drive->displacement = displacement;
  drive->ring_omega = trb_cross(axis, axis_rate);
  drive->inner.axis = axis;
  drive->inner.centre = trb_add(displacement, centre);
  drive->inner.apex = trb_axpy(drive->inner.centre, -m->geometry.centre_plane, axis);
  drive->inner.velocity = velocity;
  drive->inner.omega = trb_axpy(drive->ring_omega, shaft_speed, axis);
}

/* Steps that an interval between two knots takes at least. */
enum { STEPS_AN_INTERVAL = 8 };

static double knot(const trb_motion *motion, int i) { return motion->table[(size_t)i * TRB_MOTION_COLUMNS]; }

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
  const double first = knot(motion, 0), last = knot(motion, motion->n - 1);
  if (motion->n == 1 || time >= last) return INFINITY;
  if (time < first) return first;
  const int    low = interval_of(motion, time);
  const double next = knot(motion, low + 1), part = time + (next - knot(motion, low)) / STEPS_AN_INTERVAL;
  /* no sliver of a step is left before the knot */
  return part < next - 0.5 * (part - time) ? part : next;
}

int trb_motion_changes(const trb_motion *motion, double from, double to)
{
  return motion->n > 1 && to > knot(motion, 0) && from < knot(motion, motion->n - 1);
}

int trb_motion_under_way(const trb_motion *motion, double time) { return trb_motion_changes(motion, time, time); }

void trb_motion_at(const trb_motion *motion, const trb_model *m, double time, trb_drive *drive)
{
  hermite       c[TRB_N_CHANNELS];
  const double *table = motion->table, *last = table + (size_t)(motion->n - 1) * TRB_MOTION_COLUMNS;
  if (time <= table[0] || time >= last[0] || motion->n == 1) {
    const int     late = time >= last[0];
    const double *row = late ? last : table;
    for (int i = 0; i < TRB_N_CHANNELS; i++) c[i] = (hermite){row[1 + 2 * i], 0.0};
    drive->shaft_angle = (late ? motion->angle[motion->n - 1] : 0.0) + row[1 + 2 * TRB_CHANNEL_shaft_speed] * (time - row[0]);
  } else {
    const int     low = interval_of(motion, time);
    const double *a = table + (size_t)low * TRB_MOTION_COLUMNS;
    const double  h = a[TRB_MOTION_COLUMNS] - a[0], s = (time - a[0]) / h;
    for (int i = 0; i < TRB_N_CHANNELS; i++) c[i] = channel_at(a, i, s, h);
    drive->shaft_angle = motion->angle[low] + channel_integral(a, TRB_CHANNEL_shaft_speed, s, h);
  }
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
