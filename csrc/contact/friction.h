/* Friction of single points (roller ends, ribs, pockets), shared by the pairs that are not raceways. */
#ifndef TRB_CONTACT_FRICTION_H
#define TRB_CONTACT_FRICTION_H

#include "contact/contact.h"
#include "laws/traction.h"

/* A point of contact between a roller and another body, both in the same coordinates. */
typedef struct trb_touch {
  trb_vec3 sliding; /* tangential velocity, roller minus other, m/s */
  double   speed;   /* its magnitude, guarded, m/s */
  double   rate;    /* rate of the interference, m/s */
} trb_touch;

/* normal: from the roller into the other body. */
static inline trb_touch trb_touching(trb_vec3 roller_velocity, trb_vec3 other_velocity, trb_vec3 normal)
{
  const trb_vec3 relative = trb_sub(roller_velocity, other_velocity);
  trb_touch      touch;
  touch.rate = trb_dot(relative, normal);
  touch.sliding = trb_axpy(relative, -touch.rate, normal);
  touch.speed = sqrt(trb_dot(touch.sliding, touch.sliding) + TRB_SLIDING_GUARD * TRB_SLIDING_GUARD);
  return touch;
}

static inline double trb_coulomb_coefficient(const trb_params *p, double speed)
{
  return p->friction.dry_friction * speed / sqrt(speed * speed + p->friction.coulomb_speed * p->friction.coulomb_speed);
}

/* (6) with the slide-roll ratio of surfaces that do not roll (docs/theory/contacts.md#bounded-faces-of-pockets), or Coulomb's law in a
 * dry scene. */
static inline double trb_sliding_coefficient(const trb_model *m, double speed)
{
  const trb_params *p = &m->params;
  if (p->effects.lubrication == TRB_LUBRICATION_DRY) return trb_coulomb_coefficient(p, speed);
  return trb_friction_boundary(trb_slide_roll_cage(speed, p->friction.cage_entrainment_speed), p->friction.boundary_limit,
                               p->friction.boundary_slope, p->friction.boundary_decay);
}

/* Normal damping, never pulling (docs/theory/contacts.md#normal-damping). */
static inline double trb_damped(double load, double coefficient, double rate) { return load * trb_max(1.0 + coefficient * rate, 0.0); }

/* What presses at a point and drags there. */
typedef struct trb_push {
  double   load;  /* with damping, N */
  double   mu;    /* friction coefficient */
  double   drag;  /* friction over sliding speed, N s/m */
  trb_vec3 force; /* on the roller, N */
} trb_push;

/* elastic: load without damping; damping: its coefficient; factor: of the friction coefficient; lost: powers, to which those of sliding and of
 * damping are added. */
static inline trb_push trb_push_at(const trb_model *m, const trb_touch *touch, trb_vec3 normal, double elastic, double damping,
                                   double factor, double *lost)
{
  const double load = trb_damped(elastic, damping, touch->rate),
               mu = m->pocket_friction ? factor * trb_sliding_coefficient(m, touch->speed) : 0.0;
  const double drag = load * mu / touch->speed;
  lost[TRB_BY_SLIDING] += drag * trb_dot(touch->sliding, touch->sliding);
  lost[TRB_BY_DAMPING] += (load - elastic) * touch->rate;
  return (trb_push){load, mu, drag, trb_axpy(trb_scale(-load, normal), -drag, touch->sliding)};
}

#endif
