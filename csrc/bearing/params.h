/* The table of all inputs of a model. It makes the C structs, one for each part, the flat block that Python fills by name,
 * the range check and the documentation. Every entry is a double, so that the structs together are one contiguous array.
 *
 * X(part, field, name, unit, lower, upper, text); part: of the bearing or the scene, whose numbers they are; field: of the part's struct; name:
 * by which Python, cases and errors know it; lower and upper are inclusive bounds of the check. Units "count" and "choice" stand for whole
 * numbers. */
#ifndef TRB_BEARING_PARAMS_H
#define TRB_BEARING_PARAMS_H

#include <stddef.h>

#include "surface/polygon.h"

/* The bearing as a whole, and its rings' material. */
#define TRB_BEARING_INPUTS(X) \
  X(bearing,    n_rollers,               n_rollers,                 "count",     3,      200,    "number of rollers Z") \
  X(bearing,    cup_half_angle,          cup_half_angle,            "rad",       0,      0.8,    "half angle of the cup (outer) raceway cone; 0: rollers and raceways are cylinders") \
  X(bearing,    pitch_diameter,          pitch_diameter,            "m",         1e-3,   10.0,   "Dpw: pitch diameter at roller mid length") \
  X(bearing,    youngs_modulus,          youngs_modulus,            "Pa",        1e8,    1e13,   "Young's modulus of the rings") \
  X(bearing,    poisson_ratio,           poisson_ratio,             "1",         0,      0.4999, "Poisson's ratio of the rings") \
  X(bearing,    radial_clearance,        radial_clearance,          "m",         -0.01,  0.01,   "radial internal clearance of a cylindrical bearing: way of one ring across the other; negative: preload")

/* Rollers: size, material, profile. */
#define TRB_ROLLER_INPUTS(X) \
  X(roller,     diameter,                roller_diameter,           "m",         1e-4,   1.0,    "Dwe: roller diameter at mid length, perpendicular to its axis") \
  X(roller,     effective_length,        effective_length,          "m",         1e-4,   1.0,    "Lwe: effective length of the roller's contact line") \
  X(roller,     total_length,            total_length,              "m",         1e-4,   1.0,    "length of the roller over its ends, centred on the effective length") \
  X(roller,     density,                 roller_density,            "kg/m3",     100,    30000,  "density of the rollers") \
  X(roller,     youngs_modulus,          roller_youngs_modulus,     "Pa",        1e8,    1e13,   "Young's modulus of the rollers") \
  X(roller,     poisson_ratio,           roller_poisson_ratio,      "1",         0,      0.4999, "Poisson's ratio of the rollers") \
  X(roller,     sphere_ratio,            sphere_ratio,              "1",         0.05,   0.999,  "large-end sphere radius over the apex distance of the roller's large end") \
  X(roller,     end_radius,              end_radius,                "m",         0,      1e3,    "radius of the sphere of the large end, of a cylinder of both ends; 0: it follows from sphere_ratio") \
  X(roller,     end_stiffness,           end_stiffness,             "N/m^1.5",   1,      1e14,   "stiffness of roller end against a flat of the ring: force = k d^1.5; of the cage: times E' ratio") \
  X(roller,     profile,                 profile,                   "choice",    0,      3,      "roller profile: 0 straight, 1 crowned (arc), 2 logarithmic, 3 general form of ISO/TS 16281") \
  X(roller,     crown_radius,            crown_radius,              "m",         1e-3,   1e9,    "radius of the crowning arc") \
  X(roller,     profile_k1,              profile_k1,                "1",         0,      100,    "K1 of the logarithmic profile") \
  X(roller,     profile_k2,              profile_k2,                "1",         0.001,  1,      "K2 of the logarithmic profile") \
  X(roller,     profile_zm,              profile_zm,                "m",         0,      1e-3,   "zm of the logarithmic profile: drop at the end") \
  X(roller,     profile_load,            profile_load,              "N",         1e-3,   1e9,    "design load Q of the logarithmic profile") \
  X(roller,     profile_a,               profile_a,                 "1",         0,      0.1,    "a_p of the ISO profile: its drop over the roller's diameter") \
  X(roller,     profile_c,               profile_c,                 "m",         1e-6,   10,     "c_p of the ISO profile: length over which it drops, both ends together") \
  X(roller,     profile_d,               profile_d,                 "m",         0,      10,     "d_p of the ISO profile: length of its straight middle") \
  X(roller,     profile_k,               profile_k,                 "1",         1,      20,     "k_p of the ISO profile: its exponent")

