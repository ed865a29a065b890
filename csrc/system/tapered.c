#include "system/tapered.h"

#include <stdlib.h>

#include "body/cage.h"
#include "body/elastic_cage.h"
#include "body/free_ring.h"
#include "body/ring.h"

enum {
  FLANK,
  LARGE_END,
  SMALL_END,
  ROLLER,
  OUTER_RACE,
  INNER_RACE,
  BACK_FACE,
  FRONT_FACE,
  OIL,
  POCKETS,
  GUIDED,
  INNER_LAND,
  OUTER_LAND,
  WHOLE_CAGE,
  OTHER_END,
  OUTER_BACK_FACE,
  OUTER_FRONT_FACE,
  N_SURFACES
};

/* Of tapered bearings. What cylindrical bearings alone have comes last: a row behind it would be cut off without a word. */
enum { N_TAPERED_SURFACES = OTHER_END };
_Static_assert(N_SURFACES - OTHER_END == 3, "put new surfaces before OTHER_END");
_Static_assert(TRB_N_PAIRS - TRB_PAIR_outer_rib == 2, "put new pairs before outer_rib in TRB_PAIRS");

static void add_bodies(trb_system *s)
{
  s->n_bodies = TRB_N_BODIES;
  s->driven = TRB_BODY_INNER_RING;
  const trb_body_kind *outer = s->model->params.outer_ring.turns > 0.0 ? &trb_ring_turning : &trb_ring_at_rest;
  s->bodies[TRB_BODY_OUTER_RING] = (trb_body){.kind = outer, .name = "outer ring"};
  if (s->model->params.outer_ring.free > 0.0)
    s->bodies[TRB_BODY_OUTER_RING] = (trb_body){.kind = &trb_ring_housed,
                                                .name = "outer ring",
                                                .own = &s->model->ring[TRB_RACE_OUTER],
                                                .loss = TRB_BOOK(TRB_LOSS_support),
                                                .carried = s->model->params.outer_ring.carried > 0.0};
  s->bodies[TRB_BODY_INNER_RING] = (trb_body){.kind = &trb_ring_prescribed, .name = "inner ring"};
  if (s->model->params.inner_ring.free > 0.0)
    s->bodies[TRB_BODY_INNER_RING] = (trb_body){.kind = &trb_ring_free,
                                                .name = "inner ring",
                                                .own = &s->model->ring[TRB_RACE_INNER],
                                                .loss = TRB_BOOK(TRB_LOSS_support),
                                                .carried = s->model->params.inner_ring.carried > 0.0};
  const trb_body_kind *cage = s->model->params.effects.with_cage > 1.0 ? &trb_body_spacer : &trb_body_cage;
  s->bodies[TRB_BODY_CAGE] = (trb_body){.kind = cage, .name = "cage", .own = &s->model->params.cage};
  if (s->model->modes.n > 0) {
    s->bodies[TRB_BODY_CAGE] = trb_elastic_cage_of(&s->model->modes, "cage");
    s->bodies[TRB_BODY_CAGE].own = &s->model->params.cage;
    s->bodies[TRB_BODY_CAGE].loss = TRB_BOOK(TRB_LOSS_vibration);
  }
  s->bodies[TRB_BODY_OIL] = (trb_body){.kind = &trb_fluid_at_rest, .name = "oil"};
}

