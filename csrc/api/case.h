/* A case as the library keeps it: the parameters of the model, and a few numbers of its pockets, loads and start. */
#ifndef TRB_API_CASE_H
#define TRB_API_CASE_H

#include "api/trbdyn.h"
#include "bearing/model.h"

/* X(name, unit, value, lower, upper, text) */
#define TRB_CASE_NUMBERS(X) \
  X(play_radial,          "m",     0.25e-3,  1e-6, 0.1,  "radial play Cpr of the cage, centred, at one roller") \
  X(play_circumferential, "m",     0.12e-3,  1e-6, 0.1,  "circumferential play Cpc of the cage, centred, at one roller") \
  X(play_axial,           "m",     0.4e-3,   1e-6, 0.1,  "axial play of a roller in its pocket") \
  X(speed_rpm,            "rpm",   3000.0,   -1e6, 1e6,  "speed of the inner ring") \
  X(axial_load,           "N",     4930.0,   0,    1e9,  "axial load, which presses the inner ring into the cup") \
  X(radial_load_x,        "N",     0.0,      -1e9, 1e9,  "radial load along x") \
  X(radial_load_y,        "N",     0.0,      -1e9, 1e9,  "radial load along y, against gravity") \
  X(gravity,              "m/s2",  9.80665,  0,    1e4,  "gravity, along -y") \
  X(cage_x,               "m",     0.0,      -0.1, 0.1,  "place of the cage's centre at the start, along x") \
  X(cage_y,               "m",     0.0,      -0.1, 0.1,  "place of the cage's centre at the start, along y")

enum {
#define TRB_CASE_AT(name, unit, value, lower, upper, text) TRB_CASE_##name,
  TRB_CASE_NUMBERS(TRB_CASE_AT)
#undef TRB_CASE_AT
      TRB_N_CASE_NUMBERS
};

struct trb_case {
  trb_params params;
  double     own[TRB_N_CASE_NUMBERS];
};

enum { TRB_CASE_FACES = 4 };

/* The two bars and two end walls of each pocket that the plays give (docs/theory/geometry.md#pockets-and-plays); TRB_CASE_FACES faces. */
trb_status trb_case_faces(const trb_case *c, trb_face *faces, trb_message *message);

/* What an error says, for a caller of the library. */
int trb_say(trb_status status, const trb_message *message, char *error);

#endif