/* Ribs of the rings. */
#define TRB_RIB_INPUTS(X) \
  X(rib,        clearance,               rib_clearance,             "m",         0,      0.1,    "nominal gap between a cylindrical roller's end and each rib") \
  X(rib,        outer,                   outer_rib,                 "choice",    0,      1,      "cylindrical rollers: large ends (towards +z) against a rib of the outer ring") \
  X(rib,        outer_front,             outer_front_rib,           "choice",    0,      1,      "cylindrical rollers: small ends (towards -z) against a rib of the outer ring") \
  X(rib,        contact_height,          rib_contact_height,        "m",         0,      0.1,    "height of the nominal rib contact above the inner raceway, perpendicular to it") \
  X(rib,        edge_low,                rib_edge_low,              "m",         0,      0.1,    "height of the back-face rib's lower edge above the raceway") \
  X(rib,        edge_high,               rib_edge_high,             "m",         0,      0.1,    "height of the back-face rib's upper edge above the raceway") \
  X(rib,        front_clearance,         front_rib_clearance,       "m",         0,      0.1,    "nominal gap between the roller's small end and the front rib") \
  X(rib,        front_low,               front_rib_low,             "m",         0,      0.1,    "height of the front rib's lower edge above the raceway") \
  X(rib,        front_high,              front_rib_high,            "m",         0,      0.1,    "height of the front rib's upper edge above the raceway")

/* A cage. */
#define TRB_CAGE_INPUTS(X) \
  X(cage,       youngs_modulus,          cage_youngs_modulus,       "Pa",        1e8,    1e13,   "Young's modulus of the cage's faces") \
  X(cage,       poisson_ratio,           cage_poisson_ratio,        "1",         0,      0.4999, "Poisson's ratio of the cage's faces") \
  X(cage,       mass,                    cage_mass,                 "kg",        1e-9,   1e4,    "mass of the cage") \
  X(cage,       inertia_axial,           cage_inertia_axial,        "kg m2",     1e-12,  1e6,    "moment of inertia about the cage's axis") \
  X(cage,       inertia_transverse,      cage_inertia_transverse,   "kg m2",     1e-12,  1e6,    "moment of inertia about a transverse axis through the cage's centre of mass") \
  X(cage,       offset,                  cage_offset,               "m",         -1,     1,      "axial position of the cage's centre of mass from the roller-centre plane") \
  X(cage,       rail_offset,             cage_rail_offset,          "m",         -1,     1,      "axial position of the large-end rail (where the sensors look) from the roller-centre plane") \
  X(cage,       face_inner,              cage_face_inner,           "m",         0,      10.0,   "inner radius of the cage's end faces") \
  X(cage,       face_outer,              cage_face_outer,           "m",         0,      10.0,   "outer radius of the cage's end faces") \
  X(cage,       n_modes,                 cage_modes,                "count",     0,      100,    "number of natural modes by which the cage deforms; 0: it is rigid")

/* A row of pockets of a cage. */
#define TRB_POCKET_INPUTS(X) \
  X(pocket,     roughness,               roughness_pocket,          "m",         1e-10,  1e-3,   "composite rms roughness of roller and pocket: the film between them is no thinner") \
  X(pocket,     film,                    pocket_film,               "m",         0,      1e-2,   "gap between roller and bar in which the oil makes a film; 0: no film") \
  X(pocket,     damping,                 damping_cage,              "s/m",       0,      1e4,    "Hunt-Crossley damping of pocket contacts") \
  X(pocket,     bars,                    pocket_bars,               "choice",    0,      1,      "flank against the pocket's faces") \
  X(pocket,     ends,                    pocket_ends,               "choice",    0,      1,      "roller ends against the pocket's faces") \
  X(pocket,     edges,                   pocket_edges,              "choice",    0,      1,      "faces end at their outline (0: faces are unbounded planes)")

