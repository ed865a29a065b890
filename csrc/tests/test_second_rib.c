/* Another rib is a row: a surface with numbers of its own and a pair of the kind that the back-face rib is of. What evaluates forces, their
 * slopes, losses, the equilibrium and steps has it then. The rib of these tests stands at the outer ring, opposite to that of the inner ring. */
#include <stdlib.h>

#include "check.h"
#include "motion/equilibrium.h"
#include "motion/record.h"
#include "rig.h"
#include "stepping/jacobian.h"

enum { ROOM = 600 };

static unsigned long long seed = 31;

/* A rib at the outer ring, whose face bears the nominal sphere where the face of the back rib does, with a share of its stiffness. */
static trb_rib rib_at_outer_ring(const trb_model *m, double share)
{
  trb_rib rib = m->rib[TRB_RACE_INNER][TRB_END_LARGE];
  rib.face.place += m->geometry.centre_plane; /* places of the outer ring are from the apex */
  rib.race = m->surfaces.race[TRB_RACE_OUTER];
  rib.stiffness *= share;
  return rib;
}

/* Adds the rib's rows to a system. */
static int add_rib(trb_system *system, const trb_rib *rib)
{
  const int surface = system->n_surfaces++, row = system->n_pairs++;
  system->surfaces[surface] = (trb_surface){"rib of the outer ring", TRB_BODY_OUTER_RING, TRB_SHAPE_CONE, rib};
  system->pairs[row] = system->pairs[TRB_PAIR_rib];
  system->pairs[row].name = "outer_rib";
  system->pairs[row].on = 1;
  system->pairs[row].surface[1] = surface;
  for (int by = 0; by < TRB_N_MECHANISMS; by++) system->pairs[row].books.torque[by] = 0;
  CHECK(trb_system_finish(system, NULL) == TRB_OK);
  return row;
}

/* With half the stiffness it carries half of what the back rib does, on a ring that does not turn. */
static void test_forces(void)
{
  trb_params p = rig_params();
  p.effects.lubrication = TRB_LUBRICATION_DRY, p.friction.dry_friction = p.effects.rolling_resistance = p.effects.thermal = 0;
  trb_system   *system = rig_system(&p), *both = rig_system(&p);
  const trb_rib rib = rib_at_outer_ring(both->model, 0.5);
  double        y[ROOM];
  trb_motion   *motion = rig_motion(rig_state(system, 4930.0, 100 * TRB_PI, y), 100 * TRB_PI);
  trb_dynamics *d[2];
  const int     row = add_rib(both, &rib), record = TRB_FIELD_AT_outer_rib_load; /* that its number gives it */
  CHECK(trb_field_size(system, record) == 0 && trb_field_size(both, record) == 12);
  /* the faces stand together where the inner ring is not displaced */
  trb_motion_free(motion);
  motion = rig_motion(0.0, 100 * TRB_PI);
  for (int j = 0; j < 12; j++) y[trb_state_roller(system, j) + TRB_ROLLER_z] += 3e-5;
  if (!CHECK(trb_dynamics_create(system, motion, "scalar", &d[0], NULL) == TRB_OK)) return;
  if (!CHECK(trb_dynamics_create(both, motion, "scalar", &d[1], NULL) == TRB_OK)) return;
  trb_detail *detail = rig_detail(both);
  trb_detail_clear(both->model, detail);
  for (int i = 0; i < 2; i++) {
    trb_dynamics_pose(d[i], 0.0, y);
    trb_dynamics_loads(d[i], NULL, i == 0 ? NULL : detail);
  }
  double carried = 0.0;
  for (int j = 0; j < 12; j++) {
    const trb_contact *first = &trb_pair_contacts(both->model, &both->pairs[TRB_PAIR_rib], detail)[j];
    const trb_contact *other = &trb_pair_contacts(both->model, &both->pairs[row], detail)[j];
    const trb_vec3     more = trb_sub(d[1]->loads[j].on[TRB_BODY_OUTER_RING].force, d[0]->loads[j].on[TRB_BODY_OUTER_RING].force);
    const trb_vec3     less = trb_sub(d[1]->loads[j].roller.force, d[0]->loads[j].roller.force);
    CHECK_NEAR(other->interference, first->interference, 1e-15);
    CHECK_NEAR(other->load, 0.5 * first->load, 1e-8 * first->load);
    CHECK_NEAR(trb_norm(trb_add(more, less)), 0.0, 1e-9 * first->load);
    CHECK_NEAR(trb_norm(more), other->load, 1e-9 * first->load);
    CHECK_NEAR(d[1]->loads[j].margin[row], other->interference, 1e-18);
    carried += other->load;
  }
  CHECK(carried > 100.0);
  trb_detail_free(detail);
  for (int i = 0; i < 2; i++) trb_dynamics_free(d[i]);
  trb_motion_free(motion);
  rig_free(system);
  rig_free(both);
}

