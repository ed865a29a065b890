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

void trb_course_try(const trb_course *c, double end, double p[3][TRB_COURSE_ROOM], const double *e, trb_course_step *to)
{
  for (int i = 0; i < c->n; i++) {
    to->z[0][i] = p[0][i] + e[i];
    to->z[1][i] = p[1][i] + trb_course_l1 * e[i];
    to->z[2][i] = p[2][i] + trb_course_l2 * e[i];
  }
  to->scale = c->now.scale;
  to->begin = c->now.end;
  to->end = end;
}

void trb_course_accept(trb_course *c, double end, double p[3][TRB_COURSE_ROOM], const double *e, int keep)
{
  if (keep) c->past[c->n_past++ % TRB_COURSE_KEPT] = c->now;
  else c->n_past = 0;
  trb_course_try(c, end, p, e, &c->now);
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

void trb_course_step_at(const trb_course_step *in, double time, int n, double *to)
{
  const double s = (time - in->end) / in->scale;
  for (int i = 0; i < n; i++) to[i] = in->z[0][i] + s * (in->z[1][i] + s * in->z[2][i]);
}

void trb_course_at(const trb_course *c, double time, int n, double *to) { trb_course_step_at(find(c, time), time, n, to); }

void trb_course_step_ways(const trb_course_step *in, double from, double to, int n, const double *value, double *ways)
{
  const double s = (fmax(from, in->begin) - in->end) / in->scale, e = (fmin(to, in->end) - in->end) / in->scale;
  /* a parabola leaves the line between its ends by a quarter of its square part at most */
  for (int i = 0; i < n; i++) {
    const double first = in->z[0][i] + s * (in->z[1][i] + s * in->z[2][i]), last = in->z[0][i] + e * (in->z[1][i] + e * in->z[2][i]);
    const double chord = trb_max(fabs(first - value[i]), fabs(last - value[i])), way = chord + 0.25 * (e - s) * (e - s) * fabs(in->z[2][i]);
    ways[i] = trb_max(ways[i], way);
  }
}

void trb_course_ways(const trb_course *c, double from, double to, int n, const double *value, double *ways)
{
  for (int back = 0; back <= oldest(c) && step_of(c, back)->end > from; back++)
    if (step_of(c, back)->begin < to) trb_course_step_ways(step_of(c, back), from, to, n, value, ways);
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