/* The land of a ring that guides a cage, with the surface of the cage that runs on it. */
#define TRB_LAND_INPUTS(X) \
  X(land,       offset,                  land_offset,               "m",         -1,     1,      "axial position of the middle of the cage's guiding surface from the roller-centre plane") \
  X(land,       inner_radius,            land_inner_radius,         "m",         1e-4,   10.0,   "radius of the inner ring's land") \
  X(land,       outer_radius,            land_outer_radius,         "m",         1e-4,   10.0,   "radius of the outer ring's land") \
  X(land,       width,                   land_width,                "m",         1e-5,   1.0,    "width of the cage's guiding surface") \
  X(land,       clearance,               land_clearance,            "m",         1e-7,   0.1,    "radial clearance between cage and land") \
  X(land,       contact_film,            land_contact_film,         "m",         1e-9,   1e-2,   "film height below which cage and land touch") \
  X(land,       fill,                    land_fill,                 "1",         0,      1,      "share of the guiding surface's width that is filled with oil")

/* The outer ring with its housing, where both are free to move. */
#define TRB_OUTER_RING_INPUTS(X) \
  X(outer_ring, free,                    outer_free,                "choice",    0,      1,      "1: the outer ring moves with its housing") \
  X(outer_ring, mass,                    outer_mass,                "kg",        0,      1e5,    "mass of the outer ring and its housing") \
  X(outer_ring, inertia_axial,           outer_inertia_axial,       "kg m2",     0,      1e6,    "their moment of inertia about the axis") \
  X(outer_ring, inertia_transverse,      outer_inertia_transverse,  "kg m2",     0,      1e6,    "their moment of inertia about a transverse axis through the centre of mass") \
  X(outer_ring, offset,                  outer_offset,              "m",         -10,    10,     "axial position of their centre of mass from the roller-centre plane") \
  X(outer_ring, damping,                 outer_damping,             "N s/m",     0,      1e9,    "damping between them and the surroundings, of translations") \
  X(outer_ring, damping_turns,           outer_damping_turns,       "N m s",     0,      1e9,    "damping between them and the surroundings, of turns about transverse axes") \
  X(outer_ring, support_radial,          outer_support_radial,      "N/m",       0,      1e13,   "stiffness of their support, across the axis") \
  X(outer_ring, support_axial,           outer_support_axial,       "N/m",       0,      1e13,   "stiffness of the support along the axis") \
  X(outer_ring, support_tilt,            outer_support_tilt,        "N m",       0,      1e12,   "stiffness of the support against tilt, per radian") \
  X(outer_ring, support_position,        outer_support_position,    "m",         -100,   100,    "axial position of the support from the roller-centre plane") \
  X(outer_ring, turns,                   outer_turns,               "choice",    0,      1,      "1: the outer ring turns at a prescribed speed") \
  X(outer_ring, carried,                 outer_carried,             "choice",    0,      1,      "1: the outer ring is part of the body of the first bearing's outer ring: one housing is around both") \
  X(outer_ring, turned,                  outer_turned,              "choice",    0,      1,      "1: the bearing sits in that housing the other way round: its axes are the housing's, turned by half a turn about x")

/* The inner ring, where it is free to move. */
#define TRB_INNER_RING_INPUTS(X) \
  X(inner_ring, free,                    ring_free,                 "choice",    0,      2,      "inner ring: 0 as prescribed, 1 free at a prescribed speed, 2 free, turned by a torque") \
  X(inner_ring, mass,                    ring_mass,                 "kg",        0,      1e5,    "mass of the inner ring and what turns with it") \
  X(inner_ring, inertia_axial,           ring_inertia_axial,        "kg m2",     0,      1e6,    "its moment of inertia about the axis") \
  X(inner_ring, inertia_transverse,      ring_inertia_transverse,   "kg m2",     0,      1e6,    "its moment of inertia about a transverse axis through the centre of mass") \
  X(inner_ring, offset,                  ring_offset,               "m",         -10,    10,     "axial position of its centre of mass from the roller-centre plane") \
  X(inner_ring, unbalance,               ring_unbalance,            "kg m",      0,      1e3,    "its unbalance: mass times radius") \
  X(inner_ring, unbalance_angle,         ring_unbalance_angle,      "rad",       -7,     7,      "angle of the unbalance from the x axis at shaft angle 0") \
  X(inner_ring, damping,                 ring_damping,              "N s/m",     0,      1e9,    "damping between it and the surroundings, of translations") \
  X(inner_ring, damping_turns,           ring_damping_turns,        "N m s",     0,      1e9,    "damping between it and the surroundings, of turns about transverse axes") \
  X(inner_ring, support_radial,          ring_support_radial,       "N/m",       0,      1e13,   "stiffness of a support of it, across the axis; a support carries nothing at the start") \
  X(inner_ring, support_axial,           ring_support_axial,        "N/m",       0,      1e13,   "stiffness of the support along the axis") \
  X(inner_ring, support_tilt,            ring_support_tilt,         "N m",       0,      1e12,   "stiffness of the support against tilt, per radian") \
  X(inner_ring, support_position,        ring_support_position,     "m",         -100,   100,    "axial position of the support from the roller-centre plane") \
  X(inner_ring, carried,                 ring_carried,              "choice",    0,      1,      "1: the ring is part of the body of the first bearing's ring: both sit on one shaft") \
  X(inner_ring, shift,                   ring_shift,                "m",         -1,     1,      "its axial displacement where the shaft of which it is part stands at zero: preload or end play") \
  X(inner_ring, turned,                  ring_turned,               "choice",    0,      1,      "1: the bearing sits on the shaft the other way round: its axes are the shaft's, turned by half a turn about x")

