/* Surfaces off their true form: how their depths are read, what is refused, and that smooth forces do not know them. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "contact/uneven.h"
#include "rig.h"

enum { SAMPLES = 41, COLUMNS = TRB_FORM_depth + 2 * RIG_SLICES };

static double rows[2 * SAMPLES][COLUMNS];

/* A depth of its own for each node: cos(3 angle + node), with its slope. */
static void fill(double *row, int patch, int surface, double angle)
{
  row[TRB_FORM_patch] = patch, row[TRB_FORM_surface] = surface, row[TRB_FORM_angle] = angle, row[TRB_FORM_scale] = 0.2;
  for (int k = 0; k < RIG_SLICES; k++) {
    row[TRB_FORM_depth + k] = cos(3.0 * angle + k);
    row[TRB_FORM_depth + RIG_SLICES + k] = -3.0 * sin(3.0 * angle + k);
  }
}

/* One patch from 6 to 6.5 rad on the outer raceway, and one all round roller 2 where it meets the inner raceway. */
static void fill_all(void)
{
  for (int i = 0; i < SAMPLES; i++) {
    fill(rows[i], 0, trb_form_of_race(TRB_RACE_OUTER), 6.0 + 0.5 * i / (SAMPLES - 1));
    fill(rows[SAMPLES + i], 1, trb_form_of_roller(2, TRB_RACE_INNER), 2.0 * TRB_PI * i / (SAMPLES - 1));
  }
}

static void depths_are_read(const trb_model *m)
{
  const trb_form *form = &m->form;
  const double    turn = 2.0 * TRB_PI;
  double          depth = 0.0, slope = 0.0, before = 0.0, after = 0.0, unused = 0.0;
  /* also a turn before, and over the angle zero */
  CHECK(trb_form_at(form, 0, 6.2, 4, &depth, &slope) && trb_form_at(form, 0, 6.2 - turn, 4, &before, &unused));
  CHECK(fabs(depth - cos(18.6 + 4.0)) < 1e-6 && fabs(slope + 3.0 * sin(18.6 + 4.0)) < 1e-4 && fabs(depth - before) < 1e-12);
  before = 0.0, after = 0.0;
  CHECK(trb_form_at(form, 0, 6.3 - 1e-6, 0, &before, &unused) && trb_form_at(form, 0, 6.3 + 1e-6 - turn, 0, &after, &unused));
  slope = 0.0;
  CHECK(trb_form_at(form, 0, 6.3, 0, &depth, &slope) && fabs((after - before) / 2e-6 - slope) < 1e-4);
  depth = slope = 0.0;
  CHECK(!trb_form_at(form, 0, 5.99, 0, &depth, &slope) && !trb_form_at(form, 0, 6.51, 0, &depth, &slope) && depth == 0.0);
  CHECK(!trb_form_at(form, 1, 6.2, 0, &depth, &slope) && !trb_form_at(form, trb_form_of_roller(2, TRB_RACE_OUTER), 1.0, 0, &depth, &slope));
  CHECK(trb_form_is_near(form, 0, 5.96, 0.05) && !trb_form_is_near(form, 0, 5.94, 0.05) && trb_form_is_near(form, 0, 6.54 - turn, 0.05));
  /* all round, at its seam as well */
  for (double angle = -1e-17; angle < 1.0; angle = angle < 1e-17 ? angle + 1e-17 : 10.0 * angle) {
    depth = 0.0;
    CHECK(trb_form_at(form, trb_form_of_roller(2, TRB_RACE_INNER), angle, 1, &depth, &slope));
    CHECK(fabs(depth - cos(3.0 * angle + 1.0)) < 1e-3);
  }
  const trb_form_scale outer = trb_form_scale_of(form, TRB_RACE_OUTER), inner = trb_form_scale_of(form, TRB_RACE_INNER);
  CHECK(outer.race == 0.2 && outer.roller == (double)INFINITY && inner.race == (double)INFINITY && inner.roller == 0.2);
}

/* A contact on the outer raceway, at an azimuth inside its patch; the ring rests. */
static void fill_at(const trb_model *m, const trb_roller_pose *r, const trb_ring_pose *g, double azimuth, trb_uneven *to)
{
  const trb_race_input in = {.roller = r, .ring = g, .centre = m->centre, .sphere = m->sphere, .nodes = &m->race[TRB_RACE_OUTER]};
  trb_uneven_fill(m, &in, 0, azimuth, 0.0, 0, to);
}

/* What a depth does goes with its difference along the way: its rate where the roller orbits, and the force for a unit of load, whose power is
 * that rate. */
static void rates_follow_depths(const trb_model *m)
{
  static trb_uneven     at, before, after;
  const trb_geometry   *g = &m->geometry;
  const double          azimuth = 6.25, orbit = 300.0, radius = g->roller_centre_radius, step = 1e-5;
  const trb_ring_pose   ring = {.axis = {0, 0, 1}};
  const trb_roller_pose roller = {.radius = radius,
                                  .cosine = 1.0,
                                  .orbit_speed = orbit,
                                  .x = {radius, 0, g->roller_centre_height},
                                  .frame = trb_tilted_frame(0.0, g->roller_axis_angle),
                                  .v = {0, orbit * radius, 0},
                                  .omega = {0, 0, orbit}};
  fill_at(m, &roller, &ring, azimuth, &at);
  fill_at(m, &roller, &ring, azimuth - step, &before);
  fill_at(m, &roller, &ring, azimuth + step, &after);
  for (int k = 0; k < m->n_nodes; k++) {
    const double slope = (after.depth[k] - before.depth[k]) / (2.0 * step);
    CHECK(fabs(slope) > 0.05);
    CHECK_NEAR(at.rate[k], orbit * slope, 1e-3 * orbit);
    CHECK_NEAR(at.fy[k] * orbit * radius + at.mz[k] * orbit, at.rate[k], 1e-9 * orbit);
    /* the force is as large as the slope over the distance of the node from the axis */
    CHECK_NEAR(at.fy[k] * (radius + m->centre[k] * roller.frame.a.x), slope, 1e-3);
  }
}

