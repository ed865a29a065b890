#include "system/system.h"

const trb_body *trb_state_body(const trb_system *system, int index, int *coordinate)
{
  for (int b = 0; b < system->n_bodies; b++) {
    const trb_body *body = &system->bodies[b];
    *coordinate = index - body->first;
    if (body->first >= 0 && *coordinate >= 0 && *coordinate < body->size) return body;
  }
  return NULL;
}

trb_tolerance trb_state_tolerance(const trb_system *system, int index)
{
  int             coordinate;
  const trb_body *body;
  const int       own = index - trb_state_roller(system, 0);
  if (own >= 0 && own < system->model->n_rollers * TRB_ROLLER_SIZE) return trb_roller_coordinates[own % TRB_ROLLER_SIZE].tolerance;
  body = trb_state_body(system, index, &coordinate);
  return body != NULL ? body->coordinates[coordinate].tolerance : TRB_TOL_QUADRATURE;
}

double trb_system_shaft_speed(const trb_system *system, const trb_drive *drive, const double *y)
{
  const trb_body *body = &system->bodies[system->driven];
  trb_ring_pose   ring;
  if (body->size == 0 || body->kind->ring == NULL) return drive->shaft_speed;
  body->kind->ring(system->model, body, drive, y + body->first, &ring);
  return trb_dot(ring.omega, ring.axis);
}

int trb_system_seats(const trb_system *system)
{
  int seats = 0;
  for (int i = 0; i < system->n_pairs; i++) seats |= system->pairs[i].kind->seats && system->pairs[i].on;
  return seats;
}

static const char *mechanism_name(int by)
{
  static const char *const names[TRB_N_MECHANISMS] = {"sliding", "rolling", "the rolling film's pressure", "damping", "a film"};
  return names[by];
}

/* Bodies and parameters of a pair are those of its surfaces. */
static trb_status join(const trb_system *s, trb_pair *pair, trb_message *message)
{
  for (int side = 0; side < 2; side++) {
    const int at = pair->surface[side];
    if (at < 0 || at >= s->n_surfaces || s->surfaces[at].shape != pair->kind->shape[side])
      return trb_fail(message, TRB_ERR_INPUT, "pair %s: surface %d does not have the shape that a pair of the kind '%s' needs there",
                      pair->name, at, pair->kind->name);
    if (s->surfaces[at].name == NULL)
      return trb_fail(message, TRB_ERR_INPUT, "pair %s: surface %d has no row in this system", pair->name, at);
    if (s->surfaces[at].body < TRB_ROLLERS || s->surfaces[at].body >= s->n_bodies)
      return trb_fail(message, TRB_ERR_INPUT, "surface %s: body %d: must be from %d (the rollers) to %d", s->surfaces[at].name,
                      s->surfaces[at].body, TRB_ROLLERS, s->n_bodies - 1);
  }
  pair->a = s->surfaces[pair->surface[0]].body;
  pair->b = s->surfaces[pair->surface[1]].body;
  pair->own_a = s->surfaces[pair->surface[0]].is;
  pair->own = s->surfaces[pair->surface[1]].is;
  if (pair->kind->pace == TRB_PACE_FAST && (pair->b < 0 || s->bodies[pair->b].size == 0 || s->bodies[pair->b].kind->motion == NULL))
    return trb_fail(message, TRB_ERR_INPUT, "pair %s: a pair that comes and goes with impacts needs a body with coordinates", pair->name);
  /* a roller's tangent knows what a slow pair does to a ring only */
  if (pair->a == TRB_ROLLERS && pair->kind->pace == TRB_PACE_SLOW && pair->b >= 0 && s->bodies[pair->b].size > 0 &&
      s->bodies[pair->b].kind->ring == NULL)
    return trb_fail(message, TRB_ERR_INPUT,
                    "pair %s: its load would be lost on %s, which has coordinates and is no ring: only pairs that come and go with "
                    "impacts, and pairs without a roller, move such a body",
                    pair->name, s->bodies[pair->b].name);
  return TRB_OK;
}

