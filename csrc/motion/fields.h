/* The table of all recorded quantities. It defines the layout of a record; the HDF5 file, the plots and the documentation take names,
 * units, shapes and texts from here.
 *
 * TRB_FIELDS(X): X(name, group, kind, unit, text). A kind is a shape; roller = one number for each roller. */
#ifndef TRB_MOTION_FIELDS_H
#define TRB_MOTION_FIELDS_H

#include "bearing/losses.h"
#include "contact/contact.h"
#include "system/tapered.h"

typedef enum trb_field_kind {
  TRB_FIELD_SCALAR,      /* ()        */
  TRB_FIELD_VEC2,        /* (2,)      */
  TRB_FIELD_VEC3,        /* (3,)      */
  TRB_FIELD_QUATERNION,  /* (4,)      w, x, y, z */
  TRB_FIELD_ROLLER,      /* (Z,)      */
  TRB_FIELD_ROLLER_VEC3, /* (Z, 3)    */
  TRB_FIELD_ROLLER_QUAT, /* (Z, 4)    */
  TRB_FIELD_POCKET_FACE, /* (Z, slots) */
  TRB_FIELD_MODE         /* (modes,)  */
} trb_field_kind;

/* Quantities of the rollers' contacts with the rings: F(X, pair, quantity, unit, text). Field <pair>_<quantity> is `quantity` of the contact
 * of that row of the table of pairs (contact/pair.h). */
#define TRB_CONTACT_FIELDS(F, X) \
  F(X, outer,     load,            "N",   "normal load, roller on outer raceway") \
  F(X, inner,     load,            "N",   "normal load, roller on inner raceway") \
  F(X, rib,       load,            "N",   "normal load, large end on back-face rib") \
  F(X, front_rib, load,            "N",   "normal load, small end on front rib") \
  F(X, outer,     pressure,        "Pa",  "largest Hertz pressure at the outer raceway") \
  F(X, inner,     pressure,        "Pa",  "largest Hertz pressure at the inner raceway") \
  F(X, rib,       pressure,        "Pa",  "largest Hertz pressure at the rib") \
  F(X, outer,     film,            "m",   "central film thickness at the outer raceway, mean weighted by load") \
  F(X, inner,     film,            "m",   "central film thickness at the inner raceway, mean weighted by load") \
  F(X, rib,       film,            "m",   "central film thickness at the rib") \
  F(X, outer,     film_parameter,  "1",   "film parameter Lambda at the outer raceway, mean weighted by load") \
  F(X, inner,     film_parameter,  "1",   "film parameter Lambda at the inner raceway, mean weighted by load") \
  F(X, rib,       film_parameter,  "1",   "film parameter Lambda at the rib") \
  F(X, outer,     slide_roll,      "1",   "slide-roll ratio along rolling at the outer raceway, weighted by load; positive: roller faster") \
  F(X, inner,     slide_roll,      "1",   "slide-roll ratio along rolling at the inner raceway, weighted by load; positive: roller faster") \
  F(X, rib,       slide_roll,      "1",   "slide-roll ratio at the rib") \
  F(X, outer,     traction,        "N",   "tangential force on the roller in the orbit's direction, outer raceway (friction and rolling)") \
  F(X, inner,     traction,        "N",   "tangential force on the roller in the orbit's direction, inner raceway (friction and rolling)") \
  F(X, rib,       friction,        "N",   "magnitude of the friction force at the rib") \
  F(X, rib,       height,          "m",   "height of the rib contact above the raceway") \
  F(X, rib,       overhang,        "1",   "share of the rib's contact ellipse (along the face) that lies beyond the rib's edges")

/* The same at the ribs that only cylindrical bearings have. */
#define TRB_OUTER_RIB_FIELDS(F, X) \
  F(X, outer_rib,       load,           "N",  "normal load, end towards +z on the rib of the outer ring") \
  F(X, outer_front_rib, load,           "N",  "normal load, end towards -z on the rib of the outer ring") \
  F(X, outer_rib,       pressure,       "Pa", "largest Hertz pressure at the rib of the outer ring, end towards +z") \
  F(X, outer_front_rib, pressure,       "Pa", "largest Hertz pressure at the rib of the outer ring, end towards -z") \
  F(X, outer_rib,       film_parameter, "1",  "film parameter Lambda at the rib of the outer ring, end towards +z") \
  F(X, outer_front_rib, film_parameter, "1",  "film parameter Lambda at the rib of the outer ring, end towards -z")

#define TRB_FIELD_OF_OUTER_RIB(X, pair, quantity, unit, text) X(pair##_##quantity, outer_ribs, ROLLER, unit, text)
#define TRB_FIELD_OF_CONTACT(X, pair, quantity, unit, text) X(pair##_##quantity, contacts, ROLLER, unit, text)

/* Of the cage on the land of a ring (contact/contact.h); zero without one. */
#define TRB_FIELD_OF_LAND(X, name, unit, text) X(land_##name, cage, SCALAR, unit, text)

/* Of the lists of bearing/losses.h. */
#define TRB_FIELD_OF_TORQUE(X, name, text) X(inner_torque_##name, torque, SCALAR, "N m", "share of " text " in the shaft's torque")
#define TRB_FIELD_OF_POWER(X, name, sense, is_on, text) X(power_##name, power, SCALAR, "W", "loss " text)
#define TRB_FIELD_OF_WORK(X, name, text) X(work_##name, energy, SCALAR, "J", text)
#define TRB_FIELD_OF_LOSS(X, name, sense, is_on, text) X(loss_##name, energy, SCALAR, "J", "energy lost " text)

