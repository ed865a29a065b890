/* Cases: numbers by their names. The parameters of the 30310 with the default effects are those of trbdyn.cases.rig_30310; a test compares
 * them (tests/api/test_core_alone.py). */
#include "api/case.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct trb_standard_number {
  int    at; /* number of the input */
  double value;
} trb_standard_number;

static const trb_standard_number trb_standard_case[] = {
#define TRB_STANDARD(name, value) {TRB_PARAM_##name, value},
#include "api/standard_case.inc"
#undef TRB_STANDARD
};

static const trb_described trb_case_table[TRB_N_CASE_NUMBERS] = {
#define TRB_CASE_ROW(name, unit, value, lower, upper, text) {#name, unit, text, lower, upper},
    TRB_CASE_NUMBERS(TRB_CASE_ROW)
#undef TRB_CASE_ROW
};

int trb_say(trb_status status, const trb_message *message, char *error)
{
  if (status == TRB_OK || error == NULL) return status;
  const char *text = message->text[0] != '\0' ? message->text : trb_status_text(status);
  (void)snprintf(error, TRB_ERROR_LENGTH, "%s", text);
  return status;
}

const char *trb_error_text(int status) { return trb_status_text((trb_status)status); }

trb_case *trb_case_new(void)
{
  trb_case *c = calloc(1, sizeof *c);
  if (c == NULL) return NULL;
  for (size_t i = 0; i < sizeof trb_standard_case / sizeof *trb_standard_case; i++)
    ((double *)&c->params)[trb_standard_case[i].at] = trb_standard_case[i].value;
#define TRB_CASE_VALUE(name, unit, value, lower, upper, text) c->own[TRB_CASE_##name] = value;
  TRB_CASE_NUMBERS(TRB_CASE_VALUE)
#undef TRB_CASE_VALUE
  return c;
}

void trb_case_free(trb_case *c) { free(c); }

int trb_case_describe(int i, trb_described *described)
{
  if (i < 0 || i >= TRB_N_CASE_NUMBERS + TRB_N_PARAMS) return 0;
  if (i < TRB_N_CASE_NUMBERS) {
    *described = trb_case_table[i];
    return 1;
  }
  const trb_param_info *info = &trb_param_table[i - TRB_N_CASE_NUMBERS];
  *described = (trb_described){info->name, info->unit, info->text, info->lower, info->upper};
  return 1;
}

/* Place of a number, with what is known of it; NULL: there is none of this name. */
static double *number_of(trb_case *c, const char *name, trb_described *described)
{
  for (int i = 0; trb_case_describe(i, described); i++)
    if (strcmp(described->name, name) == 0) return i < TRB_N_CASE_NUMBERS ? &c->own[i] : (double *)&c->params + (i - TRB_N_CASE_NUMBERS);
  return NULL;
}

int trb_case_set(trb_case *c, const char *name, double value, char *error)
{
  trb_message   message = {TRB_OK, ""};
  trb_described d;
  double       *number = number_of(c, name, &d);
  if (number == NULL) return trb_say(trb_fail(&message, TRB_ERR_INPUT, "%s: a case has no number of this name", name), &message, error);
  const int whole = strcmp(d.unit, "count") == 0 || strcmp(d.unit, "choice") == 0;
  if (!(value >= d.lower && value <= d.upper) || (whole && value != floor(value))) {
    trb_fail(&message, TRB_ERR_INPUT, "%s = %.9g: must be %sfrom %g to %g (%s)", name, value, whole ? "a whole number " : "", d.lower,
             d.upper, d.unit);
    return trb_say(TRB_ERR_INPUT, &message, error);
  }
  *number = value;
  return TRB_OK;
}

int trb_case_get(const trb_case *c, const char *name, double *value, char *error)
{
  trb_message   message = {TRB_OK, ""};
  trb_described d;
  trb_case      copy = *c;
  const double *number = number_of(&copy, name, &d);
  if (number == NULL) return trb_say(trb_fail(&message, TRB_ERR_INPUT, "%s: a case has no number of this name", name), &message, error);
  *value = *number;
  return TRB_OK;
}

static void put(double *to, trb_vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/* A face of all pockets with a rectangle for an outline. */
static trb_face rectangle(int slot, int part, trb_vec3 origin, trb_vec3 u, trb_vec3 v, const double from[2], const double to[2])
{
  trb_face f = {.pocket = {-1}, .stiffness_factor = {1}, .friction_factor = {1}};
  f.slot[0] = slot, f.part[0] = part, f.n_vertices[0] = 4;
  put(f.origin, origin), put(f.u, u), put(f.v, v);
  const double outline[8] = {from[0], from[1], to[0], from[1], to[0], to[1], from[0], to[1]};
  memcpy(f.outline, outline, sizeof outline);
  return f;
}

trb_status trb_case_faces(const trb_case *c, trb_face *faces, trb_message *message)
{
  const trb_params *p = &c->params;
  trb_geometry      g;
  const trb_status  status = trb_geometry_derive(p, &g, message);
  if (status != TRB_OK) return status;
  /* sizes of the faces are those of the 30310, in proportion to the roller's diameter */
  const double scale = p->roller.diameter / 14e-3, half = 0.5 * p->roller.effective_length;
  const double sn = sin(g.roller_half_angle), cn = cos(g.roller_half_angle), cm = cos(g.roller_axis_angle);
  const double ratio = c->own[TRB_CASE_play_circumferential] / c->own[TRB_CASE_play_radial];
  const double lean = atan2(ratio, cm) + asin(sn / cn * sin(g.roller_axis_angle) / hypot(cm, ratio));
  const double gap = c->own[TRB_CASE_play_circumferential] * cn * cos(lean);
  for (int i = 0; i < 2; i++) {
    const trb_vec3 m = trb_v(sin(lean), (i == 0 ? 1 : -1) * cos(lean), 0), a = trb_v(0, 0, 1);
    const trb_vec3 outward = trb_axpy(trb_scale(cn, m), -sn, a), along = trb_axpy(trb_scale(cn, a), sn, m);
    const trb_vec3 origin = trb_axpy(trb_scale(0.5 * p->roller.diameter, m), gap, outward);
    const double   from[2] = {-half, -1.5e-3 * scale}, to[2] = {half, 1.5e-3 * scale};
    faces[i] = rectangle(i, TRB_PART_FLANK, origin, along, trb_cross(trb_scale(-1, outward), along), from, to);
  }
  const double low = 1.5e-3 * scale, high = 4.5e-3 * scale, wide = 6e-3 * scale, narrow = 4.9e-3 * scale;
  const double large = g.sphere_centre - g.apex_to_mid + sqrt(g.sphere_radius * g.sphere_radius - low * low);
  faces[2] =
      rectangle(2, TRB_PART_LARGE_END, trb_v(0, 0, large), trb_v(0, 1, 0), trb_v(1, 0, 0), (double[]){-wide, low}, (double[]){wide, high});
  faces[3] = rectangle(3, TRB_PART_SMALL_END, trb_v(0, 0, g.small_end_station - c->own[TRB_CASE_play_axial]), trb_v(1, 0, 0),
                       trb_v(0, 1, 0), (double[]){low, -narrow}, (double[]){high, narrow});
  return TRB_OK;
}
