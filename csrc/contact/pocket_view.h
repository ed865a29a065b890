/* What the files of a roller in its pocket share: both bodies as seen from the pocket, a point of contact, and sums over a face. */
#ifndef TRB_CONTACT_POCKET_VIEW_H
#define TRB_CONTACT_POCKET_VIEW_H

#include "contact/friction.h"

/* Roller and cage in the frame of the pocket. Velocities and sums are filled only where they may touch. */
typedef struct trb_pocket_view {
  const trb_pockets *pockets;                      /* the row */
  trb_frame          axes;                         /* pocket axes, in the roller's cylindrical frame */
  trb_vec3           x;                            /* roller's centre of mass, from the pocket's origin */
  trb_vec3           a;                            /* roller's axis */
  trb_vec3           cage;                         /* cage's centre of mass, from the pocket's origin */
  trb_vec3           v, omega, cage_v, cage_omega; /* velocities of roller and cage, m/s and rad/s */
  trb_vec3           force, moment;                /* on the roller, about its centre of mass */
  trb_vec3           cage_force, cage_moment;      /* on the cage, about its centre of mass */

  trb_slopes *slopes; /* or NULL */
} trb_pocket_view;

/* What a face carries. */
typedef struct trb_pocket_sums {
  double force, friction; /* magnitudes summed over the face's nodes, N */
  double deepest;         /* largest interference, m */
} trb_pocket_sums;

/* A point of contact. */
typedef struct trb_pocket_touch {
  trb_vec3 point, normal; /* m; from the roller into the face */
  double   interference;  /* m */
  double   elastic;       /* load without damping, N */
  double   exponent;      /* of the interference in it */
  trb_vec3 carried;       /* part of the arm that turns with the roller while the normal stays, m; or */
  int      on_end;        /* point of the face on the roller's end: the normal turns with the roller, the point stays */
} trb_pocket_touch;

/* How the surfaces move there. */
static inline trb_touch trb_pocket_touching(const trb_pocket_view *p, const trb_pocket_touch *c)
{
  return trb_touching(trb_add(p->v, trb_cross(p->omega, trb_sub(c->point, p->x))),
                      trb_add(p->cage_v, trb_cross(p->cage_omega, trb_sub(c->point, p->cage))), c->normal);
}

static inline void trb_add_slope(trb_wrench *w, trb_vec3 arm, trb_vec3 force)
{
  w->force = trb_add(w->force, force);
  w->moment = trb_add(w->moment, trb_cross(arm, force));
}

/* Adds what motion k does to the force by moving its point of attack and by turning it. */
static inline void trb_add_carried(trb_wrench *w, int k, trb_vec3 unit, const trb_pocket_touch *c, trb_vec3 arm, trb_vec3 force, double q)
{
  if (c->on_end && k >= 3) trb_add_slope(w, arm, trb_scale(-q, trb_cross(unit, c->normal)));
  else if (c->on_end) w->moment = trb_sub(w->moment, trb_cross(unit, force));
  else if (k >= 3) w->moment = trb_add(w->moment, trb_cross(trb_cross(unit, c->carried), force));
}

/* Adds the wrench of the film of a slice of the flank, whose point of contact is given. radius, width: of the slice, m. */
void trb_pocket_push_film(const trb_model *m, trb_pocket_view *p, const trb_pocket_touch *c, double radius, double width,
                          trb_counters *counters, trb_load *load, trb_pocket_sums *sums);

#endif
