/* A face of a body that deforms: it moves by u and turns by r about its middle o as a rigid one (docs/theory/cage.md#an-elastic-cage). A roller
 * is seen from it as from the face at rest if the roller is moved the other way, so contacts know nothing of the deformation. */
#ifndef TRB_CONTACT_DEFORMED_H
#define TRB_CONTACT_DEFORMED_H

#include "contact/contact.h"

typedef struct trb_face_shift {
  const double *shapes;     /* of the face in each mode */
  trb_vec3      middle;     /* o, in the frame of its pocket at rest, as all that follows, m */
  trb_vec3      shift;      /* u, m */
  trb_vec3      turn;       /* r, rad */
  trb_vec3      shift_rate; /* m/s */
  trb_vec3      turn_rate;  /* angular velocity, rad/s */
} trb_face_shift;

static inline void trb_sum_shapes(const trb_deformed *deformed, const double *shapes, const double *amplitude, trb_vec3 *shift,
                                  trb_vec3 *turn)
{
  double sum[TRB_SHAPE_ROOM];
  deformed->kernels->sum(shapes, deformed->modes->n, amplitude, sum);
  *shift = trb_v(sum[0], sum[1], sum[2]);
  *turn = trb_v(sum[3], sum[4], sum[5]);
}

/* Its place. */
static inline void trb_face_place(const trb_deformed *deformed, int face, trb_face_shift *s)
{
  s->shapes = trb_shapes_of(deformed->modes, face);
  s->middle = deformed->modes->middle[face];
  trb_sum_shapes(deformed, s->shapes, deformed->amplitude, &s->shift, &s->turn);
}

/* Its motion, too. The angular velocity of a turn r is r' + r x r'/2, up to terms of r squared. */
static inline void trb_face_motion(const trb_deformed *deformed, trb_face_shift *s)
{
  trb_vec3 rate;
  trb_sum_shapes(deformed, s->shapes, deformed->rate, &s->shift_rate, &rate);
  s->turn_rate = trb_axpy(rate, 0.5, trb_cross(s->turn, rate));
}

/* A vector as seen from the face, and back: a rotation up to terms of r cubed. */
static inline trb_vec3 trb_seen_from(const trb_face_shift *s, trb_vec3 v)
{
  const trb_vec3 once = trb_cross(s->turn, v);
  return trb_axpy(trb_sub(v, once), 0.5, trb_cross(s->turn, once));
}

static inline trb_vec3 trb_seen_back(const trb_face_shift *s, trb_vec3 v)
{
  const trb_vec3 once = trb_cross(s->turn, v);
  return trb_axpy(trb_add(v, once), 0.5, trb_cross(s->turn, once));
}

/* A point. */
static inline trb_vec3 trb_point_from(const trb_face_shift *s, trb_vec3 point)
{
  return trb_add(s->middle, trb_seen_from(s, trb_sub(trb_sub(point, s->middle), s->shift)));
}

/* Adds what a wrench on the face does to the modes; moment about a point of the body at rest. */
static inline void trb_push_modes(const trb_deformed *deformed, const trb_face_shift *s, trb_vec3 point, const trb_wrench *on_face)
{
  const trb_vec3 arm = trb_sub(trb_sub(point, s->middle), s->shift), f = on_face->force;
  const trb_vec3 about = trb_add(on_face->moment, trb_cross(arm, f)), m = trb_axpy(about, -0.5, trb_cross(s->turn, about));
  const double   load[TRB_SHAPE_ROOM] = {f.x, f.y, f.z, m.x, m.y, m.z};
  deformed->kernels->push(s->shapes, deformed->modes->n, load, deformed->force);
}

/* Adds the slopes of a face to those of its modes. slopes: of the face; place: of the roller's centre of mass. */
void trb_slopes_of_modes(const trb_deformed *deformed, const trb_face_shift *s, const trb_slopes *slopes, trb_vec3 place,
                         trb_modal_slopes *to);

#endif
