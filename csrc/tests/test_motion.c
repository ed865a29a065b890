/* Prescribed motion: Hermite curves, their rates, the exact turn of the shaft, the ring's pose. */
#include "motion/ring_motion.h"

#include "body/ring.h"

#include <stdlib.h>

#include "check.h"
#include "rig.h"

enum { KNOTS = 5 };

static unsigned long long seed = 3;
static double             table[KNOTS][TRB_MOTION_COLUMNS];
static const double       knot_times[KNOTS] = {-0.2, 0.1, 0.15, 0.6, 1.4};

static void fill(void)
{
  for (int i = 0; i < KNOTS; i++) {
    table[i][0] = knot_times[i];
    for (int c = 0; c < TRB_N_CHANNELS; c++) {
      const double scale = c < 3 ? 1e-4 : c < 5 ? 0.03 : c == TRB_CHANNEL_shaft_speed ? 300.0 : 10.0;
      table[i][1 + 2 * c] = scale * rig_random(&seed);
      table[i][2 + 2 * c] = 5.0 * scale * rig_random(&seed);
    }
  }
}

/* Cubic Hermite polynomial in Newton's form with doubled knots. */
static double hermite(int channel, double t)
{
  int k = 0;
  while (k < KNOTS - 2 && t > knot_times[k + 1]) k++;
  const double *a = table[k], *b = table[k + 1], h = b[0] - a[0], d = t - a[0];
  const int     c = 1 + 2 * channel;
  const double  rise = (b[c] - a[c]) / h, second = (rise - a[c + 1]) / h, third = (b[c + 1] - 2.0 * rise + a[c + 1]) / (h * h);
  return a[c] + d * (a[c + 1] + d * (second + (d - h) * third));
}

static double value_of(const trb_drive *d, int channel)
{
  if (channel == TRB_CHANNEL_displacement_x) return d->displacement.x;
  if (channel == TRB_CHANNEL_displacement_y) return d->displacement.y;
  if (channel == TRB_CHANNEL_displacement_z) return d->displacement.z;
  if (channel == TRB_CHANNEL_shaft_speed) return d->shaft_speed;
  if (channel == TRB_CHANNEL_gravity_x) return d->gravity.x;
  if (channel == TRB_CHANNEL_gravity_y) return d->gravity.y;
  return d->gravity.z;
}

static void test_curves(const trb_model *m, const trb_motion *motion)
{
  static const int channels[] = {TRB_CHANNEL_displacement_x, TRB_CHANNEL_displacement_y, TRB_CHANNEL_displacement_z,
                                 TRB_CHANNEL_shaft_speed,    TRB_CHANNEL_gravity_x,      TRB_CHANNEL_gravity_y,
                                 TRB_CHANNEL_gravity_z};
  trb_drive        d, before, after;
  for (int i = 0; i < 500; i++) {
    const double t = 0.6 + 0.8 * rig_random(&seed), h = 1e-6;
    trb_motion_at(motion, m, t, &d);
    for (size_t c = 0; c < sizeof channels / sizeof channels[0]; c++) {
      const double scale = channels[c] < 3 ? 1e-4 : 300.0;
      CHECK_NEAR(value_of(&d, channels[c]), hermite(channels[c], t), 1e-13 * scale);
    }
    trb_motion_at(motion, m, t - h, &before);
    trb_motion_at(motion, m, t + h, &after);
    CHECK_NEAR(d.shaft_rate, (after.shaft_speed - before.shaft_speed) / (2 * h), 1e-3);
    CHECK_NEAR(d.carried_rate, (after.carried_speed - before.carried_speed) / (2 * h), 1e-3);
    CHECK_NEAR(d.rolling_speed, d.shaft_speed - d.carried_speed, 0.0);
    CHECK_NEAR(d.rolling_rate, d.shaft_rate - d.carried_rate, 0.0);
    CHECK_NEAR(d.shaft_speed, (after.shaft_angle - before.shaft_angle) / (2 * h), 1e-5);
    CHECK_NEAR(d.ring.velocity.y, (after.displacement.y - before.displacement.y) / (2 * h), 1e-9);
    CHECK_NEAR(d.frame_speed, (after.frame_angle - before.frame_angle) / (2 * h), 1e-5);
    CHECK_NEAR(d.frame_speed, m->geometry.cage_speed_ratio * d.rolling_speed + d.carried_speed, 1e-12);
    CHECK_NEAR(d.frame_rate, m->geometry.cage_speed_ratio * d.rolling_rate + d.carried_rate, 1e-9);
    CHECK_NEAR(d.cosine * cos(d.frame_angle) + d.sine * sin(d.frame_angle), 1.0, 1e-15);
  }
}

