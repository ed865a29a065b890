#include "stepping/coupling.h"

#include <string.h>

static const trb_vec3 none = {0, 0, 0}, third = {0, 0, 1};

static trb_vec3 to_roller(const trb_coupling *k, trb_vec3 v) { return trb_turn_z(v, k->roller->cosine, -k->roller->sine); }
static trb_vec3 to_body(const trb_coupling *k, trb_vec3 v) { return trb_turn_z(v, k->roller->cosine, k->roller->sine); }

static void along_axes(const trb_coupling *k, trb_rigid motion, double along[6])
{
  const trb_vec3 shift = trb_to_frame(&k->slopes.axes, motion.shift), turn = trb_to_frame(&k->slopes.axes, motion.turn);
  const double   found[6] = {shift.x, shift.y, shift.z, turn.x, turn.y, turn.z};
  memcpy(along, found, sizeof found);
}

/* When the other body moves, the roller moves the other way relative to it. */
static trb_rigid other_way(const trb_coupling *k, trb_rigid motion)
{
  const trb_vec3 shift = trb_scale(-1.0, to_roller(k, motion.shift)), turn = trb_scale(-1.0, to_roller(k, motion.turn));
  return (trb_rigid){trb_add(shift, trb_cross(turn, k->arm)), turn};
}

/* Change of the wrench on the roller with a motion relative to the other body. */
static trb_wrench wrench_of(const trb_coupling *k, trb_rigid motion, int is_place)
{
  const trb_wrench *columns = is_place ? k->slopes.place : k->slopes.velocity;
  const trb_frame  *axes = &k->slopes.axes;
  double            along[6];
  trb_wrench        sum = {none, none};
  along_axes(k, motion, along);
  for (int c = 0; c < 6; c++) {
    sum.force = trb_axpy(sum.force, along[c], columns[c].force);
    sum.moment = trb_axpy(sum.moment, along[c], columns[c].moment);
  }
  return (trb_wrench){trb_from_frame(axes, sum.force), trb_from_frame(axes, sum.moment)};
}

/* Loads of both bodies from the change of the wrench; shift: of the roller from the other body's centre, which is an arm of the force. */
static trb_load loads_of(const trb_coupling *k, trb_wrench change, trb_vec3 shift)
{
  trb_load load;
  memset(&load, 0, sizeof load);
  load.on_a.force = change.force;
  load.on_a.moment = change.moment;
  load.on_b.force = to_body(k, trb_scale(-1.0, change.force));
  load.on_b.moment =
      to_body(k, trb_scale(-1.0, trb_add(change.moment, trb_add(trb_cross(k->arm, change.force), trb_cross(shift, k->force)))));
  return load;
}

void trb_coupling_place(trb_coupling *k, const trb_roller_pose *roller, const trb_body *other, const trb_rigid_pose *body,
                        const trb_load *load)
{
  k->roller = roller;
  k->other = other;
  k->body = body;
  k->arm = trb_sub(roller->x, to_roller(k, body->x));
  k->force = load->on_a.force;
  k->moment = load->on_a.moment;
}

trb_load trb_coupling_of_roller(const trb_coupling *k, int coordinate)
{
  const int       is_place = coordinate < TRB_ROLLER_v_r;
  const trb_rigid motion = trb_roller_motion(k->roller, coordinate);
  trb_load        load = loads_of(k, wrench_of(k, motion, is_place), is_place ? motion.shift : none);
  if (!is_place) return load;
  /* force and moment are written in frames that turn with the roller */
  if (coordinate == TRB_ROLLER_psi) load.on_a.force = trb_sub(load.on_a.force, trb_cross(third, k->force));
  load.on_a.moment = trb_sub(load.on_a.moment, trb_cross(motion.turn, k->moment));
  return load;
}

trb_load trb_coupling_of_body(const trb_coupling *k, int coordinate)
{
  const int       is_place = trb_is_place(&k->other->coordinates[coordinate]);
  const trb_rigid motion = k->other->kind->motion(k->body, coordinate);
  const trb_vec3  shift = trb_scale(-1.0, to_roller(k, motion.shift)), turn = trb_scale(-1.0, to_roller(k, motion.turn));
  trb_wrench      change = wrench_of(k, other_way(k, motion), is_place);
  if (!is_place) return loads_of(k, change, none);
  /* the forces turn with the body */
  change.force = trb_sub(change.force, trb_cross(turn, k->force));
  change.moment = trb_sub(change.moment, trb_cross(turn, k->moment));
  return loads_of(k, change, shift);
}

trb_load trb_coupling_of_mode(const trb_coupling *k, int mode, int is_place, double by)
{
  const trb_wrench *change = is_place ? &k->slopes.modal->place[mode] : &k->slopes.modal->rate[mode];
  const trb_frame  *axes = &k->slopes.axes;
  const trb_wrench  all = {trb_scale(by, trb_from_frame(axes, change->force)), trb_scale(by, trb_from_frame(axes, change->moment))};
  return loads_of(k, all, none);
}

void trb_coupling_along(const trb_coupling *k, int of_body, int coordinate, double along[6])
{
  along_axes(k, of_body ? other_way(k, k->other->kind->motion(k->body, coordinate)) : trb_roller_motion(k->roller, coordinate), along);
}
