/* What peaks read of a roller's contact with a race, and how it changes while roller and ring move: load, largest pressure and film parameter
 * follow their slopes until they may be off by a share (docs/theory/numerics.md#records-peaks-and-restarts). */
#ifndef TRB_CONTACT_RACE_LOOK_H
#define TRB_CONTACT_RACE_LOOK_H

#include "contact/kernels.h"
#include "contact/pair.h"

/* Nodes of a contact at which its motion is found: the first, one in the middle, the last. */
enum { TRB_N_STATIONS = 3 };

/* Motion of a contact. */
typedef struct trb_race_motion {
  double depth[TRB_N_STATIONS]; /* interference but for what roller and race are at the station, m */
  double rate[2];               /* at which it grows at the first and at the last one, m/s */
  double speed, slide_roll;     /* mean speed, m/s, and sliding over it, in the middle */
} trb_race_motion;

/* A contact as it was looked at, and its slopes. */
typedef struct trb_race_held {
  trb_race_motion motion;
  double          load, pressure, film_parameter;
  double          deepest;                    /* largest interference, m; negative: the gap */
  double          elastic;                    /* load without damping, N */
  double          stiffness[TRB_N_STATIONS];  /* slope of the load over the interference at each station, N/m */
  double          damping[2];                 /* slope of the load over the rate at the first and at the last one, N s/m */
  double          both;                       /* slope of the damping over the interference, N s/m2 */
  double          way;                        /* by which the interference may change, m */
  double          by_way[TRB_N_STATIONS];     /* slope of the logarithm of the film over the interference at each station, 1/m */
  double          by_rate[2];                 /* and over the rate at the first and at the last one, s/m */
  double          by_speed, by_load, by_slip; /* slopes of the logarithm of the film over those of speed and load, and over slide_roll */
  double          slip;                       /* by which slide_roll may change along its slope */
  double          top, log_speed, heat;       /* largest pressure, logarithm of the speed, and the factor of heat */
  double          faster;                     /* relative change of speed that the film may follow */
  double         *node;                       /* pressures, then one over the interference, of n_lanes each */
} trb_race_held;

typedef struct trb_races_held {
  int     node[TRB_N_STATIONS];
  double *share; /* [station][lane]: of what a station moves by, in what the node moves by; then of the way from the first to the last */
  trb_race_held *of; /* [race][roller] */
} trb_races_held;

/* One contact alone; its nodes are the first lanes of the workspace, if it is loaded. */
void trb_raceway_of(const trb_model *m, const trb_instant *at, int roller, const trb_pair *pair, trb_workspace *work,
                    trb_race_output *output);

trb_pair_look   trb_races_look;
trb_pair_follow trb_race_follow;

#endif