/* Turn of the shaft against Simpson's rule between knots, exact for cubics. */
static void test_angle(const trb_model *m, const trb_motion *motion)
{
  trb_drive d, low, high, middle;
  double    turned = 0.0, from = knot_times[0];
  trb_motion_at(motion, m, from, &d);
  CHECK_NEAR(d.shaft_angle, 0.0, 0.0);
  for (int k = 1; k < KNOTS; k++)
    for (int i = 1; i <= 64; i++) {
      const double to = knot_times[k - 1] + (knot_times[k] - knot_times[k - 1]) * i / 64.0;
      trb_motion_at(motion, m, from, &low);
      trb_motion_at(motion, m, 0.5 * (from + to), &middle);
      trb_motion_at(motion, m, to, &high);
      /* at an inner knot the speed of both pieces is the same */
      turned += (to - from) / 6.0 * (low.shaft_speed + 4.0 * middle.shaft_speed + high.shaft_speed);
      CHECK_NEAR(high.shaft_angle, turned, 1e-11);
      from = to;
    }
}

/* Constant outside the knots, where the shaft turns on. */
static void test_outside(const trb_model *m, const trb_motion *motion)
{
  trb_drive end, d;
  trb_motion_at(motion, m, knot_times[KNOTS - 1], &end);
  for (int side = 0; side < 2; side++) {
    const double *row = table[side ? KNOTS - 1 : 0], t = side ? 9.0 : -7.0;
    trb_motion_at(motion, m, t, &d);
    CHECK_NEAR(d.displacement.x, row[1 + 2 * TRB_CHANNEL_displacement_x], 0.0);
    CHECK_NEAR(d.shaft_speed, row[1 + 2 * TRB_CHANNEL_shaft_speed], 0.0);
    CHECK_NEAR(d.rolling_rate, 0.0, 0.0);
    CHECK_NEAR(trb_norm(d.ring.velocity), 0.0, 0.0);
    CHECK_NEAR(trb_norm(d.ring_omega), 0.0, 0.0);
    CHECK_NEAR(d.shaft_angle, (side ? end.shaft_angle : 0.0) + row[1 + 2 * TRB_CHANNEL_shaft_speed] * (t - row[0]), 1e-11);
  }
}

/* Axis and angular velocity of a ring that is turned out of its place. */
static void test_pose(const trb_model *m, const trb_motion *motion)
{
  trb_drive d, before, after;
  for (int i = 0; i < 300; i++) {
    const double t = 0.6 + 0.79 * rig_random(&seed), h = 1e-6;
    trb_motion_at(motion, m, t, &d);
    trb_motion_at(motion, m, t - h, &before);
    trb_motion_at(motion, m, t + h, &after);
    const trb_vec3 axis = d.ring.axis, moved = trb_scale(1.0 / (2 * h), trb_sub(after.ring.axis, before.ring.axis));
    const trb_vec3 turned = trb_cross(d.ring_omega, axis), spin = trb_sub(d.ring.omega, d.ring_omega);
    CHECK_NEAR(trb_norm(axis), 1.0, 1e-15);
    CHECK_NEAR(trb_norm(trb_sub(moved, turned)), 0.0, 1e-9);
    CHECK_NEAR(trb_dot(d.ring_omega, axis), 0.0, 1e-15);
    CHECK_NEAR(trb_norm(trb_axpy(spin, -d.shaft_speed, axis)), 0.0, 1e-12);
    /* the misalignment turns about the roller-centre plane */
    CHECK_NEAR(trb_norm(trb_sub(trb_sub(d.ring.centre, d.displacement), trb_v(0, 0, m->geometry.centre_plane))), 0.0, 1e-15);
  }
}

