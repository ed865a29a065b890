/* Two points between which the equations of an implicit step have a solution, and the search between them. */
#ifndef TRB_STEPPING_BRACKET_H
#define TRB_STEPPING_BRACKET_H

/* A point of an iteration: where it is, what the equations lack there, and the weighted square of that; INFINITY if there is none. */
typedef struct trb_bracket_point {
  double *at, *lack, square;
} trb_bracket_point;

typedef struct trb_bracket {
  int               n;           /* entries of a point */
  double           *room;        /* of the points' entries */
  trb_bracket_point best, other; /* the point that lacks least, and the one beyond the solution that lacks least */
  /* the search: places from the best point (0) to the other one (1) that enclose the solution, what is lacking at them along what the best
   * point lacks, and which of both was moved last */
  double low, high, low_value, high_value, place;
  int    moved;
} trb_bracket;

/* Returns 0, or -1 if out of memory. */
int  trb_bracket_create(trb_bracket *bracket, int n);
void trb_bracket_free(trb_bracket *bracket);

/* Forget all points. */
void trb_bracket_clear(trb_bracket *bracket);
/* Remember a point if it is the best one of its side. */
void trb_bracket_add(trb_bracket *bracket, const double *at, const double *lack, const double *weight);

/* Begin to search. Returns 0 if no two points are known that enclose a solution. */
int trb_bracket_begin(trb_bracket *bracket, const double *weight);
/* The next point to try. */
void trb_bracket_next(trb_bracket *bracket, double *at);
/* What the equations lack there. */
void trb_bracket_found(trb_bracket *bracket, const double *lack, const double *weight);

#endif