/* The lubricant. */
#define TRB_OIL_INPUTS(X) \
  X(oil,        viscosity,               viscosity,                 "Pa s",      1e-9,   1e6,    "eta0: dynamic viscosity at ambient pressure") \
  X(oil,        pressure_coefficient,    pressure_coefficient,      "1/Pa",      0,      1e-6,   "alpha0: pressure-viscosity coefficient, used by the films") \
  X(oil,        temperature_coefficient, temperature_coefficient,   "1/K",       0,      1,      "beta: -d ln(eta0)/dt") \
  X(oil,        conductivity,            conductivity,              "W/mK",      1e-4,   1e3,    "k': thermal conductivity of the oil") \
  X(oil,        temperature,             temperature,               "C",         -80,    400,    "oil temperature") \
  X(oil,        viscosity_law,           viscosity_law,             "choice",    0,      2,      "pressure law of viscosity: 0 Dicke, 1 Roelands, 2 Barus (capped)") \
  X(oil,        dicke_a,                 dicke_a,                   "bar",       1e-3,   1e6,    "Dicke: constant term") \
  X(oil,        dicke_b,                 dicke_b,                   "bar/C",     -1e4,   1e4,    "Dicke: factor of temperature") \
  X(oil,        dicke_c,                 dicke_c,                   "1",         0,      1e3,    "Dicke: factor of pressure") \
  X(oil,        dicke_d,                 dicke_d,                   "1/C",       -1,     1,      "Dicke: factor of pressure times temperature") \
  X(oil,        viscosity_exponent_cap,  viscosity_exponent_cap,    "1",         1,      60,     "largest exponent ln(eta/eta0) of the Roelands and Barus laws") \
  X(oil,        eyring_stress,           eyring_stress,             "Pa",        1e3,    1e9,    "tau0: characteristic shear stress") \
  X(oil,        shear_modulus_floor,     shear_modulus_floor,       "Pa",        1,      1e10,   "smallest limiting shear modulus Ginf") \
  X(oil,        density,                 oil_density,               "kg/m3",     1,      3000,   "density of the oil")

/* Roughness of surfaces. */
#define TRB_ROUGHNESS_INPUTS(X) \
  X(roughness,  raceway,                 roughness_raceway,         "m",         1e-10,  1e-3,   "composite rms roughness of roller and raceway") \
  X(roughness,  rib,                     roughness_rib,             "m",         1e-10,  1e-3,   "composite rms roughness of roller end and rib")

