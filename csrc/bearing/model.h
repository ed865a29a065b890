/* The model: geometry, material, lubricant, effects, pockets. It is constant after creation; many simulations and threads may use one
 * model. */
#ifndef TRB_BEARING_MODEL_H
#define TRB_BEARING_MODEL_H

#include "base/status.h"
#include "base/vec3.h"
#include "base/memory.h"
#include "bearing/form.h"
#include "bearing/geometry.h"
#include "bearing/modes.h"
#include "bearing/params.h"
#include "bearing/surfaces.h"
#include "surface/polygon.h"

enum { TRB_PART_FLANK = 0, TRB_PART_LARGE_END = 1, TRB_PART_SMALL_END = 2 };
enum { TRB_LUBRICATION_DRY = 0, TRB_LUBRICATION_BOUNDARY = 1, TRB_LUBRICATION_MIXED = 2, TRB_LUBRICATION_FULL = 3 };
enum { TRB_DAMPING_OFF = 0, TRB_DAMPING_HUNT_CROSSLEY = 1, TRB_DAMPING_FILM = 2 };
enum { TRB_THERMAL_OFF = 0, TRB_THERMAL_GUPTA = 1, TRB_THERMAL_AIHARA = 2 };
enum { TRB_RIB_FILM_MAX = 0, TRB_RIB_FILM_PE = 1, TRB_RIB_FILM_NEEDLE = 2 };
enum { TRB_TRACTION_NONE = 0, TRB_TRACTION_COULOMB = 1, TRB_TRACTION_MURAKI_KIMURA = 2 };

enum { TRB_GUIDANCE_ROLLERS = 0, TRB_GUIDANCE_INNER_LAND = 1, TRB_GUIDANCE_OUTER_LAND = 2 };

/* Most faces of a pocket, and one more than the last slot. */
enum { TRB_MOST_SLOTS = 64 };

/* Strips along the width of the cage's guiding surface. */
enum { TRB_LAND_STRIPS = 6 };

/* Nodes along one contact are padded to a multiple of this, so that no scalar remainder runs. */
#define TRB_LANE_PAD 8

/* A raceway, and what belongs to the nodes of a contact line on it and is the same for all rollers. Arrays of n_lanes. */
typedef struct trb_race_nodes {
  int             race;         /* TRB_RACE_OUTER or TRB_RACE_INNER: place of its contacts in results */
  const trb_cone *cone;         /* about the ring's axis */
  double         *weight;       /* quadrature weight along the contact, m; 0 in padding */
  double         *log_radius;   /* ln Re */
  double         *radius;       /* Re, m */
  double         *roller_share; /* Re/R1: share of the roller in the pair's curvature */
  double         *drop;         /* of the raceway's profile, along its normal, m */
} trb_race_nodes;

/* A conical rib of a ring, and the spherical end of a roller that meets it. */
typedef struct trb_rib {
  trb_cone   face;              /* about the ring's axis */
  trb_cone   race;              /* raceway beside it, from which heights are counted */
  trb_sphere end;               /* of the roller, from its centre of mass */
  double     edge_low;          /* heights of its edges above the raceway, m */
  double     edge_high;         /* m */
  double     stiffness;         /* K of the Hertz law Q = K d^1.5, N/m^1.5 */
  double     semi_axis_rolling; /* of the contact ellipse, per cube root of load, m/N^(1/3) */
  double     semi_axis_across;  /* m/N^(1/3) */
  double     rx;                /* equivalent radius along rolling, m */
  double     film_shape;        /* factor of eq. 12 */
  double     film_rigid;        /* factor of eq. 13; 0: it has no part */
  double     roughness;         /* composite rms, m */
} trb_rib;

/* A land of a ring that guides the cage. */
typedef struct trb_guide {
  double radius; /* m */
  int    inside; /* 1: the cage runs inside the land */
} trb_guide;

/* The surface of a cage that runs on a land, cut into strips along its width. */
typedef struct trb_guided {
  trb_land_inputs given;
  double          station[TRB_LAND_STRIPS]; /* of the strips, from the middle of the surface, m */
  double          weight[TRB_LAND_STRIPS];  /* their widths, m */
  double          place;                    /* middle of the surface from the cage's centre of mass, m */
  double          palmgren;                 /* load per length of cage and land at d = 1 m */
  double          damping;                  /* normal damping of the contact, s/m */
  double          mass;                     /* of the cage, kg */
  int             film;                     /* there is an oil film */
} trb_guided;

