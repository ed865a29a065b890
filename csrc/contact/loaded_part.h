/* The loaded part of a contact line (docs/theory/contacts.md#ends-of-the-loaded-part). Rolling resistance hardly falls towards the ends of the part
 * that carries, so a sum over whole nodes would jump whenever an end passes a node. Every node stands for a cell of the line; the cell in which an
 * end lies rolls with its loaded part only, at the interference that is found there. Included by the kernel files only. */
#ifndef TRB_CONTACT_LOADED_PART_H
#define TRB_CONTACT_LOADED_PART_H

#include <math.h>

#include "laws/smooth.h"

/* Ends of loaded parts of one contact that are followed; usual are two. */
enum { TRB_MOST_ENDS = 4 };
/* Where, from the end over the loaded part of a cell, a power of 0.2 to 0.35 of the interference has its mean. */
#define TRB_END_PLACE 0.4

/* A cell that is loaded in part: its lane, and the interference that stands for this part, m. */
typedef struct trb_loaded_end {
  int    lane;
  double interference;
} trb_loaded_end;

/* One contact's nodes: places along the line, ends of their cells, interferences; interference from which on it carries, m. */
typedef struct trb_contact_line {
  int           n;
  const double *station, *cell, *interference;
  double        level;
} trb_contact_line;

static inline int trb_line_carries(const trb_contact_line *line, int node) { return line->interference[node] > line->level; }

/* On the straight line between the two nodes that are nearest to x. */
static inline double trb_line_interference(const trb_contact_line *line, int near, double x)
{
  const double *s = line->station, *d = line->interference;
  int           left = x < s[near] ? near - 1 : near;
  if (left < 0) left = 0;
  if (left > line->n - 2) left = line->n - 2;
  return d[left] + (d[left + 1] - d[left]) * (x - s[left]) / (s[left + 1] - s[left]);
}

/* The end between the node `in`, which carries, and its neighbour `out`, which does not. */
static inline double trb_loaded_end_between(const trb_contact_line *line, int in, int out)
{
  const double *s = line->station, *d = line->interference;
  const double  slope = (d[out] - d[in]) / (s[out] - s[in]), secant = s[in] - (d[in] - line->level) / slope;
  const int     next = 2 * in - out;
  if (next < 0 || next >= line->n) return secant;
  const double bend = (slope - (d[in] - d[next]) / (s[in] - s[next])) / (s[out] - s[next]);
  const double end = secant - (secant - s[in]) * (secant - s[out]) * bend / slope;
  return trb_min(trb_max(end, trb_min(s[in], s[out])), trb_max(s[in], s[out]));
}

/* Adds the cell in which the end lies: it carries from there as far as its other boundary. rises: towards larger stations. */
static inline int trb_loaded_add(const trb_contact_line *line, int c, double end, int rises, double *rolled, trb_loaded_end *ends, int n)
{
  const double whole = line->cell[c + 1] - line->cell[c], inner = line->cell[c + rises];
  const double node = fabs(line->station[c] - line->cell[c + 1 - rises]) / whole, share = trb_min(fabs(inner - end) / whole, 1.0);
  const double place = end + (TRB_END_PLACE + (node - TRB_END_PLACE) * share) * (inner - end);
  const int    is_both = n > 0 && ends[n - 1].lane == c; /* the part between two ends */
  rolled[c] = is_both ? trb_max(rolled[c] + (share - 1.0) * whole, 0.0) : share * whole;
  ends[n] = (trb_loaded_end){.lane = c, .interference = trb_line_interference(line, c, place)};
  return n + 1;
}

/* Lengths that roll, in place of the weights of the nodes that carry; cells that carry in part go to `ends`, their number is returned. */
static inline int trb_loaded_part(const trb_contact_line *line, double *rolled, trb_loaded_end *ends)
{
  const double *s = line->station, *d = line->interference;
  const int     last = line->n - 1;
  int           n = 0;
  if (last < 1) return 0;
  for (int i = 0; i < last && n < TRB_MOST_ENDS; i++) {
    const int rises = trb_line_carries(line, i + 1);
    if (trb_line_carries(line, i) == rises) continue;
    const double end = rises ? trb_loaded_end_between(line, i + 1, i) : trb_loaded_end_between(line, i, i + 1);
    n = trb_loaded_add(line, end <= line->cell[i + 1] ? i : i + 1, end, rises, rolled, ends, n);
  }
  for (int side = 0; side < 2 && n < TRB_MOST_ENDS; side++) {
    const int node = side == 0 ? 0 : last, inner = side == 0 ? 1 : last - 1;
    if (!trb_line_carries(line, node)) continue;
    const double slope = (d[node] - d[inner]) / (s[node] - s[inner]), border = line->cell[side == 0 ? 0 : last + 1];
    if (!(slope * (border - s[node]) < 0.0)) continue;
    const double end = s[node] - (d[node] - line->level) / slope;
    if (fabs(end - s[node]) < fabs(border - s[node])) n = trb_loaded_add(line, node, end, side == 0, rolled, ends, n);
  }
  return n;
}

#endif
