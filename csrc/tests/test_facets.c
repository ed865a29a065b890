/* Surfaces of several facets: a roller has the same forces and slopes, bit for bit, whether facets that it is proven not to touch are left out or all are
 * evaluated, wherever roller and cage are; gaps are never more than the distance from the nearest facet; that one is found among all. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "contact/pocket_view.h"
#include "laws/profile.h"
#include "rig.h"
#include "surface/sphere.h"

enum { ROOM = RIG_ROOM, MOST_FACES = 2000, STATES = 60 };

static unsigned long long seed = 91;

/* By which a roller is thicker than its cone but at its ends, m. */
static double bulge = 0.0;

static trb_vec3 of(const double *v) { return trb_v(v[0], v[1], v[2]); }

static void set(double *to, trb_vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/* A part of a face as one of n strips across v, which lie on a circle of a radius: negative for a hollow face, 0 for a flat one; along u the
 * strip is cut into pieces. */
static int strips(const trb_face *face, int n, int pieces, double radius, trb_face *to)
{
  const trb_vec3 u = of(face->u), v = of(face->v), normal = trb_cross(u, v);
  const double   low = face->outline[0], left = face->outline[1], high = face->outline[4], right = face->outline[5];
  const double   width = (right - left) / n, middle = 0.5 * (left + right);
  for (int i = 0; i < n * pieces; i++) {
    const int    strip = i / pieces, piece = i % pieces;
    const double at = left + (strip + 0.5) * width - middle, turned = radius == 0.0 ? 0.0 : at / radius;
    const double way = radius == 0.0 ? at : radius * sin(turned), drop = radius == 0.0 ? 0.0 : radius * (cos(turned) - 1.0);
    const double from = low + (high - low) * piece / pieces, end = low + (high - low) * (piece + 1) / pieces, half = 0.5 * width;
    const double outline[8] = {from, -half, end, -half, end, half, from, half};
    to[i] = *face;
    set(to[i].origin, trb_axpy(trb_axpy(of(face->origin), middle + way, v), drop, normal));
    set(to[i].v, trb_axpy(trb_scale(cos(turned), v), -sin(turned), normal));
    memcpy(to[i].outline, outline, sizeof outline);
  }
  return n * pieces;
}

/* How the faces of the rig are divided. */
typedef struct division {
  int    across, along; /* of a bar */
  double radius;
  int    wall;
} division;

static rig_bench set_up(const trb_params *p, const division *by)
{
  trb_face          whole[RIG_FACES];
  static trb_face   faces[MOST_FACES];
  double            deviation[12];
  trb_message       message = {TRB_OK, ""};
  rig_bench         b = {.system = NULL};
  trb_model        *model;
  const trb_system *plain = rig_system(p);
  b.motion = rig_motion(rig_state(plain, 4930.0, 100 * TRB_PI, b.start), 100 * TRB_PI);
  rig_free((trb_system *)plain);
  rig_faces(p, whole);
  int n = 0, columns;
  for (int i = 0; i < 2; i++) n += strips(&whole[i], by->across, by->along, by->radius, faces + n);
  n += strips(&whole[2], by->wall, by->wall, 0.0, faces + n);
  faces[n++] = whole[3];
  for (int i = 0; i < 12; i++) deviation[i] = 5e-6 * rig_random(&seed);
  if (trb_model_create(p, deviation, 12, faces, n, &model, &message) != TRB_OK) {
    printf("%s\n", message.text);
    exit(1);
  }
  double *rows = rig_modes(model, &columns);
  double  drops[3 * 200] = {0};
  for (int k = 2; k < model->n_nodes - 2; k++) drops[k] = -bulge;
  const int made = trb_model_set_drops(model, drops, bulge > 0.0 ? 3 : 0, model->n_nodes, &message) == TRB_OK &&
                   trb_model_set_modes(model, rows, (int)p->cage.n_modes, columns, &message) == TRB_OK &&
                   trb_system_tapered(model, &b.system, &message) == TRB_OK &&
                   trb_dynamics_create(b.system, b.motion, "scalar", &b.d, NULL) == TRB_OK;
  free(rows);
  if (!made || trb_state_size(b.system) > ROOM) exit(1);
  return b;
}

/* What a roller gets from its pocket. */
typedef struct got {
  trb_gaps     gaps;
  trb_load     load;
  trb_slopes   slopes;
  trb_counters counters;
} got;

static got pocket_of(const trb_model *m, const trb_pair *row, const trb_instant *at, int roller, trb_detail *detail)
{
  got g = {.load = {.elastic = 0.0}};
  g.gaps = trb_contact_pocket_of(m, row, at, roller, &g.counters, &g.load, &g.slopes, detail);
  return g;
}

/* Of the roller in a pocket that does not deform, over all nodes and facets of a slot: the largest interference. */
static double deepest_of(const trb_model *m, const trb_instant *at, const trb_rigid_pose *cage, int roller, int slot)
{
  const trb_roller_pose *r = &at->rollers[roller];
  const trb_frame        body = trb_compose(&cage->body, &m->pockets.axes[roller]);
  const trb_vec3         origin = trb_add(cage->x, trb_from_frame(&cage->body, m->pockets.origin[roller]));
  const trb_vec3         from = trb_sub(trb_turn_z(r->x, r->cosine, r->sine), origin), axis = trb_turn_z(r->frame.a, r->cosine, r->sine);
  const trb_vec3         x = trb_to_frame(&body, from), a = trb_to_frame(&body, axis);
  double                 deepest = -INFINITY;
  for (int f = m->pockets.first_face[roller]; f < m->pockets.first_face[roller + 1]; f++) {
    const trb_pocket_face *face = &m->pockets.faces[f];
    const int              flank = face->part == TRB_PART_FLANK;
    if (face->slot != slot) continue;
    for (int k = 0; k < (flank ? m->n_nodes : 1); k++) {
      const trb_sphere large = m->surfaces.end[TRB_END_LARGE];
      const double     place = flank ? m->centre[roller * m->n_lanes + k] : large.place;
      const double     radius = flank ? m->sphere[roller * m->n_lanes + k] : large.radius;
      const trb_vec3   centre = trb_axpy(x, place, a);
      trb_vec3         normal;
      deepest =
          trb_max(deepest, trb_sphere_on_polygon(&face->surface, centre, trb_polygon_height(&face->surface, centre), radius, &normal));
    }
  }
  return deepest;
}

/* Which of many things happened. */
typedef struct happened {
  int clear, touching, films, apart; /* apart: states in which facets were left out beside others that touch */
} happened;

static void compare(const rig_bench *b, const trb_instant *at, const trb_pair *row, int roller, happened *seen)
{
  const trb_model      *m = b->system->model;
  const trb_rigid_pose *cage = &at->bodies[row->b].pose;
  double                force[12 * 8] = {0}, friction[12 * 8] = {0}, depth[12 * 8];
  trb_detail            all = {.pocket_force = force, .pocket_friction = friction, .pocket_interference = depth};
  for (int i = 0; i < 12 * 8; i++) depth[i] = -INFINITY;
  const got few = pocket_of(m, row, at, roller, NULL), every = pocket_of(m, row, at, roller, &all);
  CHECK(few.counters.pocket_nodes == every.counters.pocket_nodes && few.counters.pocket_films == every.counters.pocket_films);
  seen->films += every.counters.pocket_films > 0;
  if (trb_gaps_clear(&few.gaps)) {
    seen->clear++;
    CHECK(every.counters.pocket_nodes == 0 && every.counters.pocket_films == 0);
  } else {
    seen->touching += every.counters.pocket_nodes > 0;
    seen->apart += few.counters.pocket_nodes > 0 && few.counters.pocket_culled > 0;
    CHECK(memcmp(&few.load, &every.load, sizeof few.load) == 0);
    CHECK(memcmp(&few.slopes, &every.slopes, sizeof few.slopes) == 0);
  }
  if (at->bodies[row->b].deformed != NULL) return;
  double nearest[TRB_N_GAPS] = {INFINITY, INFINITY};
  for (int slot = 0; slot < 3; slot++) {
    const double deepest = deepest_of(m, at, cage, roller, slot), size = fmax(fabs(deepest), m->geometry.sphere_radius);
    CHECK_NEAR(depth[roller * m->n_slots + slot], deepest, 1e-13 * size);
    const int gap = slot < 2 ? TRB_GAP_FLANK : TRB_GAP_ENDS;
    nearest[gap] = fmin(nearest[gap], -deepest - (slot < 2 ? m->pockets.film : 0.0));
  }
  for (int g = 0; g < TRB_N_GAPS; g++) CHECK(few.gaps.of[g] <= nearest[g] + 1e-13);
}

/* Near the place where pockets touch; far: turned and away by up to that many times as much. */
static void disturb(const rig_bench *b, double far, double *y)
{
  memcpy(y, b->start, sizeof b->start);
  rig_disturb(b->system, &seed, y);
  for (int j = 0; j < 12; j++)
    for (int i = 0; i < TRB_PLACE_OF_ROLLER; i++)
      y[trb_state_roller(b->system, j) + i] += far * (i == TRB_ROLLER_psi ? 2e-4 : 1e-5 + 2e-4 * (i > TRB_ROLLER_z)) * rig_random(&seed);
  for (int i = 0; i < TRB_PLACE_OF_BODY; i++) y[rig_cage(b->system) + i] += far * (i < 3 ? 1e-5 : 1e-4) * rig_random(&seed);
  for (int i = 0; i < 2 * b->system->model->modes.n; i++) y[rig_cage(b->system) + TRB_CAGE_SIZE + i] += 0.02 * rig_random(&seed);
}

static happened test_same_forces(const trb_params *p, const division *by)
{
  rig_bench b = set_up(p, by);
  happened  seen = {0};
  for (int state = 0; state < STATES; state++) {
    double      y[ROOM] = {0};
    trb_body_at bodies[TRB_MOST_BODIES];
    trb_pair    second = b.system->pairs[TRB_PAIR_pocket];
    disturb(&b, state % 3 == 0 ? 0.0 : state % 3 == 1 ? 10.0 : 500.0, y);
    trb_dynamics_pose(b.d, 0.0, y);
    /* a second cage, off the first one, whose pockets are another row of the same kind */
    trb_instant at = trb_dynamics_instant(b.d, NULL, 0);
    memcpy(bodies, at.bodies, (size_t)b.system->n_bodies * sizeof *bodies);
    second.b = b.system->n_bodies;
    bodies[second.b] = bodies[b.system->pairs[TRB_PAIR_pocket].b];
    bodies[second.b].pose.x = trb_add(bodies[second.b].pose.x, trb_v(8e-5 * rig_random(&seed), 8e-5 * rig_random(&seed), 1e-4));
    at.bodies = bodies;
    for (int j = 0; j < 12; j++) {
      compare(&b, &at, &b.system->pairs[TRB_PAIR_pocket], j, &seen);
      compare(&b, &at, &second, j, &seen);
    }
  }
  fprintf(stderr, "%d clear, %d touching, %d of them with facets left out, %d with films\n", seen.clear, seen.touching, seen.apart,
          seen.films);
  rig_close(&b);
  return seen;
}

int main(void)
{
  /* bars that bulge, hollow ones, flat ones in more pieces along than a list has room for; walls in one piece and in many */
  const division divisions[] = {{17, 1, 20e-3, 5}, {9, 2, -7.2e-3, 1}, {3, 1, 0.0, 9}, {2, 80, 0.0, 2}};
  for (int i = 0; i < 4; i++) {
    trb_params p = rig_params();
    p.effects.n_slices = 16, p.roller.profile = i % 2 == 0 ? TRB_PROFILE_STRAIGHT : p.roller.profile;
    happened seen = test_same_forces(&p, &divisions[i]);
    CHECK(seen.clear > 50 && seen.touching > 300 && seen.apart > 100 && seen.films == 0);
    p.pocket.film = 3e-5;
    seen = test_same_forces(&p, &divisions[i]);
    CHECK(seen.clear > 50 && seen.touching > 300 && seen.films > 300);
    p.cage.n_modes = 3;
    seen = test_same_forces(&p, &divisions[i]);
    CHECK(seen.touching > 300 && seen.films > 300);
  }
  trb_params p = rig_params();
  p.roller.profile = TRB_PROFILE_STRAIGHT, p.effects.n_slices = 16, bulge = 4e-6;
  CHECK(test_same_forces(&p, &divisions[0]).touching > 300);
  bulge = 0.0, p = rig_cylinder();
  CHECK(test_same_forces(&p, &divisions[0]).touching > 300);
  return check_report();
}