/* A ring with coordinates, with all that moves with it. Forces act at its reference point, which contacts read, too. */
typedef struct trb_ring_body {
  double mass, inertia_axial, inertia_transverse;
  double reference;              /* nominal axial place of the reference point, m */
  double offset;                 /* of the centre of mass from there, m */
  double unbalance;              /* kg m */
  double unbalance_angle;        /* from the x axis where the ring has not turned, rad */
  double damping, damping_turns; /* to the surroundings */
  double support_radial, support_axial, support_tilt;
  double support_position; /* of the support from the reference point, m */
  double shift;            /* of the bearing's ring where its coordinates are zero, m */
  double sense;            /* of y and z of the bearing in the axes of the coordinates: 1, or -1 where it is turned */
  int    keeps_speed;      /* 1: its drive keeps the prescribed speed with whatever torque that takes */
  int    is_outer;
} trb_ring_body;

/* Planes of facets of a surface, side by side, so that a roller's gaps to them are found in one loop. Places that are left over repeat the last
 * facet. */
enum { TRB_PLANES_TOGETHER = 8 };
typedef struct trb_planes {
  double origin[3][TRB_PLANES_TOGETHER], normal[3][TRB_PLANES_TOGETHER];
} trb_planes;

/* A facet of a surface. Facets of one slot make one surface, and follow each other; each point of the roller meets the nearest of them. */
typedef struct trb_pocket_face {
  trb_polygon surface;          /* in the frame of its pocket; its normal points towards the roller */
  trb_vec3    middle;           /* mean of its vertices, m */
  double      extent;           /* no point of it is further from there, m */
  int         n_facets;         /* of the surface that begins with it; 0: it is not the first one of its surface */
  double      stiffness_factor; /* of the contact's stiffness */
  double      friction_factor;  /* of the contact's friction coefficient */
  int         part;             /* TRB_PART_* */
  int         slot;             /* column in results */
} trb_pocket_face;

/* A row of pockets, one for each roller, in a cage. */
typedef struct trb_pockets {
  trb_pocket_inputs given;
  double            film;           /* gap between roller and bar in which a film acts, m; 0: there is none */
  double            damping;        /* normal damping of contacts, s/m */
  double            palmgren;       /* load per length of roller and cage at d = 1 m */
  double            wall_stiffness; /* stiffness of roller end against a wall of the cage: force = k d^1.5 */
  double            offset;         /* axial position of the cage's centre of mass from the roller-centre plane, m */
  trb_pocket_face  *faces;          /* all faces, grouped by pocket */
  int              *first_face;     /* per pocket, n_rollers + 1 entries: its faces are [first, next first) */
  trb_planes       *planes;         /* as many as faces: at face i of a surface those of its facets from TRB_PLANES_TOGETHER i on */
  trb_frame        *axes;           /* per pocket: n, t, a of the nominal roller, in the cage's body */
  trb_vec3         *origin;         /* per pocket: nominal mid length, from the cage's centre of mass, m */
} trb_pockets;