/* Rotation vectors of any length, also about zero, where a series takes over. */
static void test_rotation_vectors(const trb_model *m)
{
  trb_drive d = {0};
  for (double size = 1e-12; size < 1.0; size *= 1.7) {
    const double   rotation[2] = {size * 0.6, -size * 0.8}, rate[2] = {0.3, 0.7}, h = 1e-6 * (1.0 + size);
    const double   low[2] = {rotation[0] - h * rate[0], rotation[1] - h * rate[1]},
                   high[2] = {rotation[0] + h * rate[0], rotation[1] + h * rate[1]};
    const trb_vec3 none = trb_v(0, 0, 0);
    trb_drive      before = {0}, after = {0};
    trb_drive_place(m, none, none, rotation, rate, 0.0, &d);
    trb_drive_place(m, none, none, low, rate, 0.0, &before);
    trb_drive_place(m, none, none, high, rate, 0.0, &after);
    /* Rodrigues: the axis of z turned by the vector */
    CHECK_NEAR(d.ring.axis.x, sin(size) * -0.8, 1e-15);
    CHECK_NEAR(d.ring.axis.y, -sin(size) * 0.6, 1e-15);
    CHECK_NEAR(d.ring.axis.z, cos(size), 1e-15);
    const trb_vec3 moved = trb_scale(0.5 / h, trb_sub(after.ring.axis, before.ring.axis));
    CHECK_NEAR(trb_norm(trb_sub(moved, trb_cross(d.ring_omega, d.ring.axis))), 0.0, 2e-10);
  }
}

static double end_of(double time)
{
  for (int i = 1; i < KNOTS; i++)
    if (table[i][0] > time) return table[i][0];
  return INFINITY;
}

/* From stop to stop every knot is met, every interval in eight parts at least, none a sliver; outside there is but the first knot. */
static void test_stops(const trb_motion *motion)
{
  const double first = table[0][0], last = table[KNOTS - 1][0];
  double       time = first - 1.0;
  int          met = 0, steps = 0;
  CHECK(trb_motion_stop(motion, time) == first);
  CHECK(trb_motion_longest_step(motion, time, INFINITY) == (double)INFINITY && trb_motion_longest_step(motion, last, 0.2) == 0.2);
  CHECK(trb_motion_stop(motion, last) == (double)INFINITY && trb_motion_stop(motion, last + 1.0) == (double)INFINITY);
  for (time = first; time < last && steps < 1000; steps++) {
    const double stop = trb_motion_stop(motion, time);
    double       interval = 0.0;
    CHECK(stop > time);
    for (int i = 1; i < KNOTS; i++) {
      if (time >= table[i - 1][0] && time < table[i][0]) interval = table[i][0] - table[i - 1][0];
      CHECK(!(time < table[i][0] && stop > table[i][0]));
      met += stop == table[i][0];
    }
    CHECK(stop - time < 0.19 * interval && stop - time > 0.05 * interval);
    const double longest = fmax(interval / 32.0, fmin(interval / 8.0, 5e-5));
    for (int k = 0; k < 20; k++) {
      const double from = time + 0.05 * k * (stop - time), most = k % 2 ? 0.3 * longest : (double)INFINITY,
                   step = trb_motion_longest_step(motion, from, most);
      const double number = (end_of(from) - from) / step;
      CHECK(step < fmin(most, longest) * (1.0 + 1e-5) && (number < 1.0 || step > 0.5 * fmin(most, longest)));
      CHECK(number < ceil(number) && ceil(number) - number < 1e-6);
    }
    time = stop;
  }
  CHECK(met == KNOTS - 1);
  CHECK(!trb_motion_changes(motion, first - 1.0, first) && trb_motion_changes(motion, first - 1.0, first + 1e-9));
  CHECK(trb_motion_changes(motion, last - 1e-9, last + 1.0) && !trb_motion_changes(motion, last, last + 1.0));
  CHECK(!trb_motion_under_way(motion, first) && trb_motion_under_way(motion, 0.5 * (first + last)) && !trb_motion_under_way(motion, last));
  CHECK(time == last);
}