/* Where it is far away it changes no bit of a run; where it touches, a run's losses grow, and its energies close. */
static void test_steps(void)
{
  const trb_params   p = rig_params();
  const trb_settings settings = rig_settings();
  double             y[ROOM], end[3][ROOM];
  for (int k = 0; k < 3; k++) {
    trb_system     *system = rig_system(&p);
    trb_simulation *s;
    trb_rib         rib = rib_at_outer_ring(system->model, 1.0);
    trb_motion     *motion = rig_motion(rig_state(system, 4930.0, 100 * TRB_PI, y), 100 * TRB_PI);
    /* under load the large ends stand towards the small ends by some micrometres, as the inner ring is pressed there */
    rib.face.place += k == 1 ? 1e-3 : -30e-6;
    rig_disturb(system, &seed, y);
    seed = 31;
    if (k > 0) add_rib(system, &rib);
    if (!CHECK(rig_create(system, motion, "bdf", "scalar", &settings, 0.0, y, &s, NULL) == TRB_OK)) return;
    rig_run(s, 5e-4);
    memcpy(end[k], s->integrator.y, (size_t)trb_state_size(system) * sizeof(double));
    const double *q = end[k] + trb_state_quadrature(system);
    if (k == 2) CHECK(q[TRB_Q_loss_rib] > 1.2 * end[0][trb_state_quadrature(system) + TRB_Q_loss_rib]);
    if (k == 1) CHECK(memcmp(end[0], end[1], (size_t)trb_state_size(system) * sizeof(double)) == 0);
    trb_simulation_free(s);
    trb_motion_free(motion);
    rig_free(system);
  }
}

/* A bearing without the inner ring's rib: the outer ring's seats the rollers. */
static void test_equilibrium(void)
{
  trb_params p = rig_params();
  p.effects.back_rib = 0;
  trb_system     *system = rig_system(&p);
  const trb_rib   rib = rib_at_outer_ring(system->model, 1.0);
  double          angles[12], rollers[12 * TRB_ROLLER_FREEDOMS] = {0};
  trb_equilibrium e = {.load = {0, 0, -4930, 0, 0}, .fixed = {0, 0, 0, 1, 1}, .angles = angles, .rollers = rollers};
  for (int j = 0; j < 12; j++) angles[j] = trb_nominal_angle(system->model, j);
  CHECK(!trb_system_seats(system));
  add_rib(system, &rib);
  CHECK(trb_system_seats(system));
  CHECK(trb_equilibrium_solve(system, &e, NULL) == TRB_OK);
  /* the rollers are pressed towards their large ends until the rib holds them */
  CHECK(e.residual < 1e-6 && rollers[1] > 1e-7 && rollers[1] < 1e-4);
  rig_free(system);
}

int main(void)
{
  test_forces();
  test_steps();
  test_equilibrium();
  return check_report();
}