typedef struct trb_model {
  trb_params     params;             /* as given, checked */
  trb_geometry   geometry;           /* derived */
  trb_surfaces   surfaces;           /* of rings and rollers */
  int            n_rollers;          /* Z */
  int            n_nodes;            /* nodes along a contact line */
  int            n_lanes;            /* the same, padded */
  int            n_slots;            /* most faces in a pocket of any row, at least 1 */
  double        *diameter_deviation; /* per roller, m */
  double        *station;            /* per lane: node's station from mid length, m */
  double        *cell;               /* ends of the nodes' cells, as long as their weights: n_nodes + 1 stations, m */
  double        *centre;             /* per roller and lane: sphere's centre from the centre of mass, along the axis, m */
  double        *sphere;             /* per roller and lane: sphere's radius, m */
  trb_sphere    *end_spheres;        /* per roller: of a flank around all profiles at both ends of the effective length */
  trb_race_nodes race[TRB_N_RACES];
  trb_pockets    pockets; /* of its cage */
  trb_guided     guided;  /* surface of its cage on a land */
  /* constants of the laws */
  double        log_modulus;                  /* ln E' */
  double        log_palmgren;                 /* ln of the load per length of roller and ring at d = 1 m */
  double        axis_sine, axis_cosine;       /* of the roller axis' angle */
  double        log_g;                        /* ln G */
  double        log_viscosity;                /* ln eta0 */
  double        log_thermal;                  /* ln(eta0 beta/k') */
  double        replenishment;                /* decline of the film's supply at a raceway with its mean speed, s/m */
  trb_rib       rib[TRB_N_RACES][TRB_N_ENDS]; /* conical ribs, by the raceway of their ring and the end that they meet */
  trb_ring_body ring[TRB_N_RACES];            /* rings, by their raceway, where they have coordinates */
  trb_guide     guide[TRB_N_RACES];           /* lands, by the raceway of their ring */
  trb_angle    *nominal_angle;                /* per roller: of its nominal place in the frame R */
  int           friction;                     /* any friction at raceways and ribs at all */
  int           pocket_friction;              /* any friction in the pockets */
  int           film;                         /* films are needed */
  double        contact_damping;              /* normal damping of raceways and ribs where the interference is small, s/m */
  double        damping_fade;                 /* 1 over the interference at which it has fallen to half, 1/m; 0: constant */
  trb_modes     modes;                        /* of an elastic cage */
  trb_form      form;                         /* of surfaces off their true form */
  int           n_losses;                     /* entries of the list of losses (bearing/losses.h) that have a quadrature */
  trb_memory    memory;                       /* of all arrays */
} trb_model;

/* Whether rollers and raceways are cylinders. */
static inline int trb_has_cylinders(const trb_model *model) { return model->params.bearing.cup_half_angle == 0.0; }

/* Whether there is a cage with pockets: not where rollers are alone, or a spacer holds them. */
static inline int trb_has_cage(const trb_model *model) { return model->params.effects.with_cage == 1.0; }

/* Coefficient of the normal damping of a contact with a ring at an interference, s/m (docs/theory/contacts.md#normal-damping). */
static inline double trb_contact_damping(const trb_model *model, double interference)
{
  return model->contact_damping / (1.0 + model->damping_fade * (interference > 0.0 ? interference : 0.0));
}

/* Coefficient of the normal damping of contacts of a cage, s/m. */
static inline double trb_damping_of_cage(const trb_model *model)
{
  return model->params.effects.damping > 0.0 ? model->params.pocket.damping : 0.0;
}

/* Distance of the farthest sphere of the flank from the centre of mass of its roller, m. */
double trb_chain_length(const trb_model *model);

/* A checked, immutable copy of everything given. deviation: a roller's diameter over nominal, n_rollers values; faces: n_faces rows. */
trb_status trb_model_create(const trb_params *params, const double *deviation, int n_deviations, const trb_face *faces, int n_faces,
                            trb_model **model, trb_message *message);
/* Gives a new model, whose params.cage.n_modes says how many, the modes of its cage: as many rows of TRB_MODE_shapes + 6 n_rollers n_slots
 * numbers. */
trb_status trb_model_set_modes(trb_model *model, const double *rows, int n_modes, int n_columns, trb_message *message);
/* Gives a new model the form of its surfaces: rows of TRB_FORM_depth + 2 n_nodes numbers (bearing/form.h); none: all surfaces have their true
 * form. */
trb_status trb_model_set_form(trb_model *model, const double *rows, int n_rows, int n_columns, trb_message *message);
/* Gives a new model what profiles drop at the nodes, m: rows of n_nodes for the rollers, in addition to their own profile and perpendicular to
 * their axis, the outer and the inner raceway; none: raceways are straight. */
trb_status trb_model_set_drops(trb_model *model, const double *rows, int n_rows, int n_columns, trb_message *message);
/* Fills a block of the surface by which a cage runs on a land. */
void trb_guided_fill(const trb_model *model, const trb_land_inputs *land, const trb_cage_inputs *cage, trb_guided *guided);
void trb_model_free(trb_model *model);

#endif
