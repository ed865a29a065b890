/* The table of all recorded quantities. It defines the layout of a record; the HDF5 file, the plots and the documentation take names,
 * units, shapes and texts from here. Each kind of thing has a list of its quantities, which motion/shown.c fills; a row of TRB_SHOWN says
 * what there is of it.
 *
 * TRB_FIELDS(X): X(name, group, kind, unit, text). A kind is a shape; roller = one number for each roller. */
#ifndef TRB_MOTION_FIELDS_H
#define TRB_MOTION_FIELDS_H

#include "bearing/losses.h"
#include "contact/contact.h"
#include "system/tapered.h"

/* Kinds: X(KIND, name, how many extents, first, second); extents that are not numbers are those of the model. */
#define TRB_FIELD_KINDS(X) \
  X(SCALAR,      "scalar",      0, 1,            1) \
  X(VEC2,        "vec2",        1, 2,            1) \
  X(VEC3,        "vec3",        1, 3,            1) \
  X(QUATERNION,  "quaternion",  1, 4,            1) /* w, x, y, z */ \
  X(ROLLER,      "roller",      1, m->n_rollers, 1) \
  X(ROLLER_VEC3, "roller_vec3", 2, m->n_rollers, 3) \
  X(ROLLER_QUAT, "roller_quat", 2, m->n_rollers, 4) \
  X(POCKET_FACE, "pocket_face", 2, m->n_rollers, m->n_slots) \
  X(MODE,        "mode",        1, m->modes.n,   1)

typedef enum trb_field_kind {
#define TRB_FIELD_KIND(kind, name, n, first, second) TRB_FIELD_##kind,
  TRB_FIELD_KINDS(TRB_FIELD_KIND)
#undef TRB_FIELD_KIND
} trb_field_kind;

/* What there is of each kind has these quantities: TRB_FIELDS_OF_<kind>(F, X, as, group, at): F(X, as, group, quantity, kind, unit, text).
 *
 * Of a contact of the rollers with a ring, each is a member of trb_contact; an edge has its load alone (TRB_CONTACT_EDGE). */
#define TRB_FIELDS_OF_raceway(F, X, as, group, at) \
  F(X, as, group, load,           ROLLER, "N",  "normal load at " at) \
  F(X, as, group, pressure,       ROLLER, "Pa", "largest Hertz pressure at " at) \
  F(X, as, group, film,           ROLLER, "m",  "central film thickness at " at ", mean weighted by load") \
  F(X, as, group, film_parameter, ROLLER, "1",  "film parameter Lambda at " at ", mean weighted by load") \
  F(X, as, group, slide_roll,     ROLLER, "1",  "slide-roll ratio along rolling at " at ", weighted by load; positive: roller faster") \
  F(X, as, group, traction,       ROLLER, "N",  "tangential force on the roller in the orbit's direction at " at " (friction and rolling)")
#define TRB_FIELDS_OF_rib(F, X, as, group, at) \
  F(X, as, group, load,           ROLLER, "N",  "normal load at " at) \
  F(X, as, group, pressure,       ROLLER, "Pa", "largest Hertz pressure at " at) \
  F(X, as, group, film,           ROLLER, "m",  "central film thickness at " at) \
  F(X, as, group, film_parameter, ROLLER, "1",  "film parameter Lambda at " at) \
  F(X, as, group, slide_roll,     ROLLER, "1",  "slide-roll ratio at " at) \
  F(X, as, group, friction,       ROLLER, "N",  "magnitude of the friction force at " at) \
  F(X, as, group, height,         ROLLER, "m",  "height above the raceway of the contact at " at) \
  F(X, as, group, overhang,       ROLLER, "1",  "share of the contact ellipse (along the face) beyond the edges at " at)
