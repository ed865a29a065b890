/* The hub: all bodies with coordinates that are not rolling elements. Their coordinates follow those of the rollers in the state, body
 * after body. Each kind of body is a file with a row at its end, and a line in the table of body/hub.c. What evaluates the equations of
 * motion, their Jacobian, tolerances, energies and messages loops over the rows and names none. */
#ifndef TRB_BODY_HUB_H
#define TRB_BODY_HUB_H

#include "body/ring.h"

typedef struct trb_coordinate {
  const char   *name;
  trb_tolerance tolerance; /* to which it is integrated */
  const char   *text;
} trb_coordinate;

typedef struct trb_hub_kind {
  const char           *name; /* as messages and names of coordinates begin */
  trb_body              body; /* the loads on this body of a pair act on it */
  int                   size; /* coordinates */
  const trb_coordinate *coordinates;
  int                   skew;       /* coordinate that must stay below a right angle, or -1 */
  int (*is_on)(const trb_model *m); /* whether the state of a model has its coordinates */
  void (*pose)(const trb_model *m, const trb_drive *drive, const double *y, trb_rigid_pose *pose);
  /* rates of the coordinates under a load, gravity and inertia */
  void (*rates)(const trb_model *m, const trb_drive *drive, const trb_rigid_pose *pose, const double *y, const trb_wrench *load,
                double *rates);
  trb_rigid (*motion)(const trb_rigid_pose *pose, int coordinate);   /* what a coordinate does to its place, or to its velocity, in R */
  double (*mass)(const trb_model *m);                                /* on which gravity acts, kg */
  double (*kinetic)(const trb_model *m, const trb_rigid_pose *pose); /* energy, J */
} trb_hub_kind;

extern const trb_hub_kind *const trb_hub_table[];
extern const int                 trb_n_hub_kinds;

/* Whether a coordinate is a place, and not a velocity. */
static inline int trb_is_place(const trb_coordinate *c) { return c->tolerance == TRB_TOL_POSITION || c->tolerance == TRB_TOL_ANGLE; }

/* Coordinates of all bodies of a model's hub. */
static inline int trb_hub_width(const trb_model *m)
{
  int width = 0;
  for (int k = 0; k < trb_n_hub_kinds; k++) width += trb_hub_table[k]->is_on(m) ? trb_hub_table[k]->size : 0;
  return width;
}

/* The body that has an entry of the hub, and the number of that coordinate. */
static inline const trb_hub_kind *trb_hub_kind_at(const trb_model *m, int entry, int *coordinate)
{
  const trb_hub_kind *kind = NULL;
  *coordinate = entry;
  for (int k = 0; k < trb_n_hub_kinds; k++) {
    if (!trb_hub_table[k]->is_on(m)) continue;
    kind = trb_hub_table[k];
    if (*coordinate < kind->size) break;
    *coordinate -= kind->size;
  }
  return kind;
}

#endif