static void add_surfaces(trb_system *s)
{
  const trb_model *m = s->model;
  s->n_surfaces = trb_has_cylinders(m) ? N_SURFACES : N_TAPERED_SURFACES;
  s->surfaces[FLANK] = (trb_surface){"flank", TRB_ROLLERS, TRB_SHAPE_FLANK, m};
  s->surfaces[LARGE_END] = (trb_surface){"large end", TRB_ROLLERS, TRB_SHAPE_SPHERE, &m->surfaces.end[TRB_END_LARGE]};
  s->surfaces[SMALL_END] = (trb_surface){"small end", TRB_ROLLERS, TRB_SHAPE_PLANE, &m->surfaces.small_end};
  s->surfaces[ROLLER] = (trb_surface){"roller", TRB_ROLLERS, TRB_SHAPE_NONE, NULL};
  s->surfaces[OUTER_RACE] = (trb_surface){"outer raceway", TRB_BODY_OUTER_RING, TRB_SHAPE_RACE, &m->race[TRB_RACE_OUTER]};
  s->surfaces[INNER_RACE] = (trb_surface){"inner raceway", TRB_BODY_INNER_RING, TRB_SHAPE_RACE, &m->race[TRB_RACE_INNER]};
  s->surfaces[BACK_FACE] = (trb_surface){"back-face rib", TRB_BODY_INNER_RING, TRB_SHAPE_CONE, &m->rib[TRB_RACE_INNER][TRB_END_LARGE]};
  s->surfaces[FRONT_FACE] = (trb_surface){"front rib", TRB_BODY_INNER_RING, TRB_SHAPE_CIRCLES, m->surfaces.front_rib};
  s->surfaces[OIL] = (trb_surface){"mixture of oil and air", TRB_BODY_OIL, TRB_SHAPE_NONE, &m->params.oil};
  s->surfaces[POCKETS] = (trb_surface){"pockets", TRB_BODY_CAGE, TRB_SHAPE_POCKETS, &m->pockets};
  s->surfaces[GUIDED] = (trb_surface){"guiding surface", TRB_BODY_CAGE, TRB_SHAPE_CYLINDER, &m->guided};
  s->surfaces[INNER_LAND] = (trb_surface){"land of the inner ring", TRB_BODY_INNER_RING, TRB_SHAPE_LAND, &m->guide[TRB_RACE_INNER]};
  s->surfaces[OUTER_LAND] = (trb_surface){"land of the outer ring", TRB_BODY_OUTER_RING, TRB_SHAPE_LAND, &m->guide[TRB_RACE_OUTER]};
  s->surfaces[WHOLE_CAGE] = (trb_surface){"cage", TRB_BODY_CAGE, TRB_SHAPE_NONE, &m->params.cage};
  if (!trb_has_cylinders(m)) return;
  s->surfaces[FRONT_FACE] = (trb_surface){"front rib", TRB_BODY_INNER_RING, TRB_SHAPE_CONE, &m->rib[TRB_RACE_INNER][TRB_END_SMALL]};
  s->surfaces[OTHER_END] = (trb_surface){"sphere of the small end", TRB_ROLLERS, TRB_SHAPE_SPHERE, &m->surfaces.end[TRB_END_SMALL]};
  s->surfaces[OUTER_BACK_FACE] =
      (trb_surface){"rib of the outer ring at the large ends", TRB_BODY_OUTER_RING, TRB_SHAPE_CONE, &m->rib[TRB_RACE_OUTER][TRB_END_LARGE]};
  s->surfaces[OUTER_FRONT_FACE] =
      (trb_surface){"rib of the outer ring at the small ends", TRB_BODY_OUTER_RING, TRB_SHAPE_CONE, &m->rib[TRB_RACE_OUTER][TRB_END_SMALL]};
}

