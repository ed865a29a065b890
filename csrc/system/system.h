/* A system: the bodies, surfaces and pairs that are simulated, as arrays that a builder fills at run time (system/tapered.h is the builder of
 * a tapered roller bearing), and the layout of the state that follows from them (docs/theory/motion.md#coordinates). Nothing changes it
 * after trb_system_finish, and many simulations and threads may use one.
 *
 * The state vector: the coordinates of the rollers (body/roller.h), those of the bodies of the hub (body/body.h), then spin angles and
 * quadratures. The frame R turns about the bearing axis with the kinematic angle of the orbit. A roller's coordinates are cylindrical and
 * are offsets from pure rolling; its axis is given by skew and tilt in the frame (e_r, e_t, e_z) that orbits with it; its velocities are
 * inertial velocities that are written in orbiting frames. In steady rolling the whole vector stands still. The spin angle is in the tail of
 * the vector, as nothing depends on it. */
#ifndef TRB_SYSTEM_SYSTEM_H
#define TRB_SYSTEM_SYSTEM_H

#include "contact/pair.h"

typedef struct trb_surface {
  const char *name;
  int         body; /* number of its body, or TRB_ROLLERS */
  trb_shape   shape;
  const void *is;
} trb_surface;

enum { TRB_MOST_SURFACES = 20 };

/* Where the entries of a system lie in a state, which may hold those of other systems, too (system/assembly.h). */
typedef struct trb_layout {
  int leaf;       /* rollers of the systems before it */
  int n_rollers;  /* of all systems */
  int hub;        /* where the coordinates of the bodies begin, those of all systems */
  int hub_width;  /* how many they are */
  int spin;       /* where the spin angles of its rollers begin */
  int quadrature; /* where its quadratures begin */
  int size;       /* of the whole state */
} trb_layout;

typedef struct trb_system {
  const trb_model *model; /* of the bearing: its numbers */
  trb_body         bodies[TRB_MOST_BODIES];
  int              n_bodies;
  trb_surface      surfaces[TRB_MOST_SURFACES];
  int              n_surfaces;
  trb_pair         pairs[TRB_MOST_PAIRS];
  int              n_pairs;
  int              driven;                        /* number of the body that its drive places and turns, and that loads act on */
  int              moving[TRB_MOST_MOVING_RINGS]; /* numbers of the rings with coordinates */
  int              n_moving;
  int              spacer; /* number of the body that holds all rollers at even spacing, or -1 */
  trb_layout       layout;
} trb_system;

/* Lays out the state of this system alone and checks what the builder has put together: every pair joins surfaces that its kind takes, and every mechanism by
 * which it loses energy is booked as a loss that the state has. */
trb_status trb_system_finish(trb_system *system, trb_message *message);

/* Speed of the driven ring at a state, rad/s. */
double trb_system_shaft_speed(const trb_system *system, const trb_drive *drive, const double *y);

/* Whether a pair that is on holds rollers along their axes. */
int trb_system_seats(const trb_system *system);

static inline int trb_n_quadratures(const trb_system *s) { return TRB_Q_losses + s->model->n_losses; }
static inline int trb_state_roller(const trb_system *s, int roller) { return (s->layout.leaf + roller) * TRB_ROLLER_SIZE; }
static inline int trb_state_hub(const trb_system *s) { return s->layout.hub; }
static inline int trb_state_main_size(const trb_system *s) { return s->layout.hub + s->layout.hub_width; }
static inline int trb_state_spin(const trb_system *s) { return s->layout.spin; }
static inline int trb_state_quadrature(const trb_system *s) { return s->layout.quadrature; }
static inline int trb_state_size(const trb_system *s) { return s->layout.size; }

/* Tolerance kind of an entry; of entries that are none of this system: that of quadratures. */
trb_tolerance trb_state_tolerance(const trb_system *system, int index);
/* The body of this system that has an entry of the hub, and the number of that coordinate; NULL: none of its bodies has it. */
const trb_body *trb_state_body(const trb_system *system, int index, int *coordinate);

#endif
