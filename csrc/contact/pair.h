/* A pair: two bodies that act on each other. A pair is an instance of a kind, with the numbers of its bodies in the system and parameters
 * of its own; a kind is a file with a row at its end. Everything that evaluates forces, their slopes, records or peaks loops over the pairs
 * that are on and names none: what a pair can do stands in its kind. */
#ifndef TRB_CONTACT_PAIR_H
#define TRB_CONTACT_PAIR_H

#include <math.h>

#include "contact/bounds.h"
#include "contact/contact.h"

/* How a pair's forces change. Those of a slow pair follow the roller's motion smoothly; between exact evaluations a tangent may stand for
 * them (stepping/tangent.h). Those of a fast pair come and go with impacts: a roller's are evaluated at every instant, unless the bodies
 * are proven not to touch. */
typedef enum trb_pace { TRB_PACE_SLOW, TRB_PACE_FAST } trb_pace;

/* Where the pair's mechanisms are booked: TRB_BOOK of an entry of the lists of bearing/losses.h; 0: nowhere. */
typedef struct trb_bookings {
  int loss[TRB_N_MECHANISMS];
  int torque[TRB_N_MECHANISMS]; /* share of the torque on the driven ring */
} trb_bookings;

/* Adds what a load loses by each mechanism to a list of losses. */
static inline void trb_book_losses(const trb_bookings *books, const trb_load *load, double *losses)
{
  for (int by = 0; by < TRB_N_MECHANISMS; by++)
    if (books->loss[by] != 0) losses[books->loss[by] - 1] += load->lost[by];
}

typedef struct trb_pair trb_pair;

enum { TRB_MOST_TOGETHER = 2 };
/* Pairs of one kind that one function evaluates together. */
typedef struct trb_batch {
  const trb_pair *pairs[TRB_MOST_TOGETHER];
  int             index[TRB_MOST_TOGETHER]; /* their numbers in the system */
  int             n;
} trb_batch;

struct trb_lanes;
struct trb_uneven;

/* Scratch of one thread, and the pairs that are on. */
/* What an evaluation of raceways does with slopes of their laws. */
typedef enum trb_laws_use { TRB_LAWS_EXACT, TRB_LAWS_KEPT, TRB_LAWS_FOLLOWED } trb_laws_use;

typedef struct trb_workspace {
  struct trb_lanes      *lanes;                   /* scratch of the raceway kernel */
  struct trb_uneven     *uneven;                  /* and of surfaces off their true form; NULL: the bearing has none */
  struct trb_law_slopes *laws;                    /* of every roller's raceways: slopes of their laws; NULL: they are not kept */
  trb_laws_use           laws_use;                /* of `laws`, where there are any */
  struct trb_races_held *held;                    /* raceways as they were looked at; NULL: nobody looks */
  int                    variant;                 /* kernel variant, index into trb_kernel_variants */
  trb_batch              batches[TRB_MOST_PAIRS]; /* pairs with a roller that are on */
  int                    n_batches;
  trb_batch              hub[TRB_MOST_PAIRS]; /* pairs without a roller that are on, each for itself */
  int                    n_hub;
  trb_counters           counters; /* of this workspace */
} trb_workspace;

/* Makes the workspace keep slopes of the laws of all raceway contacts, in this memory, where the scene's laws have them. */
void trb_law_slopes_create(const trb_model *m, trb_memory *memory, trb_workspace *work);
/* Makes the workspace keep what is looked at and followed, in this memory. */
void trb_looks_create(const trb_model *m, trb_memory *memory, trb_workspace *work);

/* The pairs of a batch, all chosen rollers at once; added to the loads. detail may be NULL. */
typedef void trb_pair_evaluate(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                               trb_detail *detail);
/* What peaks read of the chosen rollers' contacts, into the detail: load, pressure, film parameter, and how far they hold; share: by which a load
 * may change. Loads are scratch. */
typedef void trb_pair_look(const trb_model *m, const trb_instant *at, const trb_batch *batch, trb_workspace *work, trb_loads *loads,
                           trb_detail *detail, double share);
/* The same for one roller after such a look, out of its pose and the ring's, into the detail; gives 0, whatever it wrote, where a value may be off by more than the
 * share. */