#define SLIDES(name) {[TRB_BY_SLIDING] = TRB_BOOK(TRB_LOSS_##name), [TRB_BY_DAMPING] = TRB_BOOK(TRB_LOSS_damping)}
#define ROLLS(name) \
  {[TRB_BY_SLIDING] = TRB_BOOK(TRB_LOSS_##name), \
   [TRB_BY_ROLLING] = TRB_BOOK(TRB_LOSS_rolling), \
   [TRB_BY_ROLLING_PRESSURE] = TRB_BOOK(TRB_LOSS_rolling_pressure), \
   [TRB_BY_DAMPING] = TRB_BOOK(TRB_LOSS_damping)}
#define FLOATS \
  {[TRB_BY_SLIDING] = TRB_BOOK(TRB_LOSS_land), \
   [TRB_BY_DAMPING] = TRB_BOOK(TRB_LOSS_damping), \
   [TRB_BY_FILM] = TRB_BOOK(TRB_LOSS_land_film)}
#define TURNS(name) {[TRB_BY_SLIDING] = TRB_BOOK(TRB_TORQUE_##name)}

/* Names, and whether a pair is on, are put in by add_pairs; bodies and parameters follow from the surfaces (trb_system_finish). */
static const trb_pair rows[TRB_N_PAIRS] = {
    [TRB_PAIR_outer] = {.kind = &trb_pair_raceway,
                        .text = "roller on the outer raceway",
                        .surface = {FLANK, OUTER_RACE},
                        .books = {.loss = ROLLS(traction_outer)}},
    [TRB_PAIR_inner] = {.kind = &trb_pair_raceway,
                        .text = "roller on the inner raceway",
                        .surface = {FLANK, INNER_RACE},
                        .books = {.loss = ROLLS(traction_inner),
                                  .torque = {[TRB_BY_SLIDING] = TRB_BOOK(TRB_TORQUE_traction),
                                             [TRB_BY_ROLLING] = TRB_BOOK(TRB_TORQUE_rolling)}}},
    [TRB_PAIR_rib] = {.kind = &trb_pair_rib,
                      .text = "roller's large end on the back-face rib",
                      .surface = {LARGE_END, BACK_FACE},
                      .books = {.loss = SLIDES(rib), .torque = TURNS(rib)}},
    [TRB_PAIR_front_rib] = {.kind = &trb_pair_front_rib,
                            .text = "roller's small end on the front rib",
                            .surface = {SMALL_END, FRONT_FACE},
                            .books = {.loss = SLIDES(front_rib), .torque = TURNS(front_rib)}},
    [TRB_PAIR_drag] = {.kind = &trb_pair_drag,
                       .text = "roller in the mixture of oil and air",
                       .surface = {ROLLER, OIL},
                       .books = {.loss = {[TRB_BY_SLIDING] = TRB_BOOK(TRB_LOSS_drag)}}},
    [TRB_PAIR_pocket] = {.kind = &trb_pair_pocket,
                         .text = "roller in its pocket of the cage",
                         .surface = {ROLLER, POCKETS},
                         .books = {.loss = SLIDES(pocket)}},
    [TRB_PAIR_inner_land] = {.kind = &trb_pair_land,
                             .text = "cage on a land of the inner ring",
                             .surface = {GUIDED, INNER_LAND},
                             .books = {.loss = FLOATS,
                                       .torque = {[TRB_BY_SLIDING] = TRB_BOOK(TRB_TORQUE_land),
                                                  [TRB_BY_FILM] = TRB_BOOK(TRB_TORQUE_land)}}},
    [TRB_PAIR_outer_land] = {.kind = &trb_pair_land,
                             .text = "cage in a land of the outer ring",
                             .surface = {GUIDED, OUTER_LAND},
                             .books = {.loss = FLOATS}},
    [TRB_PAIR_cage_drag] = {.kind = &trb_pair_cage_drag,
                            .text = "end faces of the cage in the mixture of oil and air",
                            .surface = {WHOLE_CAGE, OIL},
                            .books = {.loss = {[TRB_BY_SLIDING] = TRB_BOOK(TRB_LOSS_drag)}}},
    [TRB_PAIR_outer_rib] = {.kind = &trb_pair_rib,
                            .text = "roller's large end on the rib of the outer ring",
                            .surface = {LARGE_END, OUTER_BACK_FACE},
                            .books = {.loss = SLIDES(rib)}},
    [TRB_PAIR_outer_front_rib] = {.kind = &trb_pair_rib,
                                  .text = "roller's small end on the rib of the outer ring",
                                  .surface = {OTHER_END, OUTER_FRONT_FACE},
                                  .books = {.loss = SLIDES(front_rib)}},
};

/* Which pairs the effects of the scene leave on. */
static int is_on(const trb_model *m, int pair)
{
  const trb_params *p = &m->params;
  switch (pair) {
  case TRB_PAIR_rib: return p->effects.back_rib > 0.0;
  case TRB_PAIR_front_rib: return p->effects.front_rib > 0.0;
  case TRB_PAIR_outer_rib: return p->rib.outer > 0.0;
  case TRB_PAIR_outer_front_rib: return p->rib.outer_front > 0.0;
  case TRB_PAIR_drag: return p->effects.oil_fill > 0.0 && p->effects.drag_coefficient > 0.0;
  case TRB_PAIR_pocket: return m->pockets.first_face[m->n_rollers] > 0;
  case TRB_PAIR_inner_land: return trb_has_cage(m) && p->effects.guidance == TRB_GUIDANCE_INNER_LAND;
  case TRB_PAIR_outer_land: return trb_has_cage(m) && p->effects.guidance == TRB_GUIDANCE_OUTER_LAND;
  case TRB_PAIR_cage_drag: return p->effects.with_cage > 0.0 && p->effects.oil_fill > 0.0 && p->cage.face_outer > p->cage.face_inner;
  default: return 1;
  }
}

static void add_pairs(trb_system *s)
{
#define TRB_PAIR_NAME(name) #name,
  static const char *const names[TRB_N_PAIRS] = {TRB_PAIRS(TRB_PAIR_NAME)};
#undef TRB_PAIR_NAME
  s->n_pairs = trb_has_cylinders(s->model) ? TRB_N_PAIRS : TRB_N_TAPERED_PAIRS;
  for (int i = 0; i < s->n_pairs; i++) {
    s->pairs[i] = rows[i];
    s->pairs[i].name = names[i];
    s->pairs[i].on = is_on(s->model, i);
  }
  if (trb_has_cylinders(s->model)) { /* both ends are spheres */
    s->pairs[TRB_PAIR_front_rib].kind = &trb_pair_rib;
    s->pairs[TRB_PAIR_front_rib].surface[0] = OTHER_END;
  }
  if (!(s->model->pockets.film > 0.0)) return;
  s->pairs[TRB_PAIR_pocket].kind = &trb_pair_pocket_with_film;
  s->pairs[TRB_PAIR_pocket].books.loss[TRB_BY_FILM] = TRB_BOOK(TRB_LOSS_pocket_film);
}

trb_status trb_system_tapered(const trb_model *model, trb_system **system, trb_message *message)
{
  trb_system *s = calloc(1, sizeof *s);
  *system = NULL;
  if (s == NULL) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for a system");
  s->model = model;
  if (model->modes.n != (int)model->params.cage.n_modes) {
    trb_system_free(s);
    return trb_fail(message, TRB_ERR_INPUT, "cage_modes = %g: %d modes are given", model->params.cage.n_modes, model->modes.n);
  }
  add_bodies(s);
  add_surfaces(s);
  add_pairs(s);
  const trb_status status = trb_system_finish(s, message);
  if (status != TRB_OK) {
    trb_system_free(s);
    return status;
  }
  *system = s;
  return TRB_OK;
}

void trb_system_free(trb_system *system) { free(system); }
