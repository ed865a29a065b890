#include "system/assembly.h"

/* The body of the first system that a carried body is part of: the one with the same number. */
static trb_status share(trb_assembly *a, int member, int number, trb_message *message)
{
  trb_body       *body = &a->members[member].bodies[number];
  const trb_body *carrier = &a->members[0].bodies[number];
  if (member == 0)
    return trb_fail(message, TRB_ERR_INPUT, "bearing 1, %s: carried by a body of another bearing: only bearings after the first can be",
                    body->name);
  if (carrier->kind != body->kind || carrier->size != body->size)
    return trb_fail(message, TRB_ERR_INPUT, "bearing %d, %s: carried by the %s of the first bearing, which is no free ring", member + 1,
                    body->name, carrier->name);
  body->first = carrier->first;
  return TRB_OK;
}

trb_status trb_assembly_make(const trb_system *const *systems, int n, trb_assembly *a, trb_message *message)
{
  trb_layout at = {0};
  if (n < 1 || n > TRB_MOST_MEMBERS)
    return trb_fail(message, TRB_ERR_INPUT, "%d bearings: an assembly has from 1 to %d", n, TRB_MOST_MEMBERS);
  a->n = n;
  for (int k = 0; k < n; k++) {
    a->members[k] = *systems[k];
    a->members[k].layout.leaf = at.n_rollers;
    at.n_rollers += systems[k]->model->n_rollers;
  }
  at.hub = at.n_rollers * TRB_ROLLER_SIZE;
  for (int k = 0; k < n; k++)
    for (int b = 0; b < a->members[k].n_bodies; b++) {
      trb_body *body = &a->members[k].bodies[b];
      if (body->size == 0) continue;
      if (body->carried) {
        const trb_status status = share(a, k, b, message);
        if (status != TRB_OK) return status;
        continue;
      }
      body->first = at.hub + at.hub_width;
      at.hub_width += body->size;
    }
  if (at.hub_width > TRB_MOST_HUB)
    return trb_fail(message, TRB_ERR_INPUT, "%d coordinates of rings and cages: at most %d; take fewer modes of elastic cages",
                    at.hub_width, TRB_MOST_HUB);
  at.size = at.hub + at.hub_width;
  for (int k = 0; k < n; k++) {
    a->members[k].layout.spin = at.size;
    at.size += a->members[k].model->n_rollers;
  }
  for (int k = 0; k < n; k++) {
    a->members[k].layout.quadrature = at.size;
    at.size += trb_n_quadratures(&a->members[k]);
  }
  for (int k = 0; k < n; k++) {
    trb_layout *own = &a->members[k].layout;
    for (int b = 0; b < a->members[k].n_bodies; b++) a->members[k].bodies[b].carrier_quadrature = a->members[0].layout.quadrature;
    own->n_rollers = at.n_rollers;
    own->hub = at.hub;
    own->hub_width = at.hub_width;
    own->size = at.size;
  }
  return TRB_OK;
}

const trb_system *trb_assembly_owner(const trb_assembly *a, int index)
{
  for (int k = 0; k < a->n; k++) {
    const trb_system *s = &a->members[k];
    int               coordinate;
    if (index < trb_state_hub(s)) {
      if (index < trb_state_roller(s, s->model->n_rollers)) return s;
    } else if (trb_state_body(s, index, &coordinate) != NULL) return s;
  }
  return NULL;
}
