/* Bounds of contacts: arms reach as far as what they stand for, and what several coordinates do is added up. */
#include "check.h"
#include "contact/pair.h"
#include "motion/dynamics.h"
#include "motion/hold.h"
#include "rig.h"

/* Two coordinates that each move a contact by 0.6 of what it may bear hold alone, and not together, whatever their signs. */
static void test_ways_add_up(void)
{
  static const int           coordinates[] = {TRB_ROLLER_r, TRB_ROLLER_z, TRB_ROLLER_tilt};
  static const int           velocities[] = {TRB_ROLLER_v_r, TRB_ROLLER_v_z, TRB_ROLLER_omega_n, TRB_ROLLER_omega_a};
  const trb_hold_arms        arms = {.radial = 0.9, .axial = 0.2, .tilt = 0.02, .skew = 0.01, .reach = 0.03, .off = 0.05};
  const double               arm[] = {arms.radial, arms.axial, arms.tilt}, lever[] = {1.0, 1.0, arms.reach, arms.reach};
  const double               from[TRB_ROLLER_SIZE] = {0}, way = 1e-6, speed = 1e-3;
  static const trb_hold_ring still = {0};
  trb_hold                   hold;
  trb_hold_set(&still, from, 0.0, way, speed, &hold);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      for (int signs = 0; signs < 4; signs++) {
        double y[TRB_ROLLER_SIZE] = {0};
        y[coordinates[a]] = (signs & 1 ? -0.6 : 0.6) * way / arm[a];
        CHECK(trb_hold_holds(&hold, &arms, &still, y, 0.0));
        if (a == b) continue;
        y[coordinates[b]] = (signs & 2 ? -0.6 : 0.6) * way / arm[b];
        CHECK(!trb_hold_holds(&hold, &arms, &still, y, 0.0));
      }
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) {
      double y[TRB_ROLLER_SIZE] = {0};
      y[velocities[a]] = 0.6 * speed / lever[a];
      CHECK(trb_hold_holds(&hold, &arms, &still, y, 0.0));
      if (a == b) continue;
      y[velocities[b]] = -0.6 * speed / lever[b];
      CHECK(!trb_hold_holds(&hold, &arms, &still, y, 0.0));
    }
}

/* A roller that skews to the other side has moved by both angles. */
static void test_skew_to_the_other_side(void)
{
  const trb_hold_arms arms = {.radial = 0.9, .axial = 0.2, .tilt = 0.02, .skew = 0.01, .reach = 0.03, .off = 0.05};
  const trb_hold_ring still = {0};
  double              from[TRB_ROLLER_SIZE] = {0}, y[TRB_ROLLER_SIZE] = {0};
  trb_hold            hold;
  from[TRB_ROLLER_skew] = 1e-2;
  /* the way of both angles is aside times slant over off: half of it is not enough to hold, a little more than it is */
  const double aside = arms.skew * 2e-2, slant = arms.skew * 1e-2 + aside;
  trb_hold_set(&still, from, 0.0, 0.5 * aside * slant / arms.off, 1.0, &hold);
  y[TRB_ROLLER_skew] = 1e-2;
  CHECK(trb_hold_holds(&hold, &arms, &still, y, 0.0));
  y[TRB_ROLLER_skew] = -1e-2;
  CHECK(!trb_hold_holds(&hold, &arms, &still, y, 0.0));
  trb_hold_set(&still, from, 0.0, 1.01 * aside * slant / arms.off, 1.0, &hold);
  CHECK(trb_hold_holds(&hold, &arms, &still, y, 0.0));
}

/* The edge of the small end, seen from the roller's centre of mass, which lies nearer to the large end. */
static void test_arm_of_the_small_end(const trb_system *system)
{
  const trb_model    *m = system->model;
  const trb_geometry *g = &m->geometry;
  CHECK(g->small_end_station < 0.0 && g->roller_mass_offset > 0.0);
  CHECK(trb_pair_front_rib.margin(m, &system->pairs[TRB_PAIR_front_rib]).arm >=
        hypot(g->small_end_station - g->roller_mass_offset, g->small_end_radius));
}

/* A turn of a body about the roller moves a face's vertex by its distance, which the arm of the same kind of face must reach. */
static void test_arms_of_pockets(const trb_model *m)
{
  trb_clearance_arms arms[TRB_N_GAPS];
  trb_pair_pocket.clearance(m, arms);
  for (int i = 0; i < m->first_face[m->n_rollers]; i++) {
    const trb_polygon *f = &m->faces[i].surface;
    const int          gap = m->faces[i].part == TRB_PART_FLANK ? TRB_GAP_FLANK : TRB_N_GAPS - 1;
    for (int k = 0; k < f->n; k++) {
      const trb_vec3 vertex = trb_axpy(trb_axpy(f->origin, f->outline[2 * k], f->u), f->outline[2 * k + 1], f->v);
      CHECK(arms[gap].roller[TRB_ROLLER_skew] >= trb_norm(vertex) && arms[gap].roller[TRB_ROLLER_tilt] >= trb_norm(vertex));
      CHECK(arms[gap].body[TRB_CAGE_psi] >= trb_norm(vertex) + m->geometry.roller_centre_radius);
    }
  }
}

/* Whatever meets a ring that stands aside and leans, to either side, lies no further across than the bound of its place says. */
static void test_place_of_a_ring(const trb_system *system)
{
  static const double turns[][2] = {{2e-3, 0.0}, {-2e-3, 0.0}, {1e-3, -3e-3}}, still[2] = {0.0, 0.0};
  trb_dynamics       *d;
  if (!CHECK(trb_dynamics_create(system, NULL, "scalar", &d, NULL) == TRB_OK)) return;
  for (size_t i = 0; i < sizeof turns / sizeof turns[0]; i++) {
    trb_drive_place(system->model, trb_v(3e-6, -5e-6, 0.0), trb_v(0, 0, 0), turns[i], still, 0.0, &d->drive);
    trb_dynamics_place(d);
    const trb_hold_ring  bound = trb_hold_ring_of(system, d->bodies);
    const trb_ring_pose *ring = &d->bodies[system->driven].ring;
    for (int sign = -1; sign <= 1; sign++) {
      const trb_vec3 point = trb_axpy(ring->centre, sign * bound.far, ring->axis);
      CHECK(bound.place >= hypot(point.x, point.y));
    }
  }
  trb_dynamics_free(d);
}

int main(void)
{
  const trb_params p = rig_params();
  trb_system      *system = rig_system(&p);
  test_ways_add_up();
  test_skew_to_the_other_side();
  test_arm_of_the_small_end(system);
  test_arms_of_pockets(system->model);
  test_place_of_a_ring(system);
  rig_free(system);
  return check_report();
}