typedef int trb_pair_follow(const trb_model *m, const trb_instant *at, const trb_pair *pair, int roller, const trb_workspace *work,
                            double share, trb_detail *detail);
/* Load between one roller and the other body of a fast pair. The load is written only where they may touch, or if the detail asks for
 * interferences; the same holds for the slopes, which may be NULL. Forces are added to those in the detail. */
typedef trb_gaps trb_pair_touch(const trb_model *m, const trb_pair *pair, const trb_instant *at, int roller, trb_counters *counters,
                                trb_load *load, trb_slopes *slopes, trb_detail *detail);

/* How near the bodies of a pair without a roller are to a contact, and how hard it would be. */
typedef struct trb_approach {
  double left;  /* gap, m; not above 0: they touch */
  double speed; /* at which it changes, m/s */
  double rise;  /* largest interference of a hit over its speed, s */
} trb_approach;

/* Load between the bodies of a pair without a roller, evaluated at every instant; wrenches in R. The load is zero before. */
typedef void trb_pair_between(const trb_model *m, const trb_pair *pair, const trb_instant *at, trb_counters *counters, trb_load *load,
                              trb_detail *detail);

/* What a surface is, and what its shape points to. */
typedef enum trb_shape {
  TRB_SHAPE_NONE,     /* the whole body: trb_cage_inputs of a cage, trb_oil_inputs of the oil */
  TRB_SHAPE_FLANK,    /* chain of spheres of the rollers (trb_model) */
  TRB_SHAPE_SPHERE,   /* end of the rollers: trb_sphere */
  TRB_SHAPE_PLANE,    /* end of the rollers: double, its place */
  TRB_SHAPE_RACE,     /* cone with the nodes of a contact line: trb_race_nodes */
  TRB_SHAPE_CONE,     /* bounded conical face: trb_rib */
  TRB_SHAPE_CIRCLES,  /* plane face between two circles: trb_circle[2] */
  TRB_SHAPE_POCKETS,  /* lists of bounded faces: trb_pockets */
  TRB_SHAPE_CYLINDER, /* that the cage carries: trb_guided */
  TRB_SHAPE_LAND      /* that guides it: trb_guide */
} trb_shape;

/* What a pair of a roller with a ring touches in. An edge has neither Hertz's pressure nor a film: records have its load alone. */
typedef enum trb_contact_form { TRB_CONTACT_NONE, TRB_CONTACT_LINE, TRB_CONTACT_POINT, TRB_CONTACT_EDGE } trb_contact_form;

typedef struct trb_pair_kind {
  const char        *name;
  trb_shape          shape[2];   /* of the surfaces that it joins */
  trb_pace           pace;       /* of pairs with a roller */
  int                seats;      /* 1: under load it holds a roller along the roller's axis */
  unsigned           mechanisms; /* by which it loses energy: TRB_LOSES of each */
  trb_contact_form   contact;    /* of a roller with a ring: it has a row of contacts in details */
  trb_pair_evaluate *evaluate;
  /* what bounds the changes of its gaps: TRB_N_GAPS of a fast pair, one of a contact with a ring */
  void (*arms)(const trb_model *m, const trb_pair *pair, trb_arms *arms);
  /* of slow pairs */
  /* interference out of the poses alone, the ring as the roller sees it, m; negative: the gap; NULL: it takes an evaluation */
  double (*depth)(const trb_pair *pair, const trb_roller_pose *roller, const trb_ring_pose *ring);
  trb_pair_look   *look;
  trb_pair_follow *follow; /* NULL: what was looked at holds as far as the look says */
  /* whether surfaces may be off their true form where a roller is; azimuth: of the roller, turned: of the ring, spin: of the roller, rad; NULL:
   * they never are */
  int (*uneven)(const trb_model *m, const trb_pair *pair, int roller, double azimuth, double turned, double spin);
  /* shortest time in which they change, at a speed of the ring against the rollers in rad/s, s */
  double (*change)(const trb_model *m, const trb_pair *pair, double speed);
  /* of fast pairs */
  trb_pair_touch *touch;
  int (*surfaces)(const trb_pair *pair, int roller); /* that it tests for a roller; 0: they never touch */
  void (*ways)(const trb_model *m, const trb_pair *pair, const trb_modes *modes, int roller,
               double *ways); /* [mode][gap]: longest way of what may touch, for a unit of amplitude, m/m */
  double (*stiffness)(const trb_model *m, const trb_pair *pair, double depth); /* load over interference at an interference, N/m */
  /* of pairs without a roller, which have nothing of the others */
  trb_pair_between *between;
  trb_approach (*approach)(const trb_model *m, const trb_pair *pair, const trb_instant *at); /* NULL: they do not touch */
} trb_pair_kind;