/* Of a ring; forces are those of rollers and cage. */
#define TRB_FIELDS_OF_ring(F, X, as, group, at) \
  F(X, as, group, position,         VEC3, "m",     "displacement of " at " in the roller-centre plane") \
  F(X, as, group, tilt,             VEC2, "rad",   "small rotations of the axis of " at " about x and y") \
  F(X, as, group, velocity,         VEC3, "m/s",   "velocity of " at " in the roller-centre plane") \
  F(X, as, group, angular_velocity, VEC3, "rad/s", "angular velocity of " at) \
  F(X, as, group, force,            VEC3, "N",     "force of rollers and cage on " at) \
  F(X, as, group, moment,           VEC3, "N m",   "moment of rollers and cage on " at ", about the roller-centre plane")
/* Of a cage; modes are there where it deforms. */
#define TRB_FIELDS_OF_cage(F, X, as, group, at) \
  F(X, as, group, position,         VEC3,       "m",     at " centre in the roller-centre plane, from its centred place with large ends touching") \
  F(X, as, group, rail_position,    VEC3,       "m",     at " axis at the large-end rail, from its centred place") \
  F(X, as, group, velocity,         VEC3,       "m/s",   "velocity of the " at "'s centre of mass") \
  F(X, as, group, orientation,      QUATERNION, "1",     "orientation of the " at " (w, x, y, z), body to inertial") \
  F(X, as, group, angular_velocity, VEC3,       "rad/s", "angular velocity of the " at) \
  F(X, as, group, angle,            SCALAR,     "rad",   "turn of the " at " about its axis since the start") \
  F(X, as, group, tilt,             VEC2,       "rad",   "tilt of the " at "'s axis: rotations theta_x, theta_y") \
  F(X, as, group, force,            VEC3,       "N",     "sum of the forces of pockets and land on the " at) \
  F(X, as, group, moment,           VEC3,       "N m",   "moment of these forces about the " at "'s centre of mass") \
  F(X, as, group, mode,             MODE,       "m",     "amplitude of each natural mode of the " at) \
  F(X, as, group, mode_rate,        MODE,       "m/s",   "rate of the amplitude of each natural mode of the " at)
/* Of the cage on the land of a ring (contact/contact.h); zero without one. */
#define TRB_FIELD_OF_LAND(X, name, unit, text) X(land_##name, cage, SCALAR, unit, text)
#define TRB_FIELDS_OF_land(F, X, as, group, at) TRB_LAND_FIELDS(TRB_FIELD_OF_LAND, X)
#define TRB_FIELDS_OF_roller(F, X, as, group, at) \
  F(X, as, group, position,         ROLLER_VEC3, "m",     "centre of mass of each roller, from the apex") \
  F(X, as, group, orientation,      ROLLER_QUAT, "1",     "orientation of each roller (w, x, y, z), body z axis along the roller") \
  F(X, as, group, velocity,         ROLLER_VEC3, "m/s",   "velocity of each roller's centre of mass") \
  F(X, as, group, angular_velocity, ROLLER_VEC3, "rad/s", "angular velocity of each roller") \
  F(X, as, group, orbit_angle,      ROLLER,      "rad",   "angle of each roller's centre about the bearing axis, unwrapped") \
  F(X, as, group, orbit_speed,      ROLLER,      "rad/s", "rate of the orbit angle") \
  F(X, as, group, spin_speed,       ROLLER,      "rad/s", "speed of rotation about the roller's own axis, relative to the orbit") \
  F(X, as, group, skew,             ROLLER,      "rad",   "skew: axis turned in the tangential direction") \
  F(X, as, group, tilt,             ROLLER,      "rad",   "tilt: axis turned in the axial plane, against the nominal axis")
#define TRB_FIELDS_OF_pocket(F, X, as, group, at) \
  F(X, as, group, force,    POCKET_FACE, "N", "normal force between roller and each face of its pocket") \
  F(X, as, group, friction, POCKET_FACE, "N", "magnitude of the friction force at each face")

/* Of the system as a whole; lists of losses are in bearing/losses.h. */
#define TRB_FIELD_OF_TORQUE(X, name, text) X(inner_torque_##name, torque, SCALAR, "N m", "share of " text " in the shaft's torque")
#define TRB_FIELD_OF_POWER(X, name, sense, is_on, text) X(power_##name, power, SCALAR, "W", "loss " text)
#define TRB_FIELD_OF_WORK(X, name, text) X(work_##name, energy, SCALAR, "J", text)
#define TRB_FIELD_OF_LOSS(X, name, sense, is_on, text) X(loss_##name, energy, SCALAR, "J", "energy lost " text)
#define TRB_FIELDS_OF_time(F, X, as, group, at) \
  X(time,        group, SCALAR, "s",     "time") \
  X(shaft_angle, group, SCALAR, "rad",   "turn of the inner ring since the start") \
  X(shaft_speed, group, SCALAR, "rad/s", "speed of the inner ring")