static int refused(trb_model *m, int row, int column, double value, int n_rows)
{
  trb_message  message;
  const double kept = rows[row][column];
  rows[row][column] = value;
  const trb_status status = trb_model_set_form(m, &rows[0][0], n_rows, COLUMNS, &message);
  rows[row][column] = kept;
  return status == TRB_ERR_INPUT && strstr(message.text, "form") != NULL;
}

static void what_is_wrong_is_refused(void)
{
  const trb_params p = rig_params();
  trb_model       *m = rig_model(&p);
  CHECK(refused(m, 3, TRB_FORM_angle, 6.2, 2 * SAMPLES));
  CHECK(refused(m, 3, TRB_FORM_angle, 5.0, 2 * SAMPLES));
  CHECK(refused(m, 3, TRB_FORM_surface, 1.0, 2 * SAMPLES));
  CHECK(refused(m, 0, TRB_FORM_surface, 0.5, 2 * SAMPLES));
  CHECK(refused(m, 0, TRB_FORM_surface, 2.0 + 2.0 * m->n_rollers, 1));
  CHECK(refused(m, 5, TRB_FORM_scale, 0.0, 2 * SAMPLES));
  CHECK(refused(m, 5, TRB_FORM_depth, NAN, 2 * SAMPLES));
  CHECK(refused(m, 0, TRB_FORM_angle, 6.0, 2));
  CHECK(refused(m, 2 * SAMPLES - 1, TRB_FORM_angle, 7.0, 2 * SAMPLES));
  CHECK(trb_model_set_form(m, &rows[0][0], 2 * SAMPLES, COLUMNS - 1, NULL) == TRB_ERR_INPUT);
  CHECK(trb_model_set_form(m, NULL, 0, 1, NULL) == TRB_OK && trb_model_set_form(m, &rows[0][0], 2 * SAMPLES, COLUMNS, NULL) == TRB_OK);
  trb_model_free(m);
}

/* Slopes, equilibria and tangents read an instant without spin angles: it has the loads of smooth surfaces, to the bit. */
static void smooth_forces_do_not_know_them(void)
{
  const trb_params p = rig_params();
  trb_system      *with, *without;
  trb_model       *uneven = rig_model(&p), *even = rig_model(&p);
  trb_dynamics    *d[2];
  trb_motion      *motion;
  double           y[500] = {0};
  for (int i = 0; i < 2 * SAMPLES; i++)
    for (int k = 0; k < RIG_SLICES; k++) rows[i][TRB_FORM_depth + k] *= 1e-6, rows[i][TRB_FORM_depth + RIG_SLICES + k] *= 1e-6;
  if (!CHECK(trb_model_set_form(uneven, &rows[0][0], 2 * SAMPLES, COLUMNS, NULL) == TRB_OK)) return;
  if (!CHECK(trb_system_tapered(uneven, &with, NULL) == TRB_OK && trb_system_tapered(even, &without, NULL) == TRB_OK)) return;
  motion = rig_motion(rig_state(without, 4930.0, 100.0 * TRB_PI, y), 100.0 * TRB_PI);
  if (!CHECK(trb_dynamics_create(with, motion, "", &d[0], NULL) == TRB_OK &&
             trb_dynamics_create(without, motion, "", &d[1], NULL) == TRB_OK))
    return;
  int differ = 0, same = 1;
  for (int k = 0; k < 2; k++) {
    trb_dynamics_pose(d[k], 0.0, y);
    const trb_instant at = trb_dynamics_instant(d[k], d[k]->everyone, even->n_rollers);
    trb_dynamics_slow(d[k], &at, TRB_ANY_BODY, NULL);
  }
  for (int j = 0; j < even->n_rollers; j++) same &= d[0]->loads[j].elastic == d[1]->loads[j].elastic;
  for (int k = 0; k < 2; k++) trb_dynamics_loads(d[k], NULL, NULL);
  for (int j = 0; j < even->n_rollers; j++) differ += d[0]->loads[j].elastic != d[1]->loads[j].elastic;
  CHECK(same && differ >= 1 && differ < 3);
  CHECK(d[1]->spin == NULL && d[1]->work->uneven == NULL && trb_dynamics_longest_step(d[1]) == (double)INFINITY);
  CHECK(trb_dynamics_longest_step(d[0]) > 1e-5 && trb_dynamics_longest_step(d[0]) < 1e-3);
  for (int k = 0; k < 2; k++) trb_dynamics_free(d[k]);
  trb_motion_free(motion);
  trb_system_free(with);
  trb_system_free(without);
  trb_model_free(uneven);
  trb_model_free(even);
}

int main(void)
{
  const trb_params p = rig_params();
  fill_all();
  trb_model *m = rig_model(&p);
  CHECK(trb_model_set_form(m, &rows[0][0], 2 * SAMPLES, COLUMNS, NULL) == TRB_OK && m->form.n == 2);
  depths_are_read(m);
  rates_follow_depths(m);
  trb_model_free(m);
  what_is_wrong_is_refused();
  smooth_forces_do_not_know_them();
  return check_report();
}
