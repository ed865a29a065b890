/* A track: extremes, integrals and impacts of several quantities over a stretch of time. It is continued from the end of one step to the
 * end of the next, between which each quantity is a straight line. A quantity whose smallest value is wanted is given with the opposite
 * sign. */
#ifndef TRB_MOTION_PEAK_TRACK_H
#define TRB_MOTION_PEAK_TRACK_H

typedef struct trb_peak_sizes {
  int pocket; /* pocket forces, which come first */
  int loads;  /* all loads, pocket forces among them */
  int all;
} trb_peak_sizes;

/* All in one block of trb_peak_track_length() numbers, which is all that there is to save. */
typedef struct trb_peak_track {
  double *span;  /* start and end of what it covers, s */
  double *value; /* at its end */
  double *most;  /* largest values, and their times, s */
  double *when;
  double *integral; /* of the loads, N s */
  double *impacts;  /* contacts of a pocket's face that began */
  double *impulse;  /* of the contact under way, or of the last one, N s */
  double *hardest;  /* largest impulse of one contact, N s */
} trb_peak_track;

int            trb_peak_track_length(const trb_peak_sizes *n);
trb_peak_track trb_peak_track_in(const trb_peak_sizes *n, double *block);

/* Start at an instant. Contacts that are under way keep their impulse if `on`; they do not count as begun. */
void trb_peak_track_start(const trb_peak_sizes *n, trb_peak_track *track, double time, const double *values, int on);
/* Go on in straight lines; no time may lie before the track's end. */
void trb_peak_track_line(const trb_peak_sizes *n, trb_peak_track *track, double time, const double *values);
/* On the straight lines from the track's end to (time, values), never beyond either. */
void trb_peak_track_between(const trb_peak_sizes *n, const trb_peak_track *track, double time, const double *values, double at,
                            double *between);

#endif
