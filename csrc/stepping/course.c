#include "stepping/course.h"

#include <math.h>
#include <string.h>

void trb_course_begin(trb_course *c, double time, double step, const double *y, const double *rates)
{
  c->now.begin = c->now.end = time;
  c->now.scale = step;
  for (int i = 0; i < c->n; i++) {
    c->now.z[0][i] = y[i];
    c->now.z[1][i] = step * rates[i];
    c->now.z[2][i] = 0.0;
  }
  c->n_past = 0;
}

void trb_course_rescale(trb_course *c, double step)
{
  const double by = step / c->now.scale;
  for (int i = 0; i < c->n; i++) {
    c->now.z[1][i] *= by;
    c->now.z[2][i] *= by * by;
  }
  c->now.scale = step;
}

void trb_course_predict(const trb_course *c, double p[3][TRB_COURSE_ROOM])
{
  const double (*z)[TRB_COURSE_ROOM] = c->now.z;
  for (int i = 0; i < c->n; i++) {
    p[0][i] = z[0][i] + z[1][i] + z[2][i];
    p[1][i] = z[1][i] + 2.0 * z[2][i];
    p[2][i] = z[2][i];
  }
}

void trb_course_accept(trb_course *c, double end, double p[3][TRB_COURSE_ROOM], const double *e, int keep)
{
  trb_course_step *to = &c->now;
  if (keep) c->past[c->n_past++ % TRB_COURSE_KEPT] = *to;
  else c->n_past = 0;
  for (int i = 0; i < c->n; i++) {
    to->z[0][i] = p[0][i] + e[i];
    to->z[1][i] = p[1][i] + trb_course_l1 * e[i];
    to->z[2][i] = p[2][i] + trb_course_l2 * e[i];
  }
  to->begin = to->end;
  to->end = end;
  c->wait--;
}

/* Oldest step that is there, counted back from the last one. */
static int oldest(const trb_course *c) { return c->n_past < TRB_COURSE_KEPT ? c->n_past : TRB_COURSE_KEPT; }

/* A step counted back from the last one, which is number 0. */
static const trb_course_step *step_of(const trb_course *c, int back)
{
  return back == 0 ? &c->now : &c->past[(c->n_past - back) % TRB_COURSE_KEPT];
}

/* The step to which a time belongs. */
static const trb_course_step *find(const trb_course *c, double time)
{
  int back = 0;
  while (back < oldest(c) && time < step_of(c, back)->begin) back++;
  return step_of(c, back);
}

void trb_course_at(const trb_course *c, double time, int n, double *to)
{
  const trb_course_step *in = find(c, time);
  const double           s = (time - in->end) / in->scale;
  for (int i = 0; i < n; i++) to[i] = in->z[0][i] + s * (in->z[1][i] + s * in->z[2][i]);
}

void trb_course_back(trb_course *c, double time, double step)
{
  trb_course_step in = *find(c, time);
  const double    s = (time - in.end) / in.scale, by = step / in.scale;
  for (int i = 0; i < c->n; i++) {
    const double z1 = in.z[1][i], z2 = in.z[2][i];
    in.z[0][i] += s * (z1 + s * z2);
    in.z[1][i] = by * (z1 + 2.0 * s * z2);
    in.z[2][i] = by * by * z2;
  }
  in.end = time;
  in.scale = step;
  c->now = in;
  c->n_past = 0;
}

int trb_course_lead(const trb_course *c, double time)
{
  int n = 0;
  while (n <= oldest(c) && step_of(c, n)->end > time) n++;
  return n;
}