static void refused(int n, const char *says)
{
  trb_motion *motion = NULL;
  trb_message message = {TRB_OK, ""};
  CHECK(trb_motion_create(&table[0][0], n, &motion, &message) == TRB_ERR_INPUT);
  CHECK(motion == NULL);
  CHECK_SAYS(message.text, says);
  trb_motion_free(motion);
}

static void test_bad_tables(void)
{
  refused(0, "no knots");
  const double keep = table[2][0], value = table[3][4];
  const double after = table[3][0];
  table[2][0] = table[3][0] = table[1][0];
  refused(KNOTS, "time of knot 3 = 0.1 s: must be above the one before, or twice the same");
  table[2][0] = 0.5 * (table[0][0] + table[1][0]), table[3][0] = after;
  refused(KNOTS, "time of knot 2 = -0.05 s: must be above the one before");
  table[2][0] = NAN;
  refused(KNOTS, "knot 2, column 0 is not finite");
  table[2][0] = keep, table[3][4] = INFINITY;
  refused(KNOTS, "knot 3, column 4 is not finite");
  table[3][4] = value;
}

/* After the last knot the part from the second knot on repeats: curves, the shaft's turn and the stops, for thousands of periods. */
static void test_repetition(const trb_model *m)
{
  const double begin = knot_times[1], period = knot_times[KNOTS - 1] - begin;
  trb_motion  *motion;
  trb_message  message = {TRB_OK, ""};
  trb_drive    d, again, end, start;
  double       keep[TRB_MOTION_COLUMNS];
  if (!CHECK(trb_motion_create(&table[0][0], KNOTS, &motion, NULL) == TRB_OK)) return;
  CHECK(trb_motion_repeat(motion, period, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "must be the same");
  CHECK(trb_motion_repeat(motion, 0.9 * period, &message) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "there must be a knot this long before the last one");
  CHECK(trb_motion_repeat(motion, -1.0, &message) == TRB_ERR_INPUT);
  trb_motion_free(motion);
  for (int c = 1; c < TRB_MOTION_COLUMNS; c++) keep[c] = table[KNOTS - 1][c], table[KNOTS - 1][c] = table[1][c];
  if (!CHECK(trb_motion_create(&table[0][0], KNOTS, &motion, NULL) == TRB_OK)) return;
  CHECK(trb_motion_repeat(motion, period, &message) == TRB_OK);
  trb_motion_set_angles(motion, 0.3, 7.0, 0.0);
  trb_motion_at(motion, m, 0.3, &d);
  CHECK_NEAR(d.shaft_angle, 7.0, 1e-14);
  trb_motion_at(motion, m, begin, &start);
  trb_motion_at(motion, m, begin + period, &end);
  const double turned = end.shaft_angle - start.shaft_angle;
  for (int i = 0; i < 500; i++) {
    const double count = i < 250 ? 1.0 : 1.0 + (i % 7) * 1000.0, t = begin + period * (0.5 + 0.5 * rig_random(&seed)), size = 1e-13 * count;
    trb_motion_at(motion, m, t, &d);
    trb_motion_at(motion, m, t + count * period, &again);
    for (int c = 0; c < TRB_N_CHANNELS; c++) {
      if (c == TRB_CHANNEL_rotation_x || c == TRB_CHANNEL_rotation_y) continue;
      CHECK_NEAR(value_of(&again, c), value_of(&d, c), 3e5 * size);
    }
    CHECK_NEAR(again.ring.axis.x, d.ring.axis.x, 3e3 * size);
    CHECK_NEAR(again.ring.velocity.y, d.ring.velocity.y, 3e3 * size);
    CHECK_NEAR(again.shaft_angle, d.shaft_angle + count * turned, 1e5 * size);
    CHECK(trb_motion_changes(motion, t + count * period, t + count * period + 1e-9));
  }
  double time = begin + 5e4 * period;
  for (int i = 0; i < 20000; i++) {
    const double stop = trb_motion_stop(motion, time);
    if (!CHECK(stop > time + 1e-4 && stop < time + 0.2)) break;
    time = stop;
  }
  CHECK(time > begin + 5e4 * period + 400.0 * period);
  /* from wherever it is looked for, a joint has one time */
  for (int i = 0; i < 400; i++) {
    const double joint = begin + (1 + i % 4) * period + (i % 2) * 0.05, stop = trb_motion_stop(motion, joint - 1e-4);
    CHECK_NEAR(stop, joint, 1e-14);
    CHECK(trb_motion_stop(motion, joint - 1e-3 * (0.01 + fabs(rig_random(&seed)))) == stop);
  }
  for (int c = 1; c < TRB_MOTION_COLUMNS; c++) table[KNOTS - 1][c] = keep[c];
  trb_motion_free(motion);
}

/* Knots that sample a smooth curve stop no step, but the two of a kink do; from just before a joint a step gets on. */
static void test_joints(void)
{
  trb_motion  *motion;
  double       rows[6][TRB_MOTION_COLUMNS] = {{0}};
  const double times[6] = {-1.0, 0.25, 0.5, 0.5, 0.75, 1.0};
  for (int i = 0; i < 6; i++) rows[i][0] = times[i], rows[i][1] = 1e-5 * i, rows[i][TRB_MOTION_SMOOTH] = 1.0;
  rows[3][1] = rows[2][1];
  if (!CHECK(trb_motion_create(&rows[0][0], 6, &motion, NULL) == TRB_OK)) return;
  double met[2] = {0.0, 0.0};
  for (double time = -1.0; time < 1.0 && met[0] + met[1] < 100.0;) {
    const double stop = trb_motion_stop(motion, time);
    if (!CHECK(stop > time && !(time < 0.5 && stop > 0.5))) break;
    met[time >= 0.5] += 1.0;
    time = stop;
  }
  CHECK(met[0] == 8.0 && met[1] == 8.0);
  CHECK_NEAR(trb_motion_stop(motion, 0.5 - 1e-17), 0.5625, 1e-12);
  trb_motion_free(motion);
  /* a period of 1/300 s, far away and just before t = 0: stops are never closer than a share of what lies between two joints */
  for (int k = 0; k < 2; k++) {
    const double begin = k ? 2e5 : -0.0146, period = 1.0 / 300.0;
    for (int i = 0; i < 6; i++) rows[i][0] = begin + period * i / 5.0, rows[i][1] = 0.0, rows[i][TRB_MOTION_SMOOTH] = 0.0;
    if (!CHECK(trb_motion_create(&rows[0][0], 6, &motion, NULL) == TRB_OK)) return;
    CHECK(trb_motion_repeat(motion, period, NULL) == TRB_OK);
    double time = begin;
    for (int i = 0; i < 400; i++) {
      const double stop = trb_motion_stop(motion, time);
      CHECK(stop - time > period / 5.0 / 17.0);
      time = stop;
    }
    trb_motion_free(motion);
  }
}

int main(void)
{
  const trb_params params = rig_params();
  trb_system      *system = rig_system(&params);
  const trb_model *m = system->model;
  trb_motion      *motion;
  fill();
  if (!CHECK(trb_motion_create(&table[0][0], KNOTS, &motion, NULL) == TRB_OK)) return check_report();
  test_curves(m, motion);
  test_angle(m, motion);
  test_outside(m, motion);
  test_pose(m, motion);
  test_rotation_vectors(m);
  test_stops(motion);
  test_repetition(m);
  test_bad_tables();
  test_joints();
  trb_motion_free(motion);
  rig_free(system);
  return check_report();
}
