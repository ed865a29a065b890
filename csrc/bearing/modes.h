/* Natural modes of an elastic cage, as data (docs/theory/cage.md#an-elastic-cage). The displacement of a face of a pocket is the sum over the
 * modes of their shapes there times their amplitudes. Shapes are those of the free cage without its rigid motions: they are orthogonal to
 * these in mass, so the rigid motion is that of the mean axes. */
#ifndef TRB_BEARING_MODES_H
#define TRB_BEARING_MODES_H

#include <stddef.h>

#include "base/status.h"
#include "base/vec3.h"

/* What a mode is as a row of numbers: its angular frequency (rad/s), its damping ratio (1), its modal mass (kg), then its shape at each slot of
 * each pocket: displacement of the middle of the face's outline (1) and rotation of the face (1/m), in the axes n, t, a of the pocket; last
 * the Coriolis force on it per rate of each mode and turn of the cage about its axis (kg), which does no work: row i at j is minus row j at
 * i. */
enum { TRB_MODE_frequency, TRB_MODE_damping, TRB_MODE_mass, TRB_MODE_shapes };

enum { TRB_SHAPE = 6, TRB_MOST_MODES = 100 };

typedef struct trb_modes {
  int       n;         /* 0: the cage is rigid */
  double   *frequency; /* angular, rad/s */
  double   *damping;   /* rate of decay of the energy, twice the damping ratio times the angular frequency, 1/s */
  double   *mass;      /* modal, kg */
  double    fastest;   /* the largest frequency, rad/s */
  double   *share;     /* frequency over the largest one */
  double   *yield;     /* one over share and mass, 1/kg */
  double   *coriolis;  /* [mode][mode]: force on the second one, kg */
  double   *shapes;    /* [face of the model][mode][TRB_SHAPE] */
  trb_vec3 *middle;    /* of each face's outline, in the frame of its pocket, m */
} trb_modes;

static inline const double *trb_shapes_of(const trb_modes *modes, int face)
{
  return modes->shapes + (size_t)face * (size_t)modes->n * TRB_SHAPE;
}

void trb_modes_free(trb_modes *modes);

#endif