/* Laws of friction. */
#define TRB_FRICTION_INPUTS(X) \
  X(friction,   lambda_boundary,         lambda_boundary,           "1",         0,      100,    "film parameter below which friction is boundary") \
  X(friction,   lambda_full,             lambda_full,               "1",         1e-3,   100,    "film parameter above which friction is full film") \
  X(friction,   asperity_factor,         asperity_factor,           "1",         0,      1000,   "B of exp(-B Lambda^C) at raceways") \
  X(friction,   asperity_exponent,       asperity_exponent,         "1",         0.01,   10,     "C of exp(-B Lambda^C) at raceways") \
  X(friction,   rib_asperity_factor,     rib_asperity_factor,       "1",         0,      1000,   "B of exp(-B Lambda^C) at ribs") \
  X(friction,   rib_asperity_exponent,   rib_asperity_exponent,     "1",         0.01,   10,     "C of exp(-B Lambda^C) at ribs") \
  X(friction,   boundary_limit,          boundary_limit,            "1",         0,      10,     "boundary friction at large slip (0.1)") \
  X(friction,   rib_boundary_limit,      rib_boundary_limit,        "1",         0,      10,     "the same at ribs") \
  X(friction,   boundary_slope,          boundary_slope,            "1",         0,      1e4,    "slope term of boundary friction (22.28)") \
  X(friction,   boundary_decay,          boundary_decay,            "1",         1e-3,   1e5,    "decay of boundary friction (181.46)") \
  X(friction,   dry_friction,            dry_friction,              "1",         0,      10,     "Coulomb friction coefficient of dry contacts and of traction 'coulomb'") \
  X(friction,   coulomb_speed,           coulomb_speed,             "m/s",       1e-9,   10,     "sliding speed over which Coulomb friction turns smoothly through zero") \
  X(friction,   cage_entrainment_speed,  cage_entrainment_speed,    "m/s",       1e-6,   100,    "ue: speed that guards the slide-roll ratio where surfaces do not roll") \
  X(friction,   speed_floor,             speed_floor,               "m/s",       1e-12,  1,      "smallest mean speed in films and slide-roll ratios (smooth)") \
  X(friction,   thermal_floor,           thermal_floor,             "1",         1e-6,   0.9,    "smallest thermal film reduction factor (smooth)") \
  X(friction,   rolling_blend,           rolling_blend,             "1",         1e-6,   0.9,    "half width in h_PE/h_IR over which rolling resistance sets in")

/* Effects of the scene, quadrature, damping and what there is of oil. */
#define TRB_EFFECTS_INPUTS(X) \
  X(effects,    quadrature,              quadrature,                "choice",    0,      1,      "nodes along the contact: 0 uniform slices, 1 Gauss-Legendre") \
  X(effects,    n_slices,                n_slices,                  "count",     1,      200,    "number of slices or nodes along a contact line") \
  X(effects,    starvation_factor,       starvation_factor,         "1",         1e-4,   1,      "factor of every film thickness and of rolling resistance") \
  X(effects,    supply,                  supply,                    "1",         0,      1,      "share of rolling resistance on raceways that the supply of oil leaves") \
  X(effects,    replenishment,           replenishment,             "s/rad",     0,      1,      "decline of the supply of raceways with the speed of the rings: factor exp(-c speed) of their rolling resistance") \
  X(effects,    oil_height,              oil_height,                "m",         0,      1,      "height of the oil before the contacts on raceways; 0: they are flooded") \
  X(effects,    flooded_gaps,            flooded_gaps,              "choice",    0,      1,      "1: gaps beside the loaded part of a contact are full of oil") \
  X(effects,    hysteresis,              hysteresis,                "1",         0,      0.5,    "share of a contact's elastic energy that the steel of rollers and raceways loses; 0: none") \
  X(effects,    oil_fill,                oil_fill,                  "1",         0,      1,      "share of oil in the mixture of oil and air round the rollers; 0: no drag") \
  X(effects,    drag_coefficient,        drag_coefficient,          "1",         0,      20,     "Cd: drag coefficient of a roller across its axis") \
  X(effects,    damping_race,            damping_race,              "s/m",       0,      1e4,    "Hunt-Crossley damping of raceway and rib contacts") \
  X(effects,    film_damping,            film_damping,              "s",         0,      1e-2,   "t of the damping of raceways and ribs by films, whose coefficient is t/(interference + d0)") \
  X(effects,    film_damping_depth,      film_damping_depth,        "m",         1e-9,   1,      "d0 of the damping by films: interference at which the coefficient has fallen to half") \
  X(effects,    with_cage,               with_cage,                 "choice",    0,      2,      "0 rollers only, 1 rollers and cage, 2 rollers that a spacer holds") \
  X(effects,    planar,                  planar,                    "choice",    0,      1,      "1: axial positions and tilts are frozen") \
  X(effects,    lubrication,             lubrication,               "choice",    0,      3,      "0 dry, 1 boundary, 2 mixed, 3 full film") \
  X(effects,    traction,                traction,                  "choice",    0,      2,      "film traction: 0 none, 1 Coulomb, 2 Muraki-Kimura") \
  X(effects,    thermal,                 thermal,                   "choice",    0,      2,      "thermal reduction of films: 0 off, 1 Gupta, 2 Aihara") \
  X(effects,    mixed_law,               mixed_law,                 "choice",    0,      1,      "share of boundary friction: 0 the sixth power (2), 1 exp(-B Lambda^C)") \
  X(effects,    rolling_resistance,      rolling_resistance,        "choice",    0,      6,      "EHL rolling resistance: 0 off, 1 Zhou-Hoeprich, 2 Goksem-Hargreaves, 3 Aihara, 4 Matsuyama, 5 Biboulet-Houpert, 6 numerical solutions of the line") \
  X(effects,    rolling_load,            rolling_load,              "choice",    0,      1,      "load of the law of rolling resistance: 0 of each slice, 1 of the whole contact over the roller's length") \
  X(effects,    rolling_pressure_force,  rolling_pressure_force,    "choice",    0,      1,      "pressure force of the rolling film on the roller") \
  X(effects,    back_rib,                back_rib,                  "choice",    0,      1,      "large end against the back-face rib") \
  X(effects,    front_rib,               front_rib,                 "choice",    0,      1,      "small end against the front rib") \
  X(effects,    rib_film,                rib_film,                  "choice",    0,      2,      "film at the rib: 0 the thicker of PE and IR, 1 PE, 2 PE of a needle") \
  X(effects,    rib_turning,             rib_turning,               "choice",    0,      1,      "1: sliding at the ribs turns within the contact") \
  X(effects,    guidance,                guidance,                  "choice",    0,      2,      "what guides the cage: 0 rollers, 1 land of the inner ring, 2 land of the outer ring") \
  X(effects,    damping,                 damping,                   "choice",    0,      2,      "normal damping: 0 off, 1 Hunt-Crossley, 2 by films at raceways and ribs")

