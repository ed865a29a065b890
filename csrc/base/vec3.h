/* Vectors and rotations, inline. A frame is three orthonormal axes, written in the coordinates of its parent. */
#ifndef TRB_BASE_VEC3_H
#define TRB_BASE_VEC3_H

#include <math.h>

typedef struct trb_vec3 {
  double x, y, z;
} trb_vec3;

typedef struct trb_frame {
  trb_vec3 n; /* first axis */
  trb_vec3 t; /* second axis */
  trb_vec3 a; /* third axis */
} trb_frame;

static inline trb_vec3 trb_v(double x, double y, double z) { return (trb_vec3){x, y, z}; }
static inline trb_vec3 trb_add(trb_vec3 u, trb_vec3 v) { return trb_v(u.x + v.x, u.y + v.y, u.z + v.z); }
static inline trb_vec3 trb_sub(trb_vec3 u, trb_vec3 v) { return trb_v(u.x - v.x, u.y - v.y, u.z - v.z); }
static inline trb_vec3 trb_scale(double s, trb_vec3 v) { return trb_v(s * v.x, s * v.y, s * v.z); }
static inline double   trb_dot(trb_vec3 u, trb_vec3 v) { return u.x * v.x + u.y * v.y + u.z * v.z; }
static inline double   trb_norm(trb_vec3 v) { return sqrt(trb_dot(v, v)); }

/* u + s v */
static inline trb_vec3 trb_axpy(trb_vec3 u, double s, trb_vec3 v) { return trb_v(u.x + s * v.x, u.y + s * v.y, u.z + s * v.z); }

static inline trb_vec3 trb_cross(trb_vec3 u, trb_vec3 v)
{
  return trb_v(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
}

/* Turn v about z by the angle whose cosine and sine are given. */
static inline trb_vec3 trb_turn_z(trb_vec3 v, double cosine, double sine)
{
  return trb_v(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z);
}

/* Coordinates in a frame -> coordinates in its parent. */
static inline trb_vec3 trb_from_frame(const trb_frame *f, trb_vec3 v)
{
  return trb_v(f->n.x * v.x + f->t.x * v.y + f->a.x * v.z, f->n.y * v.x + f->t.y * v.y + f->a.y * v.z,
               f->n.z * v.x + f->t.z * v.y + f->a.z * v.z);
}

/* Coordinates in the parent -> coordinates in a frame. */
static inline trb_vec3 trb_to_frame(const trb_frame *f, trb_vec3 v) { return trb_v(trb_dot(f->n, v), trb_dot(f->t, v), trb_dot(f->a, v)); }

/* Frame R_y(tilt) R_x(-skew): a = (sin tilt cos skew, sin skew, cos tilt cos skew). It does not spin with its body. */
static inline trb_frame trb_tilted_frame(double skew, double tilt)
{
  const double cs = cos(skew), ss = sin(skew), ct = cos(tilt), st = sin(tilt);
  return (trb_frame){{ct, 0.0, -st}, {-ss * st, cs, -ss * ct}, {cs * st, ss, cs * ct}};
}

/* Axes of `inner`, written in the parent of `outer`. */
static inline trb_frame trb_compose(const trb_frame *outer, const trb_frame *inner)
{
  return (trb_frame){trb_from_frame(outer, inner->n), trb_from_frame(outer, inner->t), trb_from_frame(outer, inner->a)};
}

#endif
