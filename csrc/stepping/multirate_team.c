/* Which rollers step with the hub (docs/theory/multirate.md#touches). */
#include <math.h>
#include <string.h>

#include "stepping/multirate.h"
#include "motion/fast_pairs.h"

/* Steps in which a roller of the hub's team has touched nothing until it leaves. */
enum { UNTIL_LEAVES = 30 };
/* How often a step of the hub is halved to prove that a roller by itself has touched nothing in it. */
static const int most_halvings = 3;

void trb_multirate_list(trb_multirate *s)
{
  s->n_together = 0;
  for (int j = 0; j < s->n_rollers; j++)
    if (s->movers[j].together) s->together[s->n_together++] = j;
}

/* A roller goes back to where the hub is and is one of its team. One that has touched nothing adds its own block to the Jacobian, and nothing else. */
static void join(trb_multirate *s, int roller, int touches)
{
  trb_mover       *b = &s->movers[roller];
  const trb_mover *hub = &s->movers[s->n_rollers];
  trb_course_back(&b->course, hub->course.now.end, hub->course.now.scale);
  b->together = 1;
  b->quiet = 0;
  s->has_factors = 0;
  s->has_jacobian &= !touches;
  s->arrow->borders[roller].parts = 0U;
  for (int c = 0; c < TRB_NR; c++)
    memcpy(s->arrow->rollers[roller].own[c], trb_tangents_column(s->jacobian->tangents, roller, c), TRB_NR * sizeof(double));
}

/* Whether a roller by itself is proven to touch nothing between two times of the step that the hub has tried: by the bounds that are there, by new ones
 * from the middle, or in both halves, which are so often halved again. */
static int is_clear(trb_integrator *it, int roller, double from, double to, int halvings, int *touches)
{
  trb_multirate *s = it->self;
  trb_dynamics  *d = it->members[0].dynamics;
  const double   middle = 0.5 * (from + to);
  double        *own = s->y + s->movers[roller].first, *hub = s->y + s->movers[s->n_rollers].first;
  double         of_roller[TRB_PLACE_OF_ROLLER] = {0};
  const int      width = s->movers[s->n_rollers].course.main;
  unsigned       open = 0U;
  trb_course_at(&s->movers[roller].course, middle, TRB_NR, own);
  trb_course_ways(&s->movers[roller].course, from, to, TRB_PLACE_OF_ROLLER, own, of_roller);
  if (!s->at_middle || halvings < most_halvings) {
    memset(s->ways, 0, sizeof s->ways);
    trb_course_step_at(&s->tried, middle, width, hub);
    trb_course_step_ways(&s->tried, from, to, width, hub, s->ways);
    s->at_middle = halvings == most_halvings;
  }
  for (int f = 0; f < d->n_fast; f++)
    if (d->fast[f].surfaces[roller] != 0 && !trb_fast_clear_within(d, f, roller, s->y, of_roller, s->ways)) open |= 1U << f;
  if (open == 0U) return 1;
  trb_dynamics_drive(d, middle);
  trb_dynamics_pose_hub(d, s->y);
  trb_dynamics_pose_roller(d, roller, own);
  for (int f = 0; f < d->n_fast; f++) {
    trb_load load;
    if (!(open >> f & 1U)) continue;
    const trb_gaps gaps = trb_fast_touch(d, f, roller, s->y, &load, NULL, NULL);
    if (!trb_gaps_clear(&gaps)) {
      *touches = 1;
      return 0;
    }
    if (trb_fast_clear_within(d, f, roller, s->y, of_roller, s->ways)) open &= ~(1U << f);
  }
  if (open == 0U) return 1;
  return halvings > 0 && is_clear(it, roller, middle, to, halvings - 1, touches) &&
         is_clear(it, roller, from, middle, halvings - 1, touches);
}

int trb_multirate_join(trb_integrator *it, double end, int *touches)
{
  trb_multirate *s = it->self;
  trb_mover     *hub = &s->movers[s->n_rollers];
  int            n = 0;
  trb_course_try(&hub->course, end, hub->p, hub->e, &s->tried);
  s->at_middle = 0;
  for (int j = 0; j < s->n_rollers; j++) {
    int here = 0;
    if (s->movers[j].together || is_clear(it, j, it->time, end, most_halvings, &here)) continue;
    join(s, j, here);
    *touches |= here;
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
    if (b->quiet < UNTIL_LEAVES) continue;
    b->together = 0;
    b->gamma = 0.0;
    b->course.wait = TRB_UNTIL_LONGER;
    n++;
  }
  if (n == 0) return;
  s->has_factors = 0;
  trb_multirate_list(s);
}
