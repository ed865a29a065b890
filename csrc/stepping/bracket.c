/* Where oil yields or friction turns round within micrometres a second, what the equations lack is nearly a step of the sliding speed: F
 * has the one sign before the solution and the other behind it, and little in between. Newton's method jumps to and fro over such a place
 * for ever, because a slope taken beside it is too small and each correction goes too far, and its improvement by Broyden's update follows
 * two points on the same side away from it. Two points on different sides enclose the solution, whatever the slopes are.
 *
 * Many equations have sides only along a line. The jumps are along one line nearly, that on which the roller in question slides: the other
 * equations are fulfilled after the first correction. So the sides are told by the sign of the product of what is lacking at two points,
 * and the search goes along the line from the one to the other. It is the regula falsi in the form of Illinois: a straight line through
 * both ends tells the next place, and the value at an end that stays for a second time counts half (Dowell and Jarratt, BIT 11 (1971)
 * 168). If the line misses the solution, as two rollers slide at the same time, the search ends without one. */
#include "stepping/bracket.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stepping/weighted.h"

int trb_bracket_create(trb_bracket *bracket, int n)
{
  bracket->n = n;
  bracket->room = calloc((size_t)n * 4, sizeof(double));
  if (bracket->room == NULL) return -1;
  bracket->best = (trb_bracket_point){.at = bracket->room, .lack = bracket->room + n};
  bracket->other = (trb_bracket_point){.at = bracket->room + 2 * (size_t)n, .lack = bracket->room + 3 * (size_t)n};
  trb_bracket_clear(bracket);
  return 0;
}

void trb_bracket_free(trb_bracket *bracket)
{
  free(bracket->room);
  bracket->room = NULL;
}

void trb_bracket_clear(trb_bracket *bracket) { bracket->best.square = bracket->other.square = (double)INFINITY; }

static void put(const trb_bracket *bracket, trb_bracket_point *point, const double *at, const double *lack, double square)
{
  memcpy(point->at, at, (size_t)bracket->n * sizeof *at);
  memcpy(point->lack, lack, (size_t)bracket->n * sizeof *lack);
  point->square = square;
}

void trb_bracket_add(trb_bracket *bracket, const double *at, const double *lack, const double *weight)
{
  trb_bracket_point *best = &bracket->best, *other = &bracket->other;
  const double       square = trb_weighted_product(bracket->n, lack, lack, weight);
  if (!isfinite(square)) return;
  const int beyond = isfinite(best->square) && trb_weighted_product(bracket->n, best->lack, lack, weight) < 0.0;
  if (beyond && square < best->square) {
    const trb_bracket_point was = *best;
    *best = *other;
    *other = was;
    put(bracket, best, at, lack, square);
  } else if (square < (beyond ? other : best)->square) {
    put(bracket, beyond ? other : best, at, lack, square);
  }
}

int trb_bracket_begin(trb_bracket *bracket, const double *weight)
{
  if (!isfinite(bracket->best.square) || !isfinite(bracket->other.square)) return 0;
  bracket->low = 0.0;
  bracket->high = 1.0;
  bracket->low_value = bracket->best.square;
  bracket->high_value = trb_weighted_product(bracket->n, bracket->best.lack, bracket->other.lack, weight);
  bracket->moved = 0;
  /* a better point of the same side may have taken the place of the one that the other was told from */
  return bracket->high_value < 0.0;
}

void trb_bracket_next(trb_bracket *bracket, double *at)
{
  const double *from = bracket->best.at, *to = bracket->other.at;
  const double  share = bracket->low_value / (bracket->low_value - bracket->high_value);
  bracket->place = bracket->low + share * (bracket->high - bracket->low);
  for (int i = 0; i < bracket->n; i++) at[i] = from[i] + bracket->place * (to[i] - from[i]);
}

void trb_bracket_found(trb_bracket *bracket, const double *lack, const double *weight)
{
  const double value = trb_weighted_product(bracket->n, bracket->best.lack, lack, weight);
  if (value > 0.0) {
    bracket->low = bracket->place;
    bracket->low_value = value;
    if (bracket->moved > 0) bracket->high_value *= 0.5;
    bracket->moved = 1;
  } else {
    bracket->high = bracket->place;
    bracket->high_value = value;
    if (bracket->moved < 0) bracket->low_value *= 0.5;
    bracket->moved = -1;
  }
}
