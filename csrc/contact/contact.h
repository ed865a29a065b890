/* What contacts read, and what they give (docs/theory/contacts.md). contact/pair.h says what a pair of bodies is; a system lists those that
 * it has (system/system.h).
 *
 * A pair reads the poses of an instant and adds to the loads of each roller: wrenches on the roller and on the other body, elastic energy
 * and the power lost, by mechanism. A pair without a roller adds to the loads that the other bodies have in common. A pair does not depend
 * on time and stores nothing between calls. */
#ifndef TRB_CONTACT_CONTACT_H
#define TRB_CONTACT_CONTACT_H

#include "base/memory.h"
#include "bearing/losses.h"
#include "bearing/model.h"
#include "body/body.h"
#include "body/roller.h"

/* Most pairs and most bodies of a bearing: a roller keeps a word of bits for its pairs, and a wrench for each body that it may touch. */
enum { TRB_MOST_PAIRS = 16, TRB_MOST_BODIES = 6, TRB_MOST_MOVING_RINGS = 2 };

/* What was evaluated, counted; an effect that is off stays at zero. X(name, text) */
#define TRB_COUNTERS(X) \
  X(force_evaluations,    "evaluations of all forces") \
  X(tangent_rollers,      "rollers whose forces of raceways and ribs were taken from their tangents") \
  X(exact_rollers,        "rollers whose forces of raceways and ribs were evaluated by the integrator") \
  X(raceway_nodes,        "nodes of loaded raceway contacts") \
  X(raceway_culled,       "raceway contacts without interference, left out") \
  X(film_nodes,           "nodes whose film was evaluated") \
  X(meniscus_nodes,       "nodes whose supply by a meniscus was evaluated") \
  X(gap_nodes,            "nodes whose gap beside the loaded part was evaluated") \
  X(hysteresis_nodes,     "nodes whose elastic hysteresis was evaluated") \
  X(thermal_nodes,        "nodes whose thermal film factor was evaluated") \
  X(traction_nodes,       "nodes whose film traction was evaluated") \
  X(boundary_nodes,       "nodes whose boundary friction was evaluated") \
  X(coulomb_nodes,        "nodes whose Coulomb friction was evaluated") \
  X(rolling_nodes,        "nodes whose rolling resistance was evaluated") \
  X(pressure_force_nodes, "nodes whose rolling pressure force was evaluated") \
  X(damping_nodes,        "nodes whose normal damping was evaluated") \
  X(uneven_contacts,      "raceway contacts with a surface off its true form") \
  X(spacers,              "evaluations of what a spacer in place of the cage does to all rollers") \
  X(rib_contacts,         "large ends in contact with the back-face rib") \
  X(rib_tests,            "large ends tested against the back-face rib") \
  X(front_rib_contacts,   "edges of the front rib in contact with a small end") \
  X(front_rib_tests,      "small ends tested against the front rib") \
  X(pocket_tests,         "pocket faces tested against their roller") \
  X(pocket_culled,        "pocket faces proven not to touch") \
  X(pocket_nodes,         "nodes and points in contact with pocket faces") \
  X(pocket_films,         "slices whose film towards a pocket face was evaluated") \
  X(drag_rollers,         "rollers whose drag in the oil was evaluated") \
  X(drag_cages,           "cages whose drag in the oil was evaluated") \
  X(land_films,           "strips of the cage's guiding surface whose film was evaluated") \
  X(land_contacts,        "strips of the cage's guiding surface in contact with the land") \
  X(gravity_bodies,       "bodies on which gravity was evaluated")

typedef struct trb_counters {
#define TRB_COUNTER_MEMBER(name, text) long long name;
  TRB_COUNTERS(TRB_COUNTER_MEMBER)
#undef TRB_COUNTER_MEMBER
} trb_counters;

/* Margin of a contact that the scene does not have, m. */
#define TRB_NO_CONTACT 1e30

/* How a pair loses energy. */
typedef enum trb_mechanism {
  TRB_BY_SLIDING,
  TRB_BY_ROLLING,
  TRB_BY_ROLLING_PRESSURE,
  TRB_BY_DAMPING,
  TRB_BY_FILM,
  TRB_N_MECHANISMS
} trb_mechanism;

/* What the two bodies of a pair do to each other. Wrenches on a roller, and a roller's on a ring, are in the roller's cylindrical
 * frame; those on other bodies, and of pairs without a roller, in R. Moments are about the centre of mass, or the reference
 * point of a ring. */
typedef struct trb_load {
  trb_wrench on_a, on_b;
  double     elastic;                  /* J */
  double     lost[TRB_N_MECHANISMS];   /* power of minus the forces on both bodies, less what is stored elastically, W */
  double     torque[TRB_N_MECHANISMS]; /* on a ring about its axis, N m */
} trb_load;

/* The sum over pairs that act on a roller, or over those without a roller. */
typedef struct trb_loads {
  trb_wrench roller;
  trb_wrench on[TRB_MOST_BODIES]; /* on each body of the system */
  double     elastic;             /* J */
  double
      margin[TRB_MOST_PAIRS]; /* of slow pairs: least distance of the contact from its onset or end, m; of a kind that tells its depth that
                                      * depth, negative for a gap */
  double torque[TRB_N_TORQUES]; /* shares of the torque on the driven ring about its axis, N m */
  double power[TRB_N_LOSSES];   /* lost, W */
} trb_loads;

