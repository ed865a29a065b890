/* Natural modes of an elastic cage, as data (docs/theory/cage.md#an-elastic-cage). The displacement of a face of a pocket is the sum over the
 * modes of their shapes there times their amplitudes. Shapes are those of the free cage without its rigid motions: they are orthogonal to
 * these in mass, so the rigid motion is that of the mean axes. */
#ifndef TRB_BEARING_MODES_H
#define TRB_BEARING_MODES_H

#include "base/memory.h"
#include "base/status.h"
#include "base/vec3.h"

/* What a mode is as a row of numbers: its angular frequency (rad/s), its damping ratio (1), its modal mass (kg), then its shape at each slot of
 * each pocket: displacement of the middle of the face's outline (1) and rotation of the face (1/m), in the axes n, t, a of the pocket; last
 * the Coriolis force on it per rate of each mode and turn of the cage about its axis (kg), which does no work: row i at j is minus row j at
 * i. */
enum { TRB_MODE_frequency, TRB_MODE_damping, TRB_MODE_mass, TRB_MODE_shapes };

/* A mode's shape at a face, and how much room it takes; TRB_SHAPE_ROOM: padded by zeros, so that loops over it have no remainder. */
enum { TRB_SHAPE = 6, TRB_SHAPE_ROOM = 8, TRB_MOST_MODES = 100 };

/* The least angular frequency that makes a velocity of an amplitude, rad/s (body/elastic_cage.h): with the tolerances that users have, an
 * amplitude is then integrated to twenty times the tolerance of positions at most. */
static const double trb_least_mode_frequency = 1.7e4;

/* Coriolis force by a mode over its rate and the turn of the cage, kg. */
typedef struct trb_coriolis {
  int    by;
  double force;
} trb_coriolis;

typedef struct trb_modes {
  int           n;              /* 0: the cage is rigid */
  double       *frequency;      /* angular, rad/s */
  double       *damping;        /* rate of decay of the energy, twice the damping ratio times the angular frequency, 1/s */
  double       *mass;           /* modal, kg */
  double       *per;            /* amplitude for a unit of its coordinate, s */
  double       *share;          /* frequency over the one that makes a velocity of its amplitude: 1, or less for slow modes */
  double       *yield;          /* one over share and mass, 1/kg */
  double       *shapes;         /* [face of the model][mode][TRB_SHAPE_ROOM] */
  trb_vec3     *middle;         /* of each face's outline, in the frame of its pocket, m */
  trb_coriolis *coriolis;       /* on one mode after the other */
  int          *first_coriolis; /* [mode]: of those on it; one more: their number */
} trb_modes;

static inline const double *trb_shapes_of(const trb_modes *modes, int face)
{
  return modes->shapes + (size_t)face * (size_t)modes->n * TRB_SHAPE_ROOM;
}

/* Modes from rows of TRB_MODE_shapes + 6 n_slots + n_modes numbers, n_slots of all pockets together, in arrays of a memory; shapes and
 * middles of the faces are left at zero. */
trb_status trb_modes_read(trb_modes *modes, trb_memory *memory, int n_slots, int n_faces, const double *rows, int n_modes, int n_columns,
                          trb_message *message);

#endif