#define TRB_LOSES(mechanism) (1U << (mechanism))

/* Body a of a pair with a roller. */
enum { TRB_ROLLERS = -1 };

/* A pair of a system. */
struct trb_pair {
  const trb_pair_kind *kind;
  const char          *name;
  const char          *text;
  int                  surface[2]; /* numbers of the surfaces in the system */
  int                  a, b;       /* and of their bodies; a is TRB_ROLLERS where there is a roller */
  int                  on;         /* 0: an effect of the scene leaves it out, and nothing evaluates it */
  int                  contact;    /* number of its row of contacts in details */
  int                  slots;      /* of pockets: where its forces begin in details */
  const void          *own_a;      /* block of numbers of its first surface, as the shape says */
  const void          *own;        /* and of its second one */
  trb_bookings         books;
};

/* Adds what a pair does to the sums. */
static inline void trb_add_load(const trb_pair *pair, const trb_load *load, trb_loads *to)
{
  trb_add_wrench(pair->a == TRB_ROLLERS ? &to->roller : &to->on[pair->a], &load->on_a);
  trb_add_wrench(&to->on[pair->b], &load->on_b);
  to->elastic += load->elastic;
  trb_book_losses(&pair->books, load, to->power);
  for (int by = 0; by < TRB_N_MECHANISMS; by++)
    if (pair->books.torque[by] != 0) to->torque[pair->books.torque[by] - 1] += load->torque[by];
}

/* Change of velocity that films and damping of a contact with a ring may bear, m/s. damping: its coefficient, the mean over the load, s/m. */
static inline double trb_look_speed(const trb_model *m, double mean_speed, double damping, double share)
{
  const double speed = m->film ? share * mean_speed : (double)INFINITY;
  return damping > 0.0 ? fmin(speed, share / damping) : speed;
}

/* How far a point contact, with a load that goes with the interference to the power 1.5, or without a load, may go. */
static inline double trb_look_way(const trb_contact *c, double share)
{
  return c->interference > 0.0 ? share * c->interference / 1.5 : -c->interference;
}

/* The pose of a pair's other body in the frame of each roller. */
static inline const trb_ring_pose *trb_pair_ring(const trb_pair *pair, const trb_instant *at) { return at->bodies[pair->b].in_frame; }

/* Its row of contacts, one a roller. */
static inline trb_contact *trb_pair_contacts(const trb_model *m, const trb_pair *pair, const trb_detail *detail)
{
  return detail->contacts + (size_t)pair->contact * (size_t)m->n_rollers;
}

/* variant: name of a kernel variant, "" for the fastest that this machine runs. */
trb_status trb_workspace_create(const trb_pair *pairs, int n_pairs, const char *variant, trb_workspace **work, trb_message *message);
void       trb_workspace_free(trb_workspace *work);

/* Buffers of every intermediate quantity; freed by trb_detail_free. */
trb_status trb_detail_create(const trb_model *m, const trb_pair *pairs, int n_pairs, trb_detail **detail, trb_message *message);
void       trb_detail_free(trb_detail *detail);
void       trb_detail_clear(const trb_model *m, trb_detail *detail);

/* The kinds. */
extern const trb_pair_kind trb_pair_raceway, trb_pair_rib, trb_pair_front_rib, trb_pair_drag, trb_pair_pocket, trb_pair_land,
    trb_pair_pocket_with_film, trb_pair_cage_drag;

trb_pair_evaluate trb_contact_pocket;
trb_pair_touch    trb_contact_pocket_of;

#endif
