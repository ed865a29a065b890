#include "bearing/form.h"

#include <math.h>
#include <string.h>

#include "base/vec3.h"
#include "laws/smooth.h"

/* By which the steps of a patch may differ, over a step: they are differences of angles of a few radians. */
#define TRB_EVEN 1e-6

static double past(const trb_patch *p, double angle)
{
  const double off = fmod(angle - p->first, 2.0 * TRB_PI);
  return off < 0.0 ? off + 2.0 * TRB_PI : off;
}

int trb_form_at(const trb_form *form, int surface, double angle, int node, double *depth, double *slope)
{
  const size_t row = 2 * (size_t)form->n_nodes;
  int          found = 0;
  for (int i = 0; i < form->n; i++) {
    const trb_patch *p = &form->patches[i];
    if (p->surface != surface) continue;
    const double at = past(p, angle);
    if (!(at <= p->length)) continue;
    const int       k = (int)fmin(at / p->step, p->n - 2);
    const double   *a = p->rows + (size_t)k * row + node, *b = a + row;
    const trb_curve curve = trb_hermite(at / p->step - k, p->step, a[0], a[form->n_nodes], b[0], b[form->n_nodes]);
    *depth += curve.value;
    *slope += curve.slope;
    found = 1;
  }
  return found;
}

int trb_form_is_near(const trb_form *form, int surface, double angle, double margin)
{
  for (int i = 0; i < form->n; i++) {
    const trb_patch *p = &form->patches[i];
    if (p->surface == surface && past(p, angle + margin) <= p->length + 2.0 * margin) return 1;
  }
  return 0;
}

trb_form_scale trb_form_scale_of(const trb_form *form, int race)
{
  trb_form_scale least = {INFINITY, INFINITY};
  for (int i = 0; i < form->n; i++) {
    const trb_patch *p = &form->patches[i];
    if (p->surface == trb_form_of_race(race)) least.race = fmin(least.race, p->scale);
    else if (p->surface >= trb_form_of_roller(0, 0) && p->surface % 2 == race) least.roller = fmin(least.roller, p->scale);
  }
  return least;
}

static trb_status check_row(int n_rollers, const double *rows, int i, int n_columns, trb_message *message)
{
  const double *row = rows + (size_t)i * (size_t)n_columns, *before = row - n_columns;
  for (int c = 0; c < n_columns; c++)
    if (!isfinite(row[c])) return trb_fail(message, TRB_ERR_INPUT, "form, row %d: column %d is not finite", i, c);
  if (row[TRB_FORM_surface] != floor(row[TRB_FORM_surface]) || row[TRB_FORM_surface] < 0.0 ||
      row[TRB_FORM_surface] >= trb_form_of_roller(n_rollers, 0))
    return trb_fail(message, TRB_ERR_INPUT, "form, row %d: surface = %g: must be a whole number from 0 to %d", i, row[TRB_FORM_surface],
                    trb_form_of_roller(n_rollers, 0) - 1);
  if (!(row[TRB_FORM_scale] > 0.0))
    return trb_fail(message, TRB_ERR_INPUT, "form, row %d: scale = %g: must be > 0", i, row[TRB_FORM_scale]);
  if (i == 0 || row[TRB_FORM_patch] != before[TRB_FORM_patch]) return TRB_OK;
  if (row[TRB_FORM_surface] != before[TRB_FORM_surface] || !(row[TRB_FORM_angle] > before[TRB_FORM_angle]))
    return trb_fail(message, TRB_ERR_INPUT, "form, row %d: a patch has one surface, and ascending angles", i);
  return TRB_OK;
}

/* Samples of the patch that begins at a row. */
static int samples(const double *rows, int first, int n_rows, int n_columns)
{
  const double *row = rows + (size_t)first * (size_t)n_columns;
  int           n = 1;
  while (first + n < n_rows && row[(size_t)n * (size_t)n_columns + TRB_FORM_patch] == row[TRB_FORM_patch]) n++;
  return n;
}

static trb_status read_patch(trb_form *form, const double *rows, int first, int n, int n_columns, trb_message *message)
{
  const double *row = rows + (size_t)first * (size_t)n_columns, *last = row + (size_t)(n - 1) * (size_t)n_columns;
  trb_patch    *p = &form->patches[form->n];
  if (n < 3) return trb_fail(message, TRB_ERR_INPUT, "form, row %d: a patch has %d samples: must have at least 3", first, n);
  *p = (trb_patch){.surface = (int)row[TRB_FORM_surface],
                   .first = row[TRB_FORM_angle],
                   .length = last[TRB_FORM_angle] - row[TRB_FORM_angle],
                   .scale = row[TRB_FORM_scale],
                   .n = n,
                   .rows = form->rows + (size_t)first * 2 * (size_t)form->n_nodes};
  /* all round: by rounding no angle lies beyond its end */
  if (fabs(p->length - 2.0 * TRB_PI) < TRB_EVEN) p->length = 2.0 * TRB_PI;
  p->step = p->length / (n - 1);
  for (int i = 0; i < n; i++) {
    const double *from = row + (size_t)i * (size_t)n_columns;
    if (!(fabs(from[TRB_FORM_angle] - (p->first + i * p->step)) <= TRB_EVEN * p->step))
      return trb_fail(message, TRB_ERR_INPUT, "form, row %d: angles of a patch must be equally spaced", first + i);
    memcpy(p->rows + (size_t)i * 2 * (size_t)form->n_nodes, from + TRB_FORM_depth, 2 * (size_t)form->n_nodes * sizeof *rows);
  }
  if (p->length > (1.0 + TRB_EVEN) * 2.0 * TRB_PI)
    return trb_fail(message, TRB_ERR_INPUT, "form, row %d: a patch is longer than a turn", first);
  form->n++;
  return TRB_OK;
}

trb_status trb_form_read(trb_form *form, trb_memory *memory, int n_rollers, int n_nodes, const double *rows, int n_rows, int n_columns,
                         trb_message *message)
{
  trb_status status = TRB_OK;
  int        n_patches = 0;
  if (n_rows == 0) return TRB_OK;
  if (n_columns != TRB_FORM_depth + 2 * n_nodes)
    return trb_fail(message, TRB_ERR_INPUT, "form: %d columns needed, %d given", TRB_FORM_depth + 2 * n_nodes, n_columns);
  for (int i = 0; i < n_rows && status == TRB_OK; i++) status = check_row(n_rollers, rows, i, n_columns, message);
  if (status != TRB_OK) return status;
  for (int i = 0; i < n_rows; i += samples(rows, i, n_rows, n_columns)) n_patches++;
  *form = (trb_form){.n_nodes = n_nodes};
  form->patches = trb_memory_zeros(memory, (size_t)n_patches, sizeof *form->patches);
  form->rows = trb_memory_zeros(memory, (size_t)n_rows * 2 * (size_t)n_nodes, sizeof *form->rows);
  if (memory->lacks) return trb_fail(message, TRB_ERR_MEMORY, "out of memory for the form of surfaces");
  for (int i = 0; i < n_rows && status == TRB_OK;) {
    const int n = samples(rows, i, n_rows, n_columns);
    status = read_patch(form, rows, i, n, n_columns, message);
    i += n;
  }
  return status;
}
