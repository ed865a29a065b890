#include "stepping/vectors.h"

#include <string.h>

#include "base/variant.h"
#include "stepping/sundials_context.h"

typedef void use_function(N_Vector v);

#define VARIANT(name) trb_vector_use_##name,
static use_function *const variants[] = {TRB_VARIANTS(VARIANT)};

trb_body_entries trb_body_entries_of(const trb_assembly *assembly)
{
  trb_body_entries entries = {.n_rollers = assembly->members[0].layout.n_rollers};
  for (int k = 0; k < assembly->n; k++)
    for (int b = 0; b < assembly->members[k].n_bodies; b++) {
      const trb_body *body = &assembly->members[k].bodies[b];
      if (body->size > 0 && !body->carried) entries.size[entries.n_bodies++] = body->size;
    }
  return entries;
}

static N_Vector clone(N_Vector v)
{
  const sunindextype n = NV_LENGTH_S(v);
  NV_LENGTH_S(v) = n + TRB_VECTOR_ROOM;
  N_Vector made = N_VClone_Serial(v);
  NV_LENGTH_S(v) = n;
  if (made == NULL) return NULL;
  NV_LENGTH_S(made) = n;
  memcpy(NV_DATA_S(made) + n, NV_DATA_S(v) + n, sizeof(trb_body_entries));
  return made;
}

N_Vector trb_vector_over(double *values, int n, const trb_body_entries *entries, int variant, SUNContext context)
{
  N_Vector v = trb_sundials_has_room(1) ? N_VMake_Serial(n, values, context) : NULL;
  if (v == NULL) return NULL;
  memcpy(values + n, entries, sizeof *entries);
  v->ops->nvclone = clone;
  variants[variant](v);
  return v;
}
