/* The table of all recorded quantities. It defines the layout of a record; the HDF5 file, the plots and the documentation take names,
 * units, shapes and texts from here.
 *
 * TRB_FIELDS(X): X(name, group, kind, unit, text). A kind is a shape; roller = one number for each roller. */
#ifndef TRB_MOTION_FIELDS_H
#define TRB_MOTION_FIELDS_H

typedef enum trb_field_kind {
  TRB_FIELD_SCALAR,      /* ()        */
  TRB_FIELD_VEC2,        /* (2,)      */
  TRB_FIELD_VEC3,        /* (3,)      */
  TRB_FIELD_QUATERNION,  /* (4,)      w, x, y, z */
  TRB_FIELD_ROLLER,      /* (Z,)      */
  TRB_FIELD_ROLLER_VEC3, /* (Z, 3)    */
  TRB_FIELD_ROLLER_QUAT, /* (Z, 4)    */
  TRB_FIELD_POCKET_FACE  /* (Z, slots) */
} trb_field_kind;

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
  X(cage_force,                  cage,     VEC3,        "N",     "sum of pocket forces on the cage") \
  X(cage_moment,                 cage,     VEC3,        "N m",   "moment of pocket forces about the cage's centre of mass") \
  X(roller_position,             rollers,  ROLLER_VEC3, "m",     "centre of mass of each roller, from the apex") \
  X(roller_orientation,          rollers,  ROLLER_QUAT, "1",     "orientation of each roller (w, x, y, z), body z axis along the roller") \
  X(roller_velocity,             rollers,  ROLLER_VEC3, "m/s",   "velocity of each roller's centre of mass") \
  X(roller_angular_velocity,     rollers,  ROLLER_VEC3, "rad/s", "angular velocity of each roller") \
  X(roller_orbit_angle,          rollers,  ROLLER,      "rad",   "angle of each roller's centre about the bearing axis, unwrapped") \
  X(roller_orbit_speed,          rollers,  ROLLER,      "rad/s", "rate of the orbit angle") \
  X(roller_spin_speed,           rollers,  ROLLER,      "rad/s", "speed of rotation about the roller's own axis, relative to the orbit") \
  X(roller_skew,                 rollers,  ROLLER,      "rad",   "skew: axis turned in the tangential direction") \
  X(roller_tilt,                 rollers,  ROLLER,      "rad",   "tilt: axis turned in the axial plane, against the nominal axis") \
  X(outer_load,                  contacts, ROLLER,      "N",     "normal load, roller on outer raceway") \
  X(inner_load,                  contacts, ROLLER,      "N",     "normal load, roller on inner raceway") \
  X(rib_load,                    contacts, ROLLER,      "N",     "normal load, large end on back-face rib") \
  X(front_rib_load,              contacts, ROLLER,      "N",     "normal load, small end on front rib") \
  X(outer_pressure,              contacts, ROLLER,      "Pa",    "largest Hertz pressure at the outer raceway") \
  X(inner_pressure,              contacts, ROLLER,      "Pa",    "largest Hertz pressure at the inner raceway") \
  X(rib_pressure,                contacts, ROLLER,      "Pa",    "largest Hertz pressure at the rib") \
  X(outer_film,                  contacts, ROLLER,      "m",     "central film thickness at the outer raceway, mean weighted by load") \
  X(inner_film,                  contacts, ROLLER,      "m",     "central film thickness at the inner raceway, mean weighted by load") \
  X(rib_film,                    contacts, ROLLER,      "m",     "central film thickness at the rib") \
  X(outer_film_parameter,        contacts, ROLLER,      "1",     "film parameter Lambda at the outer raceway, mean weighted by load") \
  X(inner_film_parameter,        contacts, ROLLER,      "1",     "film parameter Lambda at the inner raceway, mean weighted by load") \
  X(rib_film_parameter,          contacts, ROLLER,      "1",     "film parameter Lambda at the rib") \
  X(outer_slide_roll,            contacts, ROLLER,      "1",     "slide-roll ratio along rolling at the outer raceway, weighted by load; positive: roller faster") \
  X(inner_slide_roll,            contacts, ROLLER,      "1",     "slide-roll ratio along rolling at the inner raceway, weighted by load; positive: roller faster") \
  X(rib_slide_roll,              contacts, ROLLER,      "1",     "slide-roll ratio at the rib") \
  X(outer_traction,              contacts, ROLLER,      "N",     "tangential force on the roller in the orbit's direction, outer raceway (friction and rolling)") \
  X(inner_traction,              contacts, ROLLER,      "N",     "tangential force on the roller in the orbit's direction, inner raceway (friction and rolling)") \
  X(rib_friction,                contacts, ROLLER,      "N",     "magnitude of the friction force at the rib") \
  X(rib_height,                  contacts, ROLLER,      "m",     "height of the rib contact above the raceway") \
  X(rib_overhang,                contacts, ROLLER,      "1",     "share of the rib's contact ellipse (along the face) that lies beyond the rib's edges") \
  X(pocket_force,                pocket,   POCKET_FACE, "N",     "normal force between roller and each face of its pocket") \
  X(pocket_friction,             pocket,   POCKET_FACE, "N",     "magnitude of the friction force at each face") \
  X(ring_position,               ring,     VEC3,        "m",     "displacement of the inner ring") \
  X(ring_force,                  ring,     VEC3,        "N",     "force of the rollers on the inner ring") \
  X(ring_moment,                 ring,     VEC3,        "N m",   "moment of the rollers on the inner ring, about the roller-centre plane") \
  X(inner_torque,                torque,   SCALAR,      "N m",   "friction torque that the shaft overcomes") \
  X(outer_torque,                torque,   SCALAR,      "N m",   "friction torque on the outer ring, in the direction of the shaft's speed") \
  X(inner_torque_traction,       torque,   SCALAR,      "N m",   "share of raceway sliding friction in the shaft's torque") \
  X(inner_torque_rolling,        torque,   SCALAR,      "N m",   "share of rolling resistance in the shaft's torque") \
  X(inner_torque_rib,            torque,   SCALAR,      "N m",   "share of the back-face rib in the shaft's torque") \
  X(inner_torque_front_rib,      torque,   SCALAR,      "N m",   "share of the front rib in the shaft's torque") \
  X(power_loss,                  power,    SCALAR,      "W",     "sum of all losses") \
  X(power_traction_outer,        power,    SCALAR,      "W",     "loss by sliding at the outer raceway") \
  X(power_traction_inner,        power,    SCALAR,      "W",     "loss by sliding at the inner raceway") \
  X(power_rolling,               power,    SCALAR,      "W",     "loss by rolling resistance") \
  X(power_rolling_pressure,      power,    SCALAR,      "W",     "power drawn by the rolling film's pressure force") \
  X(power_rib,                   power,    SCALAR,      "W",     "loss at the back-face rib") \
  X(power_front_rib,             power,    SCALAR,      "W",     "loss at the front rib") \
  X(power_pocket,                power,    SCALAR,      "W",     "loss by friction in the pockets") \
  X(power_damping,               power,    SCALAR,      "W",     "loss by normal damping") \
  X(kinetic_energy,              energy,   SCALAR,      "J",     "kinetic energy of rollers and cage") \
  X(elastic_energy,              energy,   SCALAR,      "J",     "elastic energy of all contacts") \
  X(work_shaft,                  energy,   SCALAR,      "J",     "work put in by the shaft's torque") \
  X(work_ring,                   energy,   SCALAR,      "J",     "work put in by motion of the inner ring's position") \
  X(work_gravity,                energy,   SCALAR,      "J",     "work of gravity (minus the change of potential energy)") \
  X(loss_traction_outer,         energy,   SCALAR,      "J",     "energy lost by sliding at the outer raceway") \
  X(loss_traction_inner,         energy,   SCALAR,      "J",     "energy lost by sliding at the inner raceway") \
  X(loss_rolling,                energy,   SCALAR,      "J",     "energy lost by rolling resistance") \
  X(loss_rolling_pressure,       energy,   SCALAR,      "J",     "energy drawn by the rolling film's pressure force") \
  X(loss_rib,                    energy,   SCALAR,      "J",     "energy lost at the back-face rib") \
  X(loss_front_rib,              energy,   SCALAR,      "J",     "energy lost at the front rib") \
  X(loss_pocket,                 energy,   SCALAR,      "J",     "energy lost by friction in the pockets") \
  X(loss_damping,                energy,   SCALAR,      "J",     "energy lost by normal damping")

#endif
