/* Creating a model: what it holds, and that every wrong number is named. */
#include "bearing/model.h"

#include <stdint.h>

#include "check.h"
#include "rig.h"

static trb_message message;

static trb_status create(const trb_params *p, const double *deviation, int n, const trb_face *faces, int n_faces)
{
  trb_model *m = NULL;
  message = (trb_message){TRB_OK, ""};
  const trb_status status = trb_model_create(p, deviation, n, faces, n_faces, &m, &message);
  CHECK((status == TRB_OK) == (m != NULL));
  CHECK(status == message.status);
  trb_model_free(m);
  return status;
}

static trb_status with(const trb_params *p)
{
  const double     deviation[200] = {0};
  trb_face         faces[RIG_FACES];
  const trb_params nominal = rig_params();
  rig_faces(&nominal, faces);
  return create(p, deviation, 12, faces, RIG_FACES);
}

static void test_contents(void)
{
  const trb_params p = rig_params();
  trb_model       *m = rig_model(&p);
  CHECK(m->n_rollers == 12 && m->n_nodes == RIG_SLICES && m->n_lanes == RIG_SLICES && m->n_slots == 4);
  CHECK(m->pockets.first_face[0] == 0 && m->pockets.first_face[12] == 48 && m->pockets.first_face[5] == 20);
  CHECK(m->friction && m->film && m->pocket_friction);
  trb_params odd = p;
  odd.effects.n_slices = 5, odd.pocket.bars = 0;
  trb_model *n = rig_model(&odd);
  CHECK(n->n_nodes == 5 && n->n_lanes == TRB_LANE_PAD && n->pockets.first_face[12] == 24);
  for (int race = 0; race < TRB_N_RACES; race++) {
    double sum = 0.0;
    for (int k = 0; k < n->n_lanes; k++) {
      CHECK(n->race[race].radius[k] > 0.0 && (k < 5) == (n->race[race].weight[k] > 0.0));
      CHECK_RELATIVE(exp(n->race[race].log_radius[k]), n->race[race].radius[k], 1e-14);
      sum += n->race[race].weight[k];
    }
    CHECK_RELATIVE(sum, p.roller.effective_length, 1e-14);
    CHECK((uintptr_t)n->race[race].weight % 64 == 0 && (uintptr_t)n->race[race].radius % 64 == 0);
  }
  CHECK_RELATIVE(n->race[TRB_RACE_OUTER].radius[2], n->geometry.outer_equivalent_radius, 1e-12);
  CHECK_RELATIVE(n->race[TRB_RACE_INNER].radius[2], n->geometry.inner_equivalent_radius, 1e-12);
  CHECK((uintptr_t)n->centre % 64 == 0 && (uintptr_t)n->sphere % 64 == 0);
  trb_model_free(m);
  trb_model_free(n);
  trb_model_free(NULL);
}

/* A number below, above and not a number, for every entry of the table. */
static void test_every_parameter(void)
{
  const double wrong[] = {NAN, -INFINITY, INFINITY};
  for (int i = 0; i < TRB_N_PARAMS; i++) {
    const trb_param_info *info = &trb_param_table[i];
    for (int k = 0; k < 5; k++) {
      trb_params p = rig_params();
      double    *value = (double *)&p + i;
      *value = k < 3 ? wrong[k] : k == 3 ? info->lower - 1e-3 - 1e-3 * fabs(info->lower) : info->upper * 1.001 + 1e-3;
      CHECK(with(&p) == TRB_ERR_INPUT);
      CHECK(strncmp(message.text, info->name, strlen(info->name)) == 0);
      CHECK_SAYS(message.text, "must be from");
    }
  }
}

static void refused(trb_params p, trb_status status, const char *says)
{
  CHECK(with(&p) == status);
  CHECK_SAYS(message.text, says);
}

static void test_combinations(void)
{
  trb_params p = rig_params();
  CHECK(with(&p) == TRB_OK);
  p.bearing.n_rollers = 12.5;
  refused(p, TRB_ERR_INPUT, "n_rollers = 12.5: must be a whole number");
  p = rig_params(), p.effects.n_slices = 1.5;
  refused(p, TRB_ERR_INPUT, "n_slices = 1.5: must be a whole number");
  p = rig_params(), p.friction.lambda_full = 0.005;
  refused(p, TRB_ERR_INPUT, "lambda_full = 0.005");
  p = rig_params(), p.rib.edge_high = 0.1e-3;
  refused(p, TRB_ERR_INPUT, "rib_edge_high");
  p = rig_params(), p.rib.front_high = 0.3e-3;
  refused(p, TRB_ERR_INPUT, "front_rib_high");
  p = rig_params(), p.rib.front_high = 20e-3;
  refused(p, TRB_ERR_GEOMETRY, "front_rib_high = 0.02 m: the rib would stand beyond");
  p.effects.front_rib = 0;
  CHECK(with(&p) == TRB_OK);
  p = rig_params(), p.bearing.n_rollers = 19;
  const double deviation[19] = {0};
  CHECK(create(&p, deviation, 19, NULL, 0) == TRB_ERR_GEOMETRY);
  CHECK_SAYS(message.text, "n_rollers = 19");
  p = rig_params(), p.roller.profile = 1, p.roller.crown_radius = 1e-3;
  refused(p, TRB_ERR_GEOMETRY, "leave no radius");
}

