/* Contacts (docs/theory/contacts.md). Each pair of surfaces has a file with one function; all have the same signature, and
 * trb_contact_pairs lists them.
 *
 * A pair reads the poses of an instant and adds to the loads of each roller: wrenches on roller, inner ring and cage, elastic energy and
 * the power lost, by kind. It does not depend on time and stores nothing between calls. */
#ifndef TRB_CONTACT_CONTACT_H
#define TRB_CONTACT_CONTACT_H

#include "bearing/model.h"
#include "bearing/state.h"

/* Power lost in a contact: minus the power of its forces on both bodies, less what is stored elastically. */
typedef enum trb_power {
  TRB_POWER_TRACTION_OUTER,
  TRB_POWER_TRACTION_INNER,
  TRB_POWER_ROLLING,
  TRB_POWER_ROLLING_PRESSURE,
  TRB_POWER_RIB,
  TRB_POWER_FRONT_RIB,
  TRB_POWER_POCKET,
  TRB_POWER_DAMPING,
  TRB_N_POWERS
} trb_power;

/* Contacts of a roller with the rings, by how its motion changes their interference. */
typedef enum trb_margin { TRB_MARGIN_RACES, TRB_MARGIN_RIB, TRB_MARGIN_FRONT_RIB, TRB_N_MARGINS } trb_margin;

/* Share of the torque that the rollers put on the inner ring about its axis. */
typedef enum trb_torque { TRB_TORQUE_TRACTION, TRB_TORQUE_ROLLING, TRB_TORQUE_RIB, TRB_TORQUE_FRONT_RIB, TRB_N_TORQUES } trb_torque;

/* What was evaluated, counted; an effect that is off stays at zero. X(name, text) */
#define TRB_COUNTERS(X) \
  X(force_evaluations,    "evaluations of all forces") \
  X(tangent_rollers,      "rollers whose forces of raceways and ribs were taken from their tangents") \
  X(raceway_nodes,        "nodes of loaded raceway contacts") \
  X(raceway_culled,       "raceway contacts without interference, left out") \
  X(film_nodes,           "nodes whose film was evaluated") \
  X(thermal_nodes,        "nodes whose thermal film factor was evaluated") \
  X(traction_nodes,       "nodes whose film traction was evaluated") \
  X(boundary_nodes,       "nodes whose boundary friction was evaluated") \
  X(coulomb_nodes,        "nodes whose Coulomb friction was evaluated") \
  X(rolling_nodes,        "nodes whose rolling resistance was evaluated") \
  X(pressure_force_nodes, "nodes whose rolling pressure force was evaluated") \
  X(damping_nodes,        "nodes whose normal damping was evaluated") \
  X(rib_contacts,         "large ends in contact with the back-face rib") \
  X(rib_tests,            "large ends tested against the back-face rib") \
  X(front_rib_contacts,   "edges of the front rib in contact with a small end") \
  X(front_rib_tests,      "small ends tested against the front rib") \
  X(pocket_tests,         "pocket faces tested against their roller") \
  X(pocket_culled,        "pocket faces proven not to touch") \
  X(pocket_nodes,         "nodes and points in contact with pocket faces") \
  X(gravity_bodies,       "bodies on which gravity was evaluated")

typedef struct trb_counters {
#define TRB_COUNTER_MEMBER(name, text) long long name;
  TRB_COUNTERS(TRB_COUNTER_MEMBER)
#undef TRB_COUNTER_MEMBER
} trb_counters;

/* Margin of a contact that the scene does not have, m. */
#define TRB_NO_CONTACT 1e30

typedef struct trb_roller_load {
  trb_vec3 force;                 /* on the roller, in its cylindrical frame, N */
  trb_vec3 moment;                /* on the roller about its centre of mass, N m */
  trb_vec3 ring_force;            /* on the inner ring, in the same frame, N */
  trb_vec3 ring_moment;           /* on the inner ring about its centre, N m */
  trb_vec3 outer_force;           /* on the outer ring, in the same frame, N */
  trb_vec3 outer_moment;          /* on the outer ring about the apex, N m */
  trb_vec3 cage_force;            /* on the cage, in R, N */
  trb_vec3 cage_moment;           /* on the cage about its centre of mass, N m */
  double   elastic;               /* J */
  double   margin[TRB_N_MARGINS]; /* of raceways and ribs: least distance of a contact from its onset or end, m */
  double   torque[TRB_N_TORQUES]; /* on the inner ring about its axis, N m */
  double   power[TRB_N_POWERS];   /* lost, W */
} trb_roller_load;

/* All that the contacts read at an instant. */
typedef struct trb_instant {
  const trb_drive       *drive;   /* what is prescribed */
  const trb_roller_pose *rollers; /* n_rollers */
  const trb_ring_pose   *inner;   /* n_rollers: the inner ring in each roller's frame */
  const trb_cage_pose   *cage;    /* NULL without a cage */
  const int             *chosen;  /* rollers to evaluate, ascending */
  int                    n;       /* how many */
} trb_instant;