/* P(part, INPUTS): the parts, in the order of the flat block. */
#define TRB_PARTS(P) \
  P(bearing, TRB_BEARING_INPUTS) \
  P(roller, TRB_ROLLER_INPUTS) \
  P(rib, TRB_RIB_INPUTS) \
  P(cage, TRB_CAGE_INPUTS) \
  P(pocket, TRB_POCKET_INPUTS) \
  P(land, TRB_LAND_INPUTS) \
  P(outer_ring, TRB_OUTER_RING_INPUTS) \
  P(inner_ring, TRB_INNER_RING_INPUTS) \
  P(oil, TRB_OIL_INPUTS) \
  P(roughness, TRB_ROUGHNESS_INPUTS) \
  P(friction, TRB_FRICTION_INPUTS) \
  P(effects, TRB_EFFECTS_INPUTS)

#define TRB_INPUT_FIELD(part, field, name, unit, lower, upper, text) double field;
#define TRB_PART_STRUCT(part, INPUTS) \
  typedef struct trb_##part##_inputs { \
    INPUTS(TRB_INPUT_FIELD) \
  } trb_##part##_inputs;
TRB_PARTS(TRB_PART_STRUCT)
#undef TRB_INPUT_FIELD
#undef TRB_PART_STRUCT

typedef struct trb_params {
#define TRB_PART_MEMBER(part, INPUTS) trb_##part##_inputs part;
  TRB_PARTS(TRB_PART_MEMBER)
#undef TRB_PART_MEMBER
} trb_params;

/* Numbers of the inputs in the flat block. */
enum {
#define TRB_INPUT_ENUM(part, field, name, unit, lower, upper, text) TRB_PARAM_##name,
#define TRB_PART_ENUM(part, INPUTS) INPUTS(TRB_INPUT_ENUM)
  TRB_PARTS(TRB_PART_ENUM)
#undef TRB_INPUT_ENUM
#undef TRB_PART_ENUM
      TRB_N_PARAMS
};
_Static_assert(sizeof(trb_params) == TRB_N_PARAMS * sizeof(double), "the structs are one array");

typedef struct trb_param_info {
  const char *name;  /* by which Python, cases and errors know it */
  const char *unit;  /* SI */
  double      lower; /* smallest allowed value */
  double      upper; /* largest allowed value */
  const char *text;  /* what it is */
  const char *part;  /* whose it is, as TRB_PARTS names them */
} trb_param_info;

