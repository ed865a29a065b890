/* Everything that follows from the catalogue numbers of a bearing whose cup, cone and rollers share one apex, or are cylinders, which have none:
 * distances from the apex are then from the middle of the bearing (docs/theory/geometry.md#cones-and-rollers). */
#ifndef TRB_BEARING_GEOMETRY_H
#define TRB_BEARING_GEOMETRY_H

#include "base/status.h"
#include "bearing/params.h"

/* X(name, unit, text) */
#define TRB_GEOMETRY(X) \
  X(roller_half_angle,       "rad",   "nu: half angle of the roller cone") \
  X(roller_axis_angle,       "rad",   "alpha_m: angle of the roller axis to the bearing axis") \
  X(cone_half_angle,         "rad",   "alpha_i: half angle of the cone (inner) raceway") \
  X(apex_to_mid,             "m",     "Rc: apex to roller mid length along its axis; 0 for cylindrical rollers") \
  X(apex_to_large_end,       "m",     "apex to the large end of the effective length") \
  X(outer_race_radius,       "m",     "radius of the outer raceway at mid roller") \
  X(inner_race_radius,       "m",     "radius of the inner raceway at mid roller") \
  X(outer_equivalent_radius, "m",     "Re at the outer raceway, mid roller") \
  X(inner_equivalent_radius, "m",     "Re at the inner raceway, mid roller") \
  X(large_end_diameter,      "m",     "roller diameter at the large end of the effective length") \
  X(small_end_diameter,      "m",     "roller diameter at the small end of the effective length") \
  X(roller_mass,             "kg",    "mass of a roller") \
  X(roller_inertia_axial,    "kg m2", "moment of inertia about the roller's axis") \
  X(roller_inertia_transverse, "kg m2", "moment of inertia about a transverse axis through the centre of mass") \
  X(roller_mass_offset,      "m",     "centre of mass from mid length, towards the large end") \
  X(roller_centre_radius,    "m",     "radius of the roller's centre of mass from the bearing axis") \
  X(roller_centre_height,    "m",     "axial position of the roller's centre of mass from the apex") \
  X(centre_plane,            "m",     "axial position of the roller-centre plane (mid length) from the apex") \
  X(effective_modulus,       "Pa",    "E' of roller and ring: 2/[(1-v1^2)/E1 + (1-v2^2)/E2]") \
  X(pocket_modulus,          "Pa",    "E' of roller and cage") \
  X(sphere_radius,           "m",     "Rs: radius of the sphere of the roller's large end, of a cylinder of both ends") \
  X(sphere_centre,           "m",     "distance from the apex to the large-end sphere's centre, along the roller axis") \
  X(rib_normal_angle,        "rad",   "angle of the rib face's normal to the bearing axis") \
  X(rib_contact_radius,      "m",     "radius of the nominal rib contact from the bearing axis") \
  X(rib_contact_z,           "m",     "axial position of the nominal rib contact from the apex") \
  X(rib_curvature_radius,    "m",     "circumferential radius of curvature of the rib face (concave)") \
  X(rib_rx,                  "m",     "Rx: equivalent radius at the rib, along rolling") \
  X(rib_ry,                  "m",     "Ry: equivalent radius at the rib, across rolling") \
  X(rib_ellipticity,         "1",     "ratio of the contact ellipse's semi-axes, >= 1") \
  X(rib_stiffness,           "N/m^1.5", "K of the Hertz law Q = K d^1.5 at the rib") \
  X(rib_semi_axis_rolling,   "m/N^(1/3)", "semi-axis of the rib's ellipse along rolling, per cube root of load") \
  X(rib_semi_axis_across,    "m/N^(1/3)", "semi-axis of the rib's ellipse across rolling, per cube root of load") \
  X(cage_speed_ratio,        "1",     "kinematic cage speed over shaft speed") \
  X(roller_spin_ratio,       "1",     "roller spin in the cage's frame over shaft speed") \
  X(small_end_station,       "m",     "mid length to the small end, along the axis (negative)") \
  X(large_end_station,       "m",     "mid length to the large end, along the axis") \
  X(small_end_radius,        "m",     "roller radius at its small end")

typedef struct trb_geometry {
#define TRB_GEOMETRY_MEMBER(name, unit, text) double name;
  TRB_GEOMETRY(TRB_GEOMETRY_MEMBER)
#undef TRB_GEOMETRY_MEMBER
} trb_geometry;

typedef struct trb_geometry_info {
  const char *name; /* member of trb_geometry */
  const char *unit; /* SI */
  const char *text; /* what it is */
} trb_geometry_info;

enum { TRB_N_GEOMETRY = (int)(sizeof(trb_geometry) / sizeof(double)) };

extern const trb_geometry_info trb_geometry_table[TRB_N_GEOMETRY];

/* The ring that has a raceway or a rib, and the end of a roller; of a cylinder the large end is the one towards +z. */
enum { TRB_RACE_OUTER = 0, TRB_RACE_INNER = 1, TRB_N_RACES = 2 };
enum { TRB_END_SMALL = 0, TRB_END_LARGE = 1, TRB_N_ENDS = 2 };

/* Where a rib is, and the shape of its contact. */
typedef struct trb_rib_place {
  double normal_angle;              /* of the face's normal, from the bearing axis outward, rad */
  double radius;                    /* of the nominal contact from the bearing axis, m */
  double along;                     /* its axial position from the roller-centre plane, m */
  double curvature_radius;          /* of the face around the ring, m; negative: convex */
  double rx, ry;                    /* equivalent radii along and across rolling, m */
  double ellipticity, stiffness;    /* of the Hertz contact: 1, N/m^1.5 */
  double semi_rolling, semi_across; /* its semi-axes, per cube root of load, m/N^(1/3) */
} trb_rib_place;

/* race: of the ring that has the rib. A tapered bearing has one, at the inner ring against the large ends; a cylindrical one up to four. */
trb_status trb_place_rib(const trb_params *params, const trb_geometry *geometry, int race, int end, trb_rib_place *place,
                         trb_message *message);

/* Centre of the sphere of a roller's end, from mid length along its axis, m. */
double trb_end_sphere(const trb_geometry *geometry, int end);

/* E' = 2/[(1-v1^2)/E1 + (1-v2^2)/E2]; bodies of the same material are taken by themselves, without its rounding. */
double trb_composite_modulus(double e1, double v1, double e2, double v2);

trb_status trb_geometry_derive(const trb_params *params, trb_geometry *geometry, trb_message *message);

#endif