#define TRB_FIELDS(X) \
  X(time,                        time,     SCALAR,      "s",     "time") \
  X(shaft_angle,                 time,     SCALAR,      "rad",   "turn of the inner ring since the start") \
  X(shaft_speed,                 time,     SCALAR,      "rad/s", "speed of the inner ring") \
  X(cage_position,               cage,     VEC3,        "m",     "cage centre in the roller-centre plane, from its centred place with large ends touching") \
  X(cage_rail_position,          cage,     VEC3,        "m",     "cage axis at the large-end rail, from its centred place") \
  X(cage_velocity,               cage,     VEC3,        "m/s",   "velocity of the cage's centre of mass") \
  X(cage_orientation,            cage,     QUATERNION,  "1",     "orientation of the cage (w, x, y, z), body to inertial") \
  X(cage_angular_velocity,       cage,     VEC3,        "rad/s", "angular velocity of the cage") \
  X(cage_angle,                  cage,     SCALAR,      "rad",   "turn of the cage about its axis since the start") \
  X(cage_tilt,                   cage,     VEC2,        "rad",   "tilt of the cage's axis: rotations theta_x, theta_y") \
  X(cage_force,                  cage,     VEC3,        "N",     "sum of the forces of pockets and land on the cage") \
  X(cage_moment,                 cage,     VEC3,        "N m",   "moment of these forces about the cage's centre of mass") \
  X(cage_mode,                   cage,     MODE,        "m",     "amplitude of each natural mode of the cage") \
  X(cage_mode_rate,              cage,     MODE,        "m/s",   "rate of the amplitude of each natural mode of the cage") \
  TRB_LAND_FIELDS(TRB_FIELD_OF_LAND, X) \
  X(roller_position,             rollers,  ROLLER_VEC3, "m",     "centre of mass of each roller, from the apex") \
  X(roller_orientation,          rollers,  ROLLER_QUAT, "1",     "orientation of each roller (w, x, y, z), body z axis along the roller") \
  X(roller_velocity,             rollers,  ROLLER_VEC3, "m/s",   "velocity of each roller's centre of mass") \
  X(roller_angular_velocity,     rollers,  ROLLER_VEC3, "rad/s", "angular velocity of each roller") \
  X(roller_orbit_angle,          rollers,  ROLLER,      "rad",   "angle of each roller's centre about the bearing axis, unwrapped") \
  X(roller_orbit_speed,          rollers,  ROLLER,      "rad/s", "rate of the orbit angle") \
  X(roller_spin_speed,           rollers,  ROLLER,      "rad/s", "speed of rotation about the roller's own axis, relative to the orbit") \
  X(roller_skew,                 rollers,  ROLLER,      "rad",   "skew: axis turned in the tangential direction") \
  X(roller_tilt,                 rollers,  ROLLER,      "rad",   "tilt: axis turned in the axial plane, against the nominal axis") \
  TRB_CONTACT_FIELDS(TRB_FIELD_OF_CONTACT, X) \
  TRB_OUTER_RIB_FIELDS(TRB_FIELD_OF_OUTER_RIB, X) \
  X(pocket_force,                pocket,   POCKET_FACE, "N",     "normal force between roller and each face of its pocket") \
  X(pocket_friction,             pocket,   POCKET_FACE, "N",     "magnitude of the friction force at each face") \
  X(ring_position,               ring,     VEC3,        "m",     "displacement of the inner ring") \
  X(ring_tilt,                   ring,     VEC2,        "rad",   "small rotations of the inner ring's axis about x and y") \
  X(ring_velocity,               ring,     VEC3,        "m/s",   "velocity of the inner ring") \
  X(ring_angular_velocity,       ring,     VEC3,        "rad/s", "angular velocity of the inner ring") \
  X(ring_force,                  ring,     VEC3,        "N",     "force of rollers and cage on the inner ring") \
  X(ring_moment,                 ring,     VEC3,        "N m",   "moment of rollers and cage on the inner ring, about the roller-centre plane") \
  X(housing_position,            housing,  VEC3,        "m",     "displacement of the outer ring with its housing, in the roller-centre plane") \
  X(housing_tilt,                housing,  VEC2,        "rad",   "small rotations of the outer ring's axis about x and y") \
  X(housing_velocity,            housing,  VEC3,        "m/s",   "velocity of the outer ring in the roller-centre plane") \
  X(housing_angular_velocity,    housing,  VEC3,        "rad/s", "angular velocity of the outer ring") \
  X(housing_force,               housing,  VEC3,        "N",     "force of rollers and cage on the outer ring") \
  X(housing_moment,              housing,  VEC3,        "N m",   "moment of rollers and cage on the outer ring, about the roller-centre plane") \
  X(inner_torque,                torque,   SCALAR,      "N m",   "friction torque that the shaft overcomes") \
  X(outer_torque,                torque,   SCALAR,      "N m",   "friction torque on the outer ring, in the direction of the shaft's speed") \
  TRB_TORQUES(TRB_FIELD_OF_TORQUE, X) \
  X(power_loss,                  power,    SCALAR,      "W",     "sum of all losses") \
  TRB_LOSSES(TRB_FIELD_OF_POWER, X) \
  X(kinetic_energy,              energy,   SCALAR,      "J",     "kinetic energy of rollers, cage and free rings") \
  X(elastic_energy,              energy,   SCALAR,      "J",     "elastic energy of all contacts, and of a cage that deforms") \
  TRB_WORKS(TRB_FIELD_OF_WORK, X) \
  TRB_LOSSES(TRB_FIELD_OF_LOSS, X)

#endif
