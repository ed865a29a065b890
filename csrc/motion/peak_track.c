#include "motion/peak_track.h"

#include <math.h>
#include <string.h>

int trb_peak_track_length(const trb_peak_sizes *n) { return 2 + 3 * n->all + n->loads + 3 * n->pocket; }

trb_peak_track trb_peak_track_in(const trb_peak_sizes *n, double *block)
{
  trb_peak_track track = {.span = block, .value = block + 2};
  track.most = track.value + n->all;
  track.when = track.most + n->all;
  track.integral = track.when + n->all;
  track.impacts = track.integral + n->loads;
  track.impulse = track.impacts + n->pocket;
  track.hardest = track.impulse + n->pocket;
  return track;
}

void trb_peak_track_start(const trb_peak_sizes *n, trb_peak_track *track, double time, const double *values, int on)
{
  track->span[0] = track->span[1] = time;
  memcpy(track->value, values, (size_t)n->all * sizeof(double));
  memcpy(track->most, values, (size_t)n->all * sizeof(double));
  memset(track->integral, 0, (size_t)n->loads * sizeof(double));
  memset(track->impacts, 0, (size_t)n->pocket * sizeof(double));
  for (int i = 0; i < n->all; i++) track->when[i] = time;
  for (int i = 0; i < n->pocket; i++) {
    if (!on || !(values[i] > 0.0)) track->impulse[i] = 0.0;
    track->hardest[i] = track->impulse[i];
  }
}

/* The area under a straight line. */
static double area(double h, double from, double to) { return 0.5 * h * (from + to); }

static void note(trb_peak_track *track, int i, double time, double value)
{
  track->most[i] = value;
  track->when[i] = time;
}

void trb_peak_track_line(const trb_peak_sizes *n, trb_peak_track *track, double time, const double *values)
{
  const double h = time - track->span[1];
  for (int i = n->pocket; i < n->all; i++)
    if (values[i] > track->most[i]) note(track, i, time, values[i]);
  for (int i = n->pocket; i < n->loads; i++) track->integral[i] += area(h, track->value[i], values[i]);
  for (int i = 0; i < n->pocket; i++) {
    const double from = track->value[i], to = values[i];
    if (!(from > 0.0) && !(to > 0.0)) continue;
    if (to > track->most[i]) note(track, i, time, to);
    track->integral[i] += area(h, from, to);
    if (!(from > 0.0)) {
      track->impacts[i] += 1.0;
      track->impulse[i] = 0.0;
    }
    track->impulse[i] += area(h, from, to);
    track->hardest[i] = fmax(track->hardest[i], track->impulse[i]);
  }
  memcpy(track->value, values, (size_t)n->all * sizeof(double));
  track->span[1] = time;
}

void trb_peak_track_between(const trb_peak_sizes *n, const trb_peak_track *track, double time, const double *values, double at,
                            double *between)
{
  const double from = track->span[1], share = time > from ? fmin(fmax((at - from) / (time - from), 0.0), 1.0) : 1.0;
  for (int i = 0; i < n->all; i++) {
    const double a = track->value[i], b = values[i];
    /* an unloaded film has no thickness: minus infinity at either end, and between them */
    if (share == 1.0 || !isfinite(b)) between[i] = b;
    else if (share == 0.0 || !isfinite(a)) between[i] = a;
    else between[i] = fmin(fmax(a + share * (b - a), fmin(a, b)), fmax(a, b));
  }
}