/* All that the contacts read at an instant. */
typedef struct trb_instant {
  const trb_drive       *drive;   /* what is prescribed */
  const trb_roller_pose *rollers; /* n_rollers */
  const trb_body_at     *bodies;  /* of the system */
  const int             *chosen;  /* rollers to evaluate, ascending */
  int                    n;       /* how many */
  const double          *spin;    /* n_rollers: angle that each has turned by about its axis; NULL: surfaces count as of true form */
  const unsigned        *apart;   /* n_rollers: bits of the pairs that are proven not to touch; NULL: none is */
} trb_instant;

/* What the laws of films and friction give at a point or a node. X(name, unit, text) */
#define TRB_LAW_FIELDS(X) \
  X(pressure,           "Pa",   "largest Hertz pressure") \
  X(mean_speed,         "m/s",  "mean surface speed relative to the contact") \
  X(sliding_speed,      "m/s",  "sliding speed") \
  X(slide_roll,         "1",    "slide-roll ratio") \
  X(film_elastic,       "m",    "piezoviscous-elastic film") \
  X(film_rigid,         "m",    "isoviscous-rigid film") \
  X(thermal_factor,     "1",    "thermal film factor") \
  X(film,               "m",    "central film thickness") \
  X(film_parameter,     "1",    "film parameter Lambda")

/* A point contact, as users look into it; a line contact has the same of its nodes: sums, largest values, and means weighted by load.
 * X(name, unit, text) */
#define TRB_POINT_FIELDS(X) \
  X(interference,       "m",    "interference of the undeformed surfaces") \
  X(load,               "N",    "normal load") \
  TRB_LAW_FIELDS(X) \
  X(friction_coefficient, "1",  "friction coefficient") \
  X(friction,           "N",    "magnitude of the friction force") \
  X(height,             "m",    "height of the contact above the raceway") \
  X(overhang,           "1",    "share of the ellipse beyond the rib's edges")

/* A roller's contact with a ring, as records, peaks and users see it; what one kind does not have stays zero. */
typedef struct trb_contact {
#define TRB_POINT_MEMBER(name, unit, text) double name;
  TRB_POINT_FIELDS(TRB_POINT_MEMBER)
#undef TRB_POINT_MEMBER
  double traction; /* tangential force on the roller in the orbit's direction, N */
  /* how far it holds, where a look asks for it */
  double way;   /* displacement that changes the load by a share, m; negative: unknown */
  double speed; /* change of velocity that changes film or damping by a share, m/s */
} trb_contact;

/* The cage on the land of a ring, as users look into it. F(X, name, unit, text) */
#define TRB_LAND_FIELDS(F, X) \
  F(X, eccentricity,  "1",   "distance of the cage's axis from the land's at mid width, over the clearance") \
  F(X, gap,           "m",   "smallest gap between cage and land; negative: so deep is the interference") \
  F(X, force,         "N",   "normal force of the land on the cage, of film and contact together") \
  F(X, film_force,    "N",   "force of the land's oil film on the cage") \
  F(X, contact_force, "N",   "normal force of the land's contact on the cage") \
  F(X, friction,      "N",   "magnitude of the friction force of the land's contact") \
  F(X, torque,        "N m", "torque of the land on the cage about the land's axis")

typedef struct trb_land_detail {
#define TRB_LAND_MEMBER(X, name, unit, text) double name;
  TRB_LAND_FIELDS(TRB_LAND_MEMBER, 0)
#undef TRB_LAND_MEMBER
} trb_land_detail;

/* Intermediate quantities, stored if a caller wants to look at them; NULL while integrating. */
typedef struct trb_detail {
  double         *lanes;               /* [lane field][race][roller][node of n_lanes]; or NULL: the contacts alone */
  trb_contact    *contacts;            /* [pair of the rollers with a ring, in their order][roller] */
  double         *pocket_force;        /* [row of pockets][roller][slot], N */
  double         *pocket_friction;     /* likewise, N */
  double         *pocket_interference; /* likewise, largest; negative: smallest gap found, m; or NULL: forces alone */
  trb_land_detail land;
  int             n_contacts; /* such pairs */
  int             n_slots;    /* of all rows of pockets together */
  trb_memory      memory;     /* of all arrays */
} trb_detail;

/* Slopes of the wrench on a roller, about its centre of mass, with its motion relative to the other body: one column for a translation
 * along each axis, then one for a turn about each axis, with the other body at rest. That the normal turns at an edge is left out: this
 * term is load over radius, which is small beside the stiffness. */
typedef struct trb_slopes {
  struct trb_modal_slopes *modal;       /* of a body that deforms; NULL: nobody asks */
  trb_frame                axes;        /* in the roller's cylindrical frame, for motions and wrenches */
  trb_wrench               place[6];    /* per m and rad */
  trb_wrench               velocity[6]; /* per m/s and rad/s */
} trb_slopes;

/* The same for the modes of the other body. The face seen by a roller moves with each mode as a rigid one, so they follow from the slopes of
 * the faces. */
typedef struct trb_modal_slopes {
  trb_wrench *place, *rate; /* of the wrench on the roller with each amplitude and each rate */
  double (*pull_place)[6];  /* of the force on each mode with the roller's motion, in the columns of trb_slopes */
  double (*pull_rate)[6];
  double *own_place, *own_rate; /* [mode][mode of the force]: of the force on a mode with each amplitude and each rate */
} trb_modal_slopes;

/* Lower bounds of the gaps between a roller and another body, m: of its flank, and of its ends. Not above 0: it may touch. */
enum { TRB_GAP_FLANK, TRB_GAP_ENDS, TRB_N_GAPS };
typedef struct trb_gaps {
  double of[TRB_N_GAPS];
} trb_gaps;

static inline int trb_gaps_clear(const trb_gaps *gaps) { return gaps->of[TRB_GAP_FLANK] > 0.0 && gaps->of[TRB_GAP_ENDS] > 0.0; }

#endif
