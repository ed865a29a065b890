/* Bodies that are no rolling elements: rings, the cage, oil, and whatever else a system is built of (system/system.h). A body is an instance
 * of a kind. A kind is a file with a row at its end: how many coordinates its bodies have in the state, where a body is, what loads do to
 * it, which work its drive does. What evaluates the equations of motion, their Jacobian, tolerances, energies and messages loops over the
 * bodies of a system and names none.
 *
 * Bodies with coordinates together are the hub: their coordinates follow those of the rollers in the state, body after body. A body without
 * coordinates is where its drive puts it. A ring is a body whose surfaces are surfaces of revolution about one axis; contacts read its pose
 * alone, whether a drive or coordinates put it there. */
#ifndef TRB_BODY_BODY_H
#define TRB_BODY_BODY_H

#include "bearing/model.h"
#include "body/drive.h"

typedef struct trb_body trb_body;

/* Sums over modes; they are compiled for each instruction set (contact/kernels.h). Shapes are those of a face. */
typedef struct trb_modal_kernels {
  /* The shapes times amplitudes: a displacement, then a turn. */
  void (*sum)(const double *shapes, int n, const double *amplitude, double sum[TRB_SHAPE_ROOM]);
  /* Adds what a force and a moment on the face, padded by zeros, do to each mode. */
  void (*push)(const double *shapes, int n, const double load[TRB_SHAPE_ROOM], double *force);
} trb_modal_kernels;

/* How a body is deformed, of which contacts read the amplitudes and their rates, and to which they add generalised forces. */
typedef struct trb_deformed {
  const trb_modes         *modes;
  const trb_modal_kernels *kernels;
  double                  *amplitude; /* of each mode, m */
  double                  *rate;      /* m/s */
  double                  *force;     /* power over rate, N */
} trb_deformed;

typedef struct trb_body_kind {
  const char *name;
  /* of bodies without coordinates: a ring that the drive places; NULL: nothing asks where it is. A ring with coordinates stands there where
   * no state is known, as in an equilibrium. */
  void (*place)(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose); /* in inertial coordinates */
  int rests; /* 1: its pose is the same at all times, and in every frame that turns about the bearing's axis */
  /* what its drive puts in against a wrench, in the same frame as the pose; NULL: the work is not booked */
  trb_drive_power (*power)(const trb_ring_pose *pose, const trb_drive *drive, const trb_wrench *on_body);
  /* of bodies with coordinates */
  int                   size; /* coordinates, where all bodies of the kind have as many */
  const trb_coordinate *coordinates;
  int                   skew;  /* coordinate that must stay below a right angle, or -1 */
  int                   loses; /* 1: its bodies lose energy in themselves (trb_rigid_pose) */
  void (*pose)(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_rigid_pose *pose);
  /* of rings with coordinates: the ring in inertial coordinates; moments on it are about its centre */
  void (*ring)(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_ring_pose *pose);
  /* rates of the coordinates under a load, gravity and inertia */
  void (*rates)(const trb_model *m, const trb_body *body, const trb_drive *drive, const trb_rigid_pose *pose, const double *y,
                const trb_wrench *load, double *rates);
  trb_rigid (*motion)(const trb_rigid_pose *pose, int coordinate); /* what a coordinate does to its place, or to its velocity, in R */
  double (*mass)(const trb_model *m, const trb_body *body);        /* on which gravity acts, kg */
  double (*kinetic)(const trb_model *m, const trb_body *body, const trb_rigid_pose *pose); /* energy, J */
  /* of a body that holds all rollers at even spacing on one orbit (motion/spacer.h): its moment of inertia about the bearing's axis; NULL: it does
   * not; its turn about that axis, minus the kinematic one, and its angular velocity are these coordinates */
  double (*spacing)(const trb_body *body);
  int turn, turning;
  /* of bodies that deform: amplitudes and their rates out of the coordinates; what forces on the modes add to the rates of the coordinates; the
   * coordinate that goes with the amplitude of a mode (that of its rate is the next one), and amplitude and rate for a unit of both; slopes of the
   * rates with one of these coordinates, added: loads apart, no others of the body's rates depend on it than those of the modes */
  void (*deform)(const trb_body *body, const double *y, trb_deformed *deformed);
  void (*pushed)(const trb_body *body, const double *force, double *rates);
  int (*amplitude)(const trb_body *body, int mode, double per[2]);
  void (*slopes)(const trb_body *body, const trb_rigid_pose *pose, int coordinate, double *rates);
  /* what its drive and the loads on it put in while bodies act on it by a wrench; NULL: nothing */
  trb_drive_power (*work)(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, const trb_wrench *load);
  /* of a body that systems may share: what a wrench adds to its rates, which are written, and to what its drive puts in, whatever else acts on it */
  trb_drive_power (*added)(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, const trb_wrench *load,
                           double *rates);
} trb_body_kind;

/* Most coordinates of a body that systems share. */
enum { TRB_MOST_CARRIED = 16 };

/* A body of a system. */
struct trb_body {
  const trb_body_kind  *kind;
  const char           *name;        /* as messages and names of coordinates begin */
  const void           *own;         /* parameters, as its kind says */
  int                   size;        /* coordinates; 0: as its kind says */
  const trb_coordinate *coordinates; /* of a body whose size is its own */
  const trb_modes      *modes;       /* by which it deforms; NULL: it is rigid */
  int                   loss;        /* where it books what it loses in itself: TRB_BOOK of an entry of bearing/losses.h; 0: nowhere */
  int                   first;       /* where its coordinates begin in the state; -1: it has none */
  int                   carried;     /* 1: it is part of a body of another system of the assembly, whose coordinates it has */
  int                   carrier_quadrature; /* of a carried body: where the quadratures of that system begin in the state */
};

/* A body at an instant. */
typedef struct trb_body_at {
  trb_rigid_pose pose;     /* of a body with coordinates, in R */
  trb_ring_pose  ring;     /* of a ring, in inertial coordinates */
  trb_ring_pose *in_frame; /* n_rollers: the same in the cylindrical frame of each roller; NULL where nobody asks for them */
  trb_deformed  *deformed; /* NULL: it is rigid, or nobody asks how it is deformed */
  int            rests;    /* as its kind says */
} trb_body_at;

static inline int trb_is_ring(const trb_body_kind *kind) { return kind->place != NULL || kind->ring != NULL; }

/* A ring in a frame that is turned about z by the angle whose cosine and sine are given. */
static inline trb_ring_pose trb_body_in(const trb_body_at *body, double cosine, double sine)
{
  return body->rests ? body->ring : trb_ring_pose_in_frame(&body->ring, cosine, sine);
}

/* Where a body with coordinates is. */
static inline void trb_body_pose(const trb_model *m, const trb_body *body, const trb_drive *drive, const double *y, trb_body_at *at)
{
  body->kind->pose(m, body, drive, y, &at->pose);
  if (at->deformed != NULL) body->kind->deform(body, y, at->deformed);
  if (body->kind->ring != NULL) body->kind->ring(m, body, drive, y, &at->ring);
}

/* Whether a coordinate is a place, and not a velocity. */
static inline int trb_is_place(const trb_coordinate *c) { return c->tolerance == TRB_TOL_POSITION || c->tolerance == TRB_TOL_ANGLE; }

#endif