/* What a pocket face is: a row of doubles, one column per entry. A face is a convex polygon in the frame of its pocket: origin
 * at the nominal roller's mid length, axes n (outward, perpendicular to the roller axis), t (direction of rotation), a (roller axis,
 * towards the large end). normal points from the face to the roller. Columns u, v span the plane; the outline is given in (u, v). */
#define TRB_FACE_COLUMNS(X) \
  X(pocket,           1, "1",  "pocket the face belongs to; -1: every pocket") \
  X(slot,             1, "1",  "number of the face in its pocket, 0..: the column of its forces in results") \
  X(part,             1, "1",  "part of the roller it meets: 0 flank, 1 large end, 2 small end") \
  X(origin,           3, "m",  "a point of the plane, in the pocket frame (n, t, a)") \
  X(u,                3, "1",  "first unit vector in the plane") \
  X(v,                3, "1",  "second unit vector in the plane; u x v = normal, towards the roller") \
  X(stiffness_factor, 1, "1",  "factor of the contact's stiffness") \
  X(friction_factor,  1, "1",  "factor of the contact's friction coefficient") \
  X(n_vertices,       1, "1",  "number of vertices, 3..12") \
  X(outline,         24, "m",  "vertices (u, v) in turn, counter-clockwise seen from the roller")

typedef struct trb_face {
#define TRB_FACE_MEMBER(name, count, unit, text) double name[count];
  TRB_FACE_COLUMNS(TRB_FACE_MEMBER)
#undef TRB_FACE_MEMBER
} trb_face;

enum { TRB_N_FACE_COLUMNS = (int)(sizeof(trb_face) / sizeof(double)) };

/* Loads on a free inner ring, at the roller-centre plane on its axis. No contact depends on loads directly. */
#define TRB_LOAD_CHANNELS(X) \
  X(force_x,        "N",     "free inner ring, load along x") \
  X(force_y,        "N",     "free inner ring, load along y") \
  X(force_z,        "N",     "free inner ring, load along z") \
  X(moment_x,       "N m",   "free inner ring, moment about x") \
  X(moment_y,       "N m",   "free inner ring, moment about y") \
  X(torque,         "N m",   "free inner ring whose speed is not prescribed, torque about its axis")

/* Loads on an outer ring that is free with its housing, at the apex: what its support carries at the start. */
#define TRB_HOUSING_LOAD_CHANNELS(X) \
  X(housing_force_x,  "N",     "free outer ring, load along x") \
  X(housing_force_y,  "N",     "free outer ring, load along y") \
  X(housing_force_z,  "N",     "free outer ring, load along z") \
  X(housing_moment_x, "N m",   "free outer ring, moment about x through the apex") \
  X(housing_moment_y, "N m",   "free outer ring, moment about y through the apex")

/* Prescribed motion: channels given as value and slope at knots, cubic Hermite between them, constant outside. */
#define TRB_MOTION_CHANNELS(X) \
  X(displacement_x, "m",     "inner ring, translation along x") \
  X(displacement_y, "m",     "inner ring, translation along y") \
  X(displacement_z, "m",     "inner ring, translation along z") \
  X(rotation_x,     "rad",   "inner ring, misalignment about x, through the roller-centre plane") \
  X(rotation_y,     "rad",   "inner ring, misalignment about y, through the roller-centre plane") \
  X(shaft_speed,    "rad/s", "inner ring, speed of rotation about its axis") \
  X(gravity_x,      "m/s2",  "acceleration of gravity along x") \
  X(gravity_y,      "m/s2",  "acceleration of gravity along y") \
  X(gravity_z,      "m/s2",  "acceleration of gravity along z") \
  X(outer_speed,    "rad/s", "outer ring, speed of rotation about the bearing's axis") \
  TRB_LOAD_CHANNELS(X) \
  TRB_HOUSING_LOAD_CHANNELS(X)

enum {
#define TRB_CHANNEL_ENUM(name, unit, text) TRB_CHANNEL_##name,
  TRB_MOTION_CHANNELS(TRB_CHANNEL_ENUM)
#undef TRB_CHANNEL_ENUM
      TRB_N_CHANNELS
};
enum { TRB_FIRST_LOAD_CHANNEL = TRB_CHANNEL_force_x };

extern const trb_param_info trb_param_table[TRB_N_PARAMS];

#endif
