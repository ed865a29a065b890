/* The static equilibrium holds moments: rollers tilt and skew with the ring, and the same load from another side gives the same picture. */
#include "motion/equilibrium.h"

#include <math.h>

#include "check.h"
#include "rig.h"

enum { ROLLERS = 12, WIDTH = TRB_ROLLER_FREEDOMS };

typedef struct found {
  trb_equilibrium e;
  double          angles[ROLLERS], rollers[ROLLERS * WIDTH], loads[ROLLERS * TRB_EQUILIBRIUM_LOADS];
} found;

static int solve(const trb_system *system, const double *load, found *f)
{
  const trb_model *m = system->model;
  trb_message      message = {TRB_OK, ""};
  *f = (found){.e = {.shaft_speed = 300.0}};
  for (int i = 0; i < TRB_RING_FREEDOMS; i++) f->e.load[i] = load[i];
  for (int j = 0; j < ROLLERS; j++) f->angles[j] = trb_nominal_angle(m, j);
  f->e.angles = f->angles, f->e.rollers = f->rollers, f->e.loads = f->loads;
  const trb_status status = trb_equilibrium_solve(system, &f->e, &message);
  if (status != TRB_OK) printf("%s\n", message.text);
  return CHECK(status == TRB_OK);
}

static void test_moment(const trb_system *system)
{
  const double about_x[] = {0, 0, -8000, 30, 0}, about_y[] = {0, 0, -8000, 0, 30}, axial[] = {0, 0, -8000, 0, 0};
  found        x, y, still;
  if (!solve(system, about_x, &x) || !solve(system, about_y, &y) || !solve(system, axial, &still)) return;
  CHECK(x.e.residual < 1e-6 && y.e.residual < 1e-6);
  CHECK(x.e.displacement[3] > 1e-4);
  CHECK_NEAR(y.e.displacement[4], x.e.displacement[3], 1e-11);
  CHECK_NEAR(y.e.displacement[3], -x.e.displacement[4], 1e-11);
  double largest = 0.0;
  for (int j = 0; j < ROLLERS; j++) {
    /* a quarter of a turn on, three rollers */
    const double *a = x.rollers + (size_t)WIDTH * j, *b = y.rollers + (size_t)WIDTH * ((j + 3) % ROLLERS);
    for (int i = 0; i < WIDTH; i++) CHECK_NEAR(b[i], a[i], 1e-9);
    largest = fmax(largest, fabs(a[3]));
    CHECK(fabs(still.rollers[WIDTH * j + 3]) < 1e-12);
  }
  /* they skew about as far as the ring tilts */
  CHECK(largest > 0.5 * x.e.displacement[3] && largest < 2.0 * x.e.displacement[3]);
}

int main(void)
{
  const trb_params params = rig_params();
  trb_system      *system = rig_system(&params);
  test_moment(system);
  rig_free(system);
  return check_report();
}
