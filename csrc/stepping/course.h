/* The course of a body: its solution by backward differentiation of order 2, step by step, each step with its polynomial
 * (docs/theory/multirate.md#the-formula). The formula is Nordsieck's: instead of values at earlier times, a body keeps the polynomial through its last
 * two values and the last rate, with coefficients that are scaled to the length of the next step h,
 *   y(t) = z0 + s z1 + s^2 z2,  s = (t - t_n)/h,
 * so that its state can be had at every instant of a step, and a step of another length needs a multiplication only. A step goes from the prediction p
 * of this polynomial to y = p0 + e, where e solves e + p1/l1 = (h/l1) f(p0 + e); then z = p + (1, l1, l2) e with l1 = 3/2 and l2 = 1/2.
 * (Hairer, Norsett, Wanner, Solving ODEs I, III.6; Byrne and Hindmarsh 1975, ACM Trans. Math. Softw. 1, 71.) */
#ifndef TRB_STEPPING_COURSE_H
#define TRB_STEPPING_COURSE_H

#include "motion/dynamics.h"
#include "stepping/constants.h"

/* Entries of a body: its coordinates, its spin angle, quadratures. */
enum { TRB_COURSE_ROOM = 32 };
_Static_assert((int)TRB_FLOW_SIZE <= (int)TRB_COURSE_ROOM && 12 + (int)TRB_N_QUADRATURES <= (int)TRB_COURSE_ROOM, "room for all bodies");

/* A step: its polynomial holds from its begin to its end. */
typedef struct trb_course_step {
  double begin, end; /* s */
  double scale;      /* h of the polynomial, s */
  double z[3][TRB_COURSE_ROOM];
} trb_course_step;

typedef struct trb_course {
  int             n, main; /* entries; how many of them control the step */
  int             wait;    /* steps until the next one may be longer */
  trb_course_step now;     /* the last step; scale: length of the next one */
  trb_course_step past[TRB_COURSE_KEPT];
  int             n_past; /* steps before it that were kept since the beginning; the last TRB_COURSE_KEPT of them are there */
} trb_course;

/* Begins at a state, of which the rates are given, with a length of the first step. */
void trb_course_begin(trb_course *c, double time, double step, const double *y, const double *rates);
/* The next step has this length. */
void trb_course_rescale(trb_course *c, double step);
/* A prediction for the end of the next step. */
void trb_course_predict(const trb_course *c, double p[3][TRB_COURSE_ROOM]);
/* Takes the step that ends at a time with a prediction and e; keep: the one before is kept. */
void trb_course_accept(trb_course *c, double end, double p[3][TRB_COURSE_ROOM], const double *e, int keep);
/* Values of the first n entries at a time of the steps that are there. */
void trb_course_at(const trb_course *c, double time, int n, double *to);
/* Takes the body back to a time of the steps that are there; the next step has the length given. */
void trb_course_back(trb_course *c, double time, double step);
/* Steps that end after a time. */
int trb_course_lead(const trb_course *c, double time);

/* Error of a step in units of e: the constant of the formula, 2/9 for steps of the same length, and by how much it differs where the last one had another
 * length (Brown, Byrne, Hindmarsh 1989, SIAM J. Sci. Stat. Comput. 10, 1038). */
static inline double trb_course_error_of(const trb_course *c)
{
  const double last = c->now.end - c->now.begin, xi = last > 0.0 ? c->now.scale / (c->now.scale + last) : 0.5;
  return (0.5 + xi) / (trb_course_l1 * (2.0 + 2.0 * xi));
}

#endif
