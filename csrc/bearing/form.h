/* How far surfaces of rollers and raceways lie off their true form, as data (docs/theory/contacts.md#surfaces-off-their-true-form). A patch
 * is a stretch of a surface along the direction of rolling, with the depth that the other surface of the contact sinks into it at each node
 * of the contact line. Where no patch is, a surface has its true form. */
#ifndef TRB_BEARING_FORM_H
#define TRB_BEARING_FORM_H

#include "base/memory.h"
#include "base/status.h"

/* What a sample of a patch is as a row of numbers: the number of the patch, ascending; the surface (TRB_FORM_SURFACE); the angle on it, equally
 * spaced within a patch (rad); the shortest angle over which the depth changes (rad); then for each node of the contact line the depth (m),
 * and after them its slope over the angle (m/rad). */
enum { TRB_FORM_patch, TRB_FORM_surface, TRB_FORM_angle, TRB_FORM_scale, TRB_FORM_depth };

/* Surfaces: the races, then those of each roller as either race meets them. Angles on a ring are about its axis, from the x axis where it has
 * not turned; on a roller about its own axis, from the direction away from the bearing's axis where it has not turned. */
static inline int trb_form_of_race(int race) { return race; }
static inline int trb_form_of_roller(int roller, int race) { return 2 + 2 * roller + race; }

typedef struct trb_patch {
  int     surface;
  double  first, length; /* rad; length 2 pi: all round */
  double  step;          /* between samples, rad */
  double  scale;         /* shortest angle over which the depth changes, rad */
  int     n;             /* samples */
  double *rows;          /* [sample][2][node]: depth, slope */
} trb_patch;

typedef struct trb_form {
  int        n, n_nodes;
  trb_patch *patches;
  double    *rows; /* of all of them */
} trb_form;

/* Adds to depth and slope (n_nodes each) what the patches of a surface have at an angle; gives 0 where there is none. */
int trb_form_at(const trb_form *form, int surface, double angle, int node, double *depth, double *slope);
/* The shortest angle over which a depth changes on a race, and on any roller where it meets that race, rad; INFINITY: nowhere. */
typedef struct trb_form_scale {
  double race, roller;
} trb_form_scale;
trb_form_scale trb_form_scale_of(const trb_form *form, int race);
/* Whether a patch of a surface is nearer to an angle than a margin. */
int trb_form_is_near(const trb_form *form, int surface, double angle, double margin);

/* Rows of TRB_FORM_depth + 2 n_nodes numbers; none: all surfaces have their true form. Arrays belong to the memory. */
trb_status trb_form_read(trb_form *form, trb_memory *memory, int n_rollers, int n_nodes, const double *rows, int n_rows, int n_columns,
                         trb_message *message);

#endif