static void test_deviations(void)
{
  const trb_params p = rig_params();
  double           deviation[12] = {0};
  CHECK(create(&p, deviation, 12, NULL, 0) == TRB_OK);
  CHECK(create(&p, deviation, 11, NULL, 0) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "11 values given, n_rollers = 12 needed");
  deviation[7] = NAN;
  CHECK(create(&p, deviation, 12, NULL, 0) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "roller 7");
  deviation[7] = 2e-3;
  CHECK(create(&p, deviation, 12, NULL, 0) == TRB_ERR_INPUT);
}

static void face_fails(trb_face face, const char *says)
{
  const trb_params p = rig_params();
  const double     deviation[12] = {0};
  trb_face         faces[RIG_FACES];
  rig_faces(&p, faces);
  faces[2] = face;
  CHECK(create(&p, deviation, 12, faces, RIG_FACES) == TRB_ERR_INPUT);
  CHECK_SAYS(message.text, "pocket face 2");
  CHECK_SAYS(message.text, says);
}

static void test_faces(void)
{
  const trb_params p = rig_params();
  trb_face         faces[RIG_FACES], f;
  rig_faces(&p, faces);
  for (int i = 0; i < TRB_N_FACE_COLUMNS; i++) {
    f = faces[2];
    ((double *)&f)[i] = i % 2 ? NAN : INFINITY;
    face_fails(f, "not finite");
  }
  f = faces[2], f.u[1] = 1.001;
  face_fails(f, "unit vectors");
  f = faces[2], f.v[0] = 0.6, f.v[1] = 0.8;
  face_fails(f, "unit vectors at right angles");
  f = faces[2], f.pocket[0] = 12;
  face_fails(f, "pocket = 12: must be -1 (all) or 0 to 11");
  f = faces[2], f.pocket[0] = 0.5;
  face_fails(f, "pocket = 0.5");
  f = faces[2], f.part[0] = 3;
  face_fails(f, "part = 3");
  f = faces[2], f.slot[0] = 64;
  face_fails(f, "slot = 64");
  f = faces[2], f.slot[0] = -1;
  face_fails(f, "slot = -1");
  f = faces[2], f.stiffness_factor[0] = 0;
  face_fails(f, "stiffness_factor = 0 must be > 0");
  f = faces[2], f.friction_factor[0] = -1;
  face_fails(f, "friction_factor = -1");
  const double counts[] = {2, 13, 3.5, -4};
  for (int i = 0; i < 4; i++) {
    f = faces[2], f.n_vertices[0] = counts[i];
    face_fails(f, "must be 3 to 12");
  }
}

static void outline_fails(int n, const double *outline, const char *says)
{
  const trb_params p = rig_params();
  trb_face         faces[RIG_FACES];
  rig_faces(&p, faces);
  faces[2].n_vertices[0] = n;
  for (int i = 0; i < 2 * n; i++) faces[2].outline[i] = 1e-3 * outline[i];
  face_fails(faces[2], says);
}

static void test_outlines(void)
{
  const double clockwise[8] = {0, 0, 0, 1, 1, 1, 1, 0}, dent[10] = {0, 0, 2, 0, 1, 0.5, 2, 2, 0, 2},
               idle[10] = {0, 0, 1, 0, 2, 0, 2, 2, 0, 2};
  const double twice[10] = {0, 0, 1, 0, 1, 0, 1, 1, 0, 1}, flat[6] = {0, 0, 1, 0, 2, 0};
  double       star[10];
  outline_fails(4, clockwise, "convex and counter-clockwise");
  outline_fails(5, dent, "convex");
  outline_fails(5, idle, "convex");
  outline_fails(5, twice, "convex");
  outline_fails(3, flat, "convex");
  /* a pentagram turns left at every vertex, twice around */
  for (int i = 0; i < 5; i++) star[2 * i] = cos(0.8 * TRB_PI * i), star[2 * i + 1] = sin(0.8 * TRB_PI * i);
  outline_fails(5, star, "crosses itself");
}

static void test_faces_of_single_pockets(void)
{
  const trb_params p = rig_params();
  const double     deviation[12] = {0};
  trb_face         faces[RIG_FACES];
  trb_model       *m = NULL;
  rig_faces(&p, faces);
  faces[0].pocket[0] = 3, faces[1].pocket[0] = 11, faces[1].slot[0] = 9;
  CHECK(trb_model_create(&p, deviation, 12, faces, RIG_FACES, &m, NULL) == TRB_OK);
  if (m == NULL) return;
  CHECK(m->n_slots == 10);
  for (int j = 0; j < 12; j++) CHECK(m->pockets.first_face[j + 1] - m->pockets.first_face[j] == (j == 3 || j == 11 ? 3 : 2));
  trb_model_free(m);
}

static void test_status(void)
{
  for (int i = 0; i < TRB_N_STATUSES; i++) CHECK(strlen(trb_status_text((trb_status)i)) > 3);
  CHECK_SAYS(trb_status_text((trb_status)99), "unknown");
  CHECK(trb_fail(NULL, TRB_ERR_LOAD, "%d", 5) == TRB_ERR_LOAD);
  char long_text[2 * TRB_MESSAGE_LENGTH];
  memset(long_text, 'x', sizeof long_text - 1);
  long_text[sizeof long_text - 1] = '\0';
  CHECK(trb_fail(&message, TRB_ERR_STEP, "%s", long_text) == TRB_ERR_STEP);
  CHECK(strlen(message.text) == TRB_MESSAGE_LENGTH - 1);
}

int main(void)
{
  test_contents();
  test_every_parameter();
  test_combinations();
  test_deviations();
  test_faces();
  test_outlines();
  test_faces_of_single_pockets();
  test_status();
  return check_report();
}
