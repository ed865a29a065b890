/* Which rollers step with the hub (docs/theory/multirate.md#touches). */
#include <math.h>
#include <string.h>

#include "stepping/constants.h"
#include "stepping/multirate.h"
#include "motion/fast_pairs.h"

void trb_multirate_list(trb_multirate *s)
{
  s->n_together = 0;
  for (int j = 0; j < s->n_rollers; j++)
    if (s->movers[j].together) s->together[s->n_together++] = j;
}

/* A roller goes back to where the hub is and is one of its team. */
static void join(trb_multirate *s, int roller)
{
  trb_mover       *b = &s->movers[roller];
  const trb_mover *hub = &s->movers[s->n_rollers];
  trb_course_back(&b->course, hub->course.now.end, hub->course.now.scale);
  b->together = 1;
  b->quiet = 0;
  s->has_factors = 0;
  s->joined[s->n_joined++] = roller;
}

/* Whether a roller by itself touches nothing at the end of the step that the hub has tried: by the bounds that are there, or by its gaps. posed: whether the
 * hub is where it is then. */
static int is_clear(trb_integrator *it, int roller, double end, int *posed)
{
  trb_multirate *s = it->self;
  trb_dynamics  *d = it->members[0].dynamics;
  double        *own = s->y + s->movers[roller].first;
  trb_course_at(&s->movers[roller].course, end, TRB_NR, own);
  const unsigned near = trb_fast_near(d, roller, s->y);
  if (near == 0U) return 1;
  if (!*posed) {
    trb_dynamics_drive(d, end);
    trb_dynamics_pose_hub(d, s->y);
    *posed = 1;
  }
  trb_dynamics_pose_roller(d, roller, own);
  for (int f = 0; f < d->n_fast; f++) {
    trb_load load;
    if (!(near >> f & 1U)) continue;
    const trb_gaps gaps = trb_fast_touch(d, f, roller, s->y, &load, NULL, NULL);
    if (!trb_gaps_clear(&gaps)) return 0;
  }
  return 1;
}

int trb_multirate_join(trb_integrator *it, double end)
{
  trb_multirate   *s = it->self;
  const trb_mover *hub = &s->movers[s->n_rollers];
  int              n = 0, posed = 0;
  for (int i = 0; i < hub->course.main; i++) s->y[hub->first + i] = hub->p[0][i] + hub->e[i];
  for (int j = 0; j < s->n_rollers; j++) {
    if (s->movers[j].together || is_clear(it, j, end, &posed)) continue;
    join(s, j);
    n++;
  }
  if (n > 0) trb_multirate_list(s);
  return n;
}

void trb_multirate_leave(trb_integrator *it)
{
  trb_multirate      *s = it->self;
  const trb_dynamics *d = it->members[0].dynamics;
  int                 n = 0;
  for (int k = 0; k < s->n_together; k++) {
    const int  j = s->together[k];
    trb_mover *b = &s->movers[j];
    int        clear = 1;
    for (int f = 0; f < d->n_fast && clear; f++) clear = d->fast[f].surfaces[j] == 0 || trb_fast_gap_left(d, f, j, it->y) > 0.0;
    b->quiet = clear ? b->quiet + 1 : 0;
    if (b->quiet < TRB_STEPS_UNTIL_LEAVES) continue;
    b->together = 0;
    /* as it has touched nothing since the Jacobian was filled, the other ones' system stays as it is */
    if (s->factors->borders[j].parts != 0U || s->arrow->borders[j].parts != 0U) s->has_factors = 0, s->factors->held[j] = 0.0;
    b->age = 0;
    b->course.wait = TRB_STEPS_UNTIL_LONGER;
    n++;
  }
  if (n > 0) trb_multirate_list(s);
}
