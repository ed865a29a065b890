#include "bearing/ribs.h"

#include <math.h>

#include "laws/film.h"

static trb_status fill_rib(trb_model *m, int race, int end, trb_message *message)
{
  const trb_params   *p = &m->params;
  const trb_geometry *g = &m->geometry;
  trb_rib_place       place;
  const trb_status    status = trb_place_rib(p, g, race, end, &place, message);
  if (status != TRB_OK) return status;
  const double shape = place.ry / place.rx;
  trb_rib     *rib = &m->rib[race][end];
  *rib = (trb_rib){.face = trb_rib_face(&place, end),
                   .race = m->surfaces.race[race],
                   .end = m->surfaces.end[end],
                   .edge_low = p->rib.edge_low,
                   .edge_high = p->rib.edge_high,
                   .stiffness = place.stiffness,
                   .semi_axis_rolling = place.semi_rolling,
                   .semi_axis_across = place.semi_across,
                   .rx = place.rx,
                   .film_shape = p->effects.rib_film == TRB_RIB_FILM_NEEDLE ? trb_film_needle_shape(shape) : trb_film_point_shape(shape),
                   .film_rigid = p->effects.rib_film > 0.0 ? 0.0 : trb_film_point_rigid_factor(shape),
                   .roughness = p->roughness.rib};
  if (race == TRB_RACE_OUTER) rib->face.place += g->centre_plane; /* places of the outer ring are from the origin */
  return TRB_OK;
}

trb_status trb_ribs_fill(trb_model *m, trb_message *message)
{
  static const int of[][2] = {
      {TRB_RACE_INNER, TRB_END_LARGE}, {TRB_RACE_INNER, TRB_END_SMALL}, {TRB_RACE_OUTER, TRB_END_LARGE}, {TRB_RACE_OUTER, TRB_END_SMALL}};
  const int n = trb_has_cylinders(m) ? (int)(sizeof of / sizeof of[0]) : 1;
  for (int i = 0; i < n; i++) {
    const trb_status status = fill_rib(m, of[i][0], of[i][1], message);
    if (status != TRB_OK) return status;
  }
  return TRB_OK;
}

int trb_between_ribs(const trb_params *p)
{
  return (p->effects.back_rib > 0.0 || p->rib.outer > 0.0) && (p->effects.front_rib > 0.0 || p->rib.outer_front > 0.0);
}