#define TRB_FIELDS_OF_friction(F, X, as, group, at) X(as, group, SCALAR, "N m", at)
#define TRB_FIELDS_OF_share(F, X, as, group, at) TRB_TORQUES(TRB_FIELD_OF_TORQUE, X)
#define TRB_FIELDS_OF_power(F, X, as, group, at) \
  X(power_loss, group, SCALAR, "W", "sum of all losses") \
  TRB_LOSSES(TRB_FIELD_OF_POWER, X)
#define TRB_FIELDS_OF_energy(F, X, as, group, at) \
  X(kinetic_energy, group, SCALAR, "J", "kinetic energy of rollers, cage and free rings") \
  X(elastic_energy, group, SCALAR, "J", "elastic energy of all contacts, and of a cage that deforms") \
  TRB_WORKS(TRB_FIELD_OF_WORK, X) \
  TRB_LOSSES(TRB_FIELD_OF_LOSS, X)

/* What there is. S(X, kind, as, group, of, at) is a row that shown.c fills, C one of a contact of the rollers with a ring. Fields are named
 * <as>_<quantity>; of: number of its body or pair; at: what texts call it. A system has the fields of the pairs that it has; the bodies
 * are those of each bearing. Contacts have peaks, too (motion/peak_fields.h). */
#define TRB_SHOWN_CONTACTS(C, X) \
  C(X, raceway, outer,           contacts,   TRB_PAIR_outer,           "the outer raceway") \
  C(X, raceway, inner,           contacts,   TRB_PAIR_inner,           "the inner raceway") \
  C(X, rib,     rib,             contacts,   TRB_PAIR_rib,             "the back-face rib") \
  C(X, rib,     front_rib,       contacts,   TRB_PAIR_front_rib,       "the front rib") \
  C(X, rib,     outer_rib,       outer_ribs, TRB_PAIR_outer_rib,       "the outer ring's rib towards +z") \
  C(X, rib,     outer_front_rib, outer_ribs, TRB_PAIR_outer_front_rib, "the outer ring's rib towards -z")
#define TRB_SHOWN(S, C, X) \
  S(X, time,     time,         time,    0,                   "") \
  S(X, cage,     cage,         cage,    TRB_BODY_CAGE,       "cage") \
  S(X, land,     land,         cage,    0,                   "") \
  S(X, roller,   roller,       rollers, 0,                   "") \
  TRB_SHOWN_CONTACTS(C, X) \
  S(X, pocket,   pocket,       pocket,  TRB_PAIR_pocket,     "") \
  S(X, ring,     ring,         ring,    TRB_BODY_INNER_RING, "the inner ring") \
  S(X, ring,     housing,      housing, TRB_BODY_OUTER_RING, "the outer ring") \
  S(X, friction, inner_torque, torque,  TRB_BODY_INNER_RING, "friction torque that the shaft overcomes") \
  S(X, friction, outer_torque, torque,  TRB_BODY_OUTER_RING, "friction torque on the outer ring, in the direction of the shaft's speed") \
  S(X, share,    share,        torque,  0,                   "") \
  S(X, power,    power,        power,   0,                   "") \
  S(X, energy,   energy,       energy,  0,                   "")

#define TRB_FIELD_OF(X, as, group, quantity, kind, unit, text) X(as##_##quantity, group, kind, unit, text)
#define TRB_FIELDS_SHOWN(X, kind, as, group, of, at) TRB_FIELDS_OF_##kind(TRB_FIELD_OF, X, as, group, at)
#define TRB_FIELDS(X) TRB_SHOWN(TRB_FIELDS_SHOWN, TRB_FIELDS_SHOWN, X)

#endif
