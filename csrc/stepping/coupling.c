#include "stepping/coupling.h"

#include <string.h>

/* A rigid motion, about a body's centre of mass. */
typedef struct rigid {
  trb_vec3 shift, turn;
} rigid;

static const trb_vec3 none = {0, 0, 0}, first = {1, 0, 0}, second = {0, 1, 0}, third = {0, 0, 1};

/* What a roller's coordinate does to its place, or to its velocity, in its cylindrical frame. */
static rigid roller_motion(const trb_roller_pose *r, int coordinate)
{
  const trb_frame *f = &r->frame;
  switch (coordinate) {
  case TRB_ROLLER_r:
  case TRB_ROLLER_v_r: return (rigid){first, none};
  case TRB_ROLLER_psi: return (rigid){trb_scale(r->radius, second), third};
  case TRB_ROLLER_v_t: return (rigid){second, none};
  case TRB_ROLLER_z:
  case TRB_ROLLER_v_z: return (rigid){third, none};
  case TRB_ROLLER_skew: return (rigid){none, trb_scale(-1.0, f->n)};
  case TRB_ROLLER_tilt: return (rigid){none, second};
  case TRB_ROLLER_omega_n: return (rigid){none, f->n};
  case TRB_ROLLER_omega_t: return (rigid){none, f->t};
  default: return (rigid){none, f->a};
  }
}

/* The same of the cage, in R. */
static rigid cage_motion(const trb_cage_pose *cage, int coordinate)
{
  const trb_frame *f = &cage->frame;
  switch (coordinate) {
  case TRB_CAGE_x:
  case TRB_CAGE_v_x: return (rigid){first, none};
  case TRB_CAGE_y:
  case TRB_CAGE_v_y: return (rigid){second, none};
  case TRB_CAGE_z:
  case TRB_CAGE_v_z: return (rigid){third, none};
  case TRB_CAGE_skew: return (rigid){none, trb_scale(-1.0, f->n)};
  case TRB_CAGE_tilt: return (rigid){none, second};
  case TRB_CAGE_omega_n: return (rigid){none, f->n};
  case TRB_CAGE_omega_t: return (rigid){none, f->t};
  default: return (rigid){none, f->a};
  }
}

static trb_vec3 to_roller(const trb_coupling *k, trb_vec3 v) { return trb_turn_z(v, k->roller->cosine, -k->roller->sine); }
static trb_vec3 to_cage(const trb_coupling *k, trb_vec3 v) { return trb_turn_z(v, k->roller->cosine, k->roller->sine); }

/* Change of the wrench on the roller with a motion relative to the pocket. */
static trb_wrench wrench_of(const trb_coupling *k, rigid motion, int is_place)
{
  const trb_wrench *columns = is_place ? k->slopes.place : k->slopes.velocity;
  const trb_frame  *axes = &k->slopes.axes;
  const trb_vec3    shift = trb_to_frame(axes, motion.shift), turn = trb_to_frame(axes, motion.turn);
  const double      along[6] = {shift.x, shift.y, shift.z, turn.x, turn.y, turn.z};
  trb_wrench        sum = {none, none};
  for (int c = 0; c < 6; c++) {
    sum.force = trb_axpy(sum.force, along[c], columns[c].force);
    sum.moment = trb_axpy(sum.moment, along[c], columns[c].moment);
  }
  return (trb_wrench){trb_from_frame(axes, sum.force), trb_from_frame(axes, sum.moment)};
}

/* Loads of roller and cage from the change of the wrench; shift: of the roller from the cage's centre, which is an arm of the force. */
static trb_roller_load loads_of(const trb_coupling *k, trb_wrench change, trb_vec3 shift)
{
  trb_roller_load load;
  memset(&load, 0, sizeof load);
  load.force = change.force;
  load.moment = change.moment;
  load.cage_force = to_cage(k, trb_scale(-1.0, change.force));
  load.cage_moment =
      to_cage(k, trb_scale(-1.0, trb_add(change.moment, trb_add(trb_cross(k->arm, change.force), trb_cross(shift, k->force)))));
  return load;
}

void trb_coupling_place(trb_coupling *k, const trb_roller_pose *roller, const trb_cage_pose *cage, const trb_roller_load *load)
{
  k->roller = roller;
  k->cage = cage;
  k->arm = trb_sub(roller->x, to_roller(k, cage->x));
  k->force = load->force;
  k->moment = load->moment;
}

trb_roller_load trb_coupling_of_roller(const trb_coupling *k, int coordinate)
{
  const int       is_place = coordinate < TRB_ROLLER_v_r;
  const rigid     motion = roller_motion(k->roller, coordinate);
  trb_roller_load load = loads_of(k, wrench_of(k, motion, is_place), is_place ? motion.shift : none);
  if (!is_place) return load;
  /* force and moment are written in frames that turn with the roller */
  if (coordinate == TRB_ROLLER_psi) load.force = trb_sub(load.force, trb_cross(third, k->force));
  load.moment = trb_sub(load.moment, trb_cross(motion.turn, k->moment));
  return load;
}

trb_roller_load trb_coupling_of_cage(const trb_coupling *k, int coordinate)
{
  const int      is_place = coordinate < TRB_CAGE_v_x;
  const rigid    cage = cage_motion(k->cage, coordinate);
  const trb_vec3 shift = trb_scale(-1.0, to_roller(k, cage.shift)), turn = trb_scale(-1.0, to_roller(k, cage.turn));
  trb_wrench     change = wrench_of(k, (rigid){trb_add(shift, trb_cross(turn, k->arm)), turn}, is_place);
  if (!is_place) return loads_of(k, change, none);
  /* when the cage moves, the roller moves the other way in its pocket, and the forces turn with the cage */
  change.force = trb_sub(change.force, trb_cross(turn, k->force));
  change.moment = trb_sub(change.moment, trb_cross(turn, k->moment));
  return loads_of(k, change, shift);
}