/* A point contact, as users look into it. X(name, unit, text) */
#define TRB_POINT_FIELDS(X) \
  X(interference,       "m",    "interference of the undeformed surfaces") \
  X(load,               "N",    "normal load") \
  X(pressure,           "Pa",   "largest Hertz pressure") \
  X(mean_speed,         "m/s",  "mean surface speed relative to the contact") \
  X(sliding_speed,      "m/s",  "sliding speed") \
  X(slide_roll,         "1",    "slide-roll ratio") \
  X(film_elastic,       "m",    "piezoviscous-elastic film") \
  X(film_rigid,         "m",    "isoviscous-rigid film") \
  X(thermal_factor,     "1",    "thermal film factor") \
  X(film,               "m",    "central film thickness") \
  X(film_parameter,     "1",    "film parameter Lambda") \
  X(friction_coefficient, "1",  "friction coefficient") \
  X(friction,           "N",    "magnitude of the friction force") \
  X(height,             "m",    "height of the contact above the raceway") \
  X(overhang,           "1",    "share of the ellipse beyond the rib's edges")

typedef struct trb_point_detail {
#define TRB_POINT_MEMBER(name, unit, text) double name;
  TRB_POINT_FIELDS(TRB_POINT_MEMBER)
#undef TRB_POINT_MEMBER
} trb_point_detail;

struct trb_lanes;

/* Intermediate quantities, stored if a caller wants to look at them; NULL while integrating. */
typedef struct trb_detail {
  double           *lanes;               /* [lane field][race][roller][node of n_lanes] */
  trb_point_detail *rib;                 /* n_rollers */
  trb_point_detail *front_rib;           /* n_rollers */
  double           *pocket_force;        /* [roller][slot], N */
  double           *pocket_friction;     /* [roller][slot], N */
  double           *pocket_interference; /* [roller][slot], largest; negative: smallest gap found, m; or NULL: forces alone */
} trb_detail;

/* Scratch of one thread. */
typedef struct trb_workspace {
  struct trb_lanes *lanes;    /* scratch of the raceway kernel */
  int               variant;  /* kernel variant, index into trb_kernel_variants */
  trb_counters      counters; /* of this workspace */
} trb_workspace;

typedef void trb_contact_function(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads,
                                  trb_detail *detail);

trb_contact_function trb_contact_raceway, trb_contact_rib, trb_contact_front_rib, trb_contact_pocket;

/* variant: name of a kernel variant, "" for the fastest that this machine runs. */
trb_status trb_workspace_create(const trb_model *m, const char *variant, trb_workspace **work, trb_message *message);
void       trb_workspace_free(trb_workspace *work);

/* Zero the chosen rollers' loads and sum every pair that the scene has. */
void trb_contact_all(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads, trb_detail *detail);

/* Zero the chosen rollers' loads and sum the pairs of rollers and rings only. */
void trb_contact_rings_only(const trb_model *m, const trb_instant *at, trb_workspace *work, trb_roller_load *loads);
typedef struct trb_wrench {
  trb_vec3 force;  /* N */
  trb_vec3 moment; /* N m */
} trb_wrench;

/* Slopes of the wrench on a roller, about its centre of mass, with its motion relative to its pocket: one column for a translation along
 * each axis, then one for a turn about each axis, with the pocket at rest. That the normal turns at an edge is left out: this term is
 * load over radius, which is small beside the stiffness. */
typedef struct trb_pocket_slopes {
  trb_frame  axes;        /* in the roller's cylindrical frame, for motions and wrenches */
  trb_wrench place[6];    /* per m and rad */
  trb_wrench velocity[6]; /* per m/s and rad/s */
} trb_pocket_slopes;

/* Lower bounds of the gaps between a roller and its pocket, m: of its flank, and of its ends. Not above 0: it may touch. */
enum { TRB_GAP_FLANK, TRB_GAP_ENDS, TRB_N_GAPS };
typedef struct trb_pocket_gaps {
  double of[TRB_N_GAPS];
} trb_pocket_gaps;

static inline int trb_pocket_clear(const trb_pocket_gaps *gaps) { return gaps->of[TRB_GAP_FLANK] > 0.0 && gaps->of[TRB_GAP_ENDS] > 0.0; }

/* Loads between one roller and its pocket. The load is written only where they may touch, or if the detail asks for interferences; the
 * same holds for the slopes, which may be NULL. Forces are added to those in the detail. */
trb_pocket_gaps trb_contact_pocket_of(const trb_model *m, const trb_instant *at, int roller, trb_counters *counters, trb_roller_load *load,
                                      trb_pocket_slopes *slopes, trb_detail *detail);

/* Buffers of every intermediate quantity; freed by trb_detail_free. */
trb_status trb_detail_create(const trb_model *m, trb_detail **detail, trb_message *message);
void       trb_detail_free(trb_detail *detail);
void       trb_detail_clear(const trb_model *m, trb_detail *detail);

#endif