/* A contact of a roller with a ring is followed by tangents and looked at for peaks, which hold as long as bounds say so. */
static trb_status check_contact(const trb_pair *pair, trb_message *message)
{
  const trb_pair_kind *kind = pair->kind;
  if (kind->contact != TRB_CONTACT_NONE && kind->pace == TRB_PACE_SLOW && (!kind->arms || !kind->look))
    return trb_fail(message, TRB_ERR_INPUT, "pair %s: its kind '%s' is a contact of a roller with a ring, and must give arms and look",
                    pair->name, kind->name);
  return TRB_OK;
}

/* Where a roller's part of the right-hand side has no room for a loss, the loss would be dropped. */
static trb_status check_books(const trb_system *s, const trb_pair *pair, trb_message *message)
{
  const int room = pair->a == TRB_ROLLERS ? TRB_N_ROLLER_LOSSES : s->model->n_losses;
  for (int by = 0; by < TRB_N_MECHANISMS; by++) {
    const int loses = (pair->kind->mechanisms & TRB_LOSES(by)) != 0, loss = pair->books.loss[by];
    if (loses && !(loss >= 1 && loss <= room && loss <= s->model->n_losses))
      return trb_fail(message, TRB_ERR_INPUT, "pair %s loses energy by %s, which is booked nowhere", pair->name, mechanism_name(by));
    if (!loses && (loss != 0 || pair->books.torque[by] != 0))
      return trb_fail(message, TRB_ERR_INPUT, "pair %s books what is lost by %s, and loses nothing by it", pair->name, mechanism_name(by));
  }
  return TRB_OK;
}

trb_status trb_system_finish(trb_system *s, trb_message *message)
{
  int contacts = 0, slots = 0, n_rollers = s->model->n_rollers;
  s->n_moving = 0;
  s->spacer = -1;
  s->layout = (trb_layout){.n_rollers = n_rollers, .hub = n_rollers * TRB_ROLLER_SIZE};
  for (int b = 0; b < s->n_bodies; b++) {
    trb_body *body = &s->bodies[b];
    if (body->kind == NULL) return trb_fail(message, TRB_ERR_INPUT, "body %d has no row in this system", b);
    if (body->size == 0) body->size = body->kind->size, body->coordinates = body->kind->coordinates;
    body->first = body->size > 0 ? trb_state_main_size(s) : -1;
    s->layout.hub_width += body->size;
    if (body->kind->spacing != NULL) s->spacer = b;
    if (body->size > 0 && body->kind->ring != NULL) {
      if (s->n_moving == TRB_MOST_MOVING_RINGS)
        return trb_fail(message, TRB_ERR_INPUT, "body %s: at most %d rings may have coordinates", body->name, TRB_MOST_MOVING_RINGS);
      s->moving[s->n_moving++] = b;
    }
    if (body->kind->loses && !(body->loss >= 1 && body->loss <= s->model->n_losses))
      return trb_fail(message, TRB_ERR_INPUT, "body %s loses energy, which is booked nowhere", body->name);
    if (!body->kind->loses && body->loss != 0)
      return trb_fail(message, TRB_ERR_INPUT, "body %s books a loss, and loses nothing", body->name);
  }
  for (int i = 0; i < s->n_pairs; i++) {
    trb_pair  *pair = &s->pairs[i];
    trb_status status = join(s, pair, message);
    if (status == TRB_OK) status = check_contact(pair, message);
    if (status == TRB_OK && pair->on) status = check_books(s, pair, message);
    if (status != TRB_OK) return status;
    pair->contact = contacts;
    contacts += pair->kind->contact != TRB_CONTACT_NONE;
    pair->slots = slots;
    slots += pair->kind->shape[1] == TRB_SHAPE_POCKETS ? n_rollers * s->model->n_slots : 0;
  }
  s->layout.spin = trb_state_main_size(s);
  s->layout.quadrature = s->layout.spin + n_rollers;
  s->layout.size = s->layout.quadrature + trb_n_quadratures(s);
  return TRB_OK;
}
