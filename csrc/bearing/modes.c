#include "bearing/modes.h"

#include <math.h>

/* Coriolis forces below this share of the largest one are none. */
#define TRB_NO_CORIOLIS 1e-9

static void allocate(trb_modes *to, trb_memory *memory, size_t n_faces)
{
  const size_t n = (size_t)to->n;
  double     **of_modes[] = {&to->frequency, &to->damping, &to->mass, &to->per, &to->share, &to->yield};
  for (size_t i = 0; i < sizeof of_modes / sizeof of_modes[0]; i++) *of_modes[i] = trb_memory_zeros(memory, n, sizeof(double));
  to->coriolis = trb_memory_zeros(memory, n * n, sizeof *to->coriolis);
  to->first_coriolis = trb_memory_zeros(memory, n + 1, sizeof *to->first_coriolis);
  to->shapes = trb_memory_zeros(memory, n_faces * n * TRB_SHAPE_ROOM, sizeof *to->shapes);
  to->middle = trb_memory_zeros(memory, n_faces, sizeof *to->middle);
}

/* Modes of a ring of beams act on each other only where they have as many waves: the rest are rounding errors, and left out. */
static void set_coriolis(trb_modes *to, const double *forces, int n_columns)
{
  double largest = 0.0;
  for (int i = 0; i < to->n; i++)
    for (int k = 0; k < i; k++) largest = fmax(largest, fabs(forces[(size_t)i * (size_t)n_columns + (size_t)k]));
  int n = 0;
  for (int i = 0; i < to->n; i++) {
    to->first_coriolis[i] = n;
    for (int k = 0; k < to->n; k++) {
      const double force = forces[(size_t)i * (size_t)n_columns + (size_t)k];
      if (fabs(force) > TRB_NO_CORIOLIS * largest) to->coriolis[n++] = (trb_coriolis){k, force};
    }
  }
  to->first_coriolis[to->n] = n;
}

static trb_status check_row(const double *row, int mode, int n_columns, trb_message *message)
{
  for (int i = 0; i < n_columns; i++)
    if (!isfinite(row[i])) return trb_fail(message, TRB_ERR_INPUT, "mode %d of the cage: column %d is not finite", mode, i);
  if (!(row[TRB_MODE_frequency] > 0.0) || !(row[TRB_MODE_mass] > 0.0))
    return trb_fail(message, TRB_ERR_INPUT, "mode %d of the cage: frequency = %g rad/s and modal mass = %g kg must be > 0", mode,
                    row[TRB_MODE_frequency], row[TRB_MODE_mass]);
  if (!(row[TRB_MODE_damping] >= 0.0 && row[TRB_MODE_damping] < 1.0))
    return trb_fail(message, TRB_ERR_INPUT, "mode %d of the cage: damping = %g: must be >= 0 and < 1", mode, row[TRB_MODE_damping]);
  return TRB_OK;
}

trb_status trb_modes_read(trb_modes *to, trb_memory *memory, int n_slots, int n_faces, const double *rows, int n_modes, int n_columns,
                          trb_message *message)
{
  const int shapes_end = TRB_MODE_shapes + TRB_SHAPE * n_slots, columns = shapes_end + n_modes;
  if (n_columns != columns) return trb_fail(message, TRB_ERR_INPUT, "modes: %d columns needed, %d given", columns, n_columns);
  for (int i = 0; i < n_modes; i++) {
    const trb_status status = check_row(rows + (size_t)i * (size_t)n_columns, i, n_columns, message);
    if (status != TRB_OK) return status;
  }
  for (int i = 0; i < n_modes; i++)
    for (int k = 0; k <= i; k++) {
      const double one = rows[(size_t)i * (size_t)n_columns + (size_t)(shapes_end + k)];
      const double other = rows[(size_t)k * (size_t)n_columns + (size_t)(shapes_end + i)];
      if (one + other != 0.0)
        return trb_fail(message, TRB_ERR_INPUT, "modes %d and %d of the cage: Coriolis forces = %g and %g kg: must be opposite", i, k, one,
                        other);
    }
  to->n = n_modes;
  allocate(to, memory, (size_t)n_faces);
  if (memory->lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for %d modes of the cage", n_modes);
  for (int i = 0; i < n_modes; i++) {
    const double *row = rows + (size_t)i * (size_t)n_columns, w = row[TRB_MODE_frequency];
    to->frequency[i] = w;
    to->damping[i] = 2.0 * row[TRB_MODE_damping] * w;
    to->mass[i] = row[TRB_MODE_mass];
    to->per[i] = 1.0 / fmax(w, trb_least_mode_frequency);
    to->share[i] = w * to->per[i];
    to->yield[i] = 1.0 / (to->share[i] * to->mass[i]);
  }
  set_coriolis(to, rows + shapes_end, n_columns);
  return TRB_OK;
}
