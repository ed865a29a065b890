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

/* Cosine and sine of an angle. */
typedef struct trb_angle {
  double cosine, sine;
} trb_angle;

/* Small angles by their series, which are quicker than the library's functions and as exact: below a quarter the first terms left out are less
 * than 1e-18 of the result. */
static inline trb_angle trb_angle_of(double angle)
{
  const double q = angle * angle;
  if (!(q < 0.0625)) return (trb_angle){cos(angle), sin(angle)};
  const double even = 1.0 / 24.0 + q * (-1.0 / 720.0 + q * (1.0 / 40320.0 + q * (-1.0 / 3628800.0 + q * (1.0 / 479001600.0))));
  const double odd = -1.0 / 6.0 + q * (1.0 / 120.0 + q * (-1.0 / 5040.0 + q * (1.0 / 362880.0 + q * (-1.0 / 39916800.0))));
  return (trb_angle){1.0 + q * (-0.5 + q * even), angle + angle * q * odd};
}

static inline trb_angle trb_angle_sum(trb_angle a, trb_angle b)
{
  return (trb_angle){a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
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
static inline trb_frame trb_turned_frame(trb_angle skew, trb_angle tilt)
{
  const double cs = skew.cosine, ss = skew.sine, ct = tilt.cosine, st = tilt.sine;
  return (trb_frame){{ct, 0.0, -st}, {-ss * st, cs, -ss * ct}, {cs * st, ss, cs * ct}};
}

static inline trb_frame trb_tilted_frame(double skew, double tilt) { return trb_turned_frame(trb_angle_of(skew), trb_angle_of(tilt)); }

/* Axes of `inner`, written in the parent of `outer`. */
static inline trb_frame trb_compose(const trb_frame *outer, const trb_frame *inner)
{
  return (trb_frame){trb_from_frame(outer, inner->n), trb_from_frame(outer, inner->t), trb_from_frame(outer, inner->a)};
}

#endif
