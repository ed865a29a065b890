/* Tolerances of bodies that are about to hit each other, or do: smaller where the impact is gentle. */
#ifndef TRB_STEPPING_IMPACT_H
#define TRB_STEPPING_IMPACT_H

#include "motion/dynamics.h"

/* Speeds at which rollers met their pockets. */
typedef struct trb_impacts {
  double *speed;  /* of each roller and its pocket when they met, or would if they met now, m/s; INFINITY: they are apart */
  double *factor; /* of the absolute tolerances: a roller each, then the cage */
} trb_impacts;

trb_status trb_impacts_create(const trb_model *m, trb_impacts *impacts, trb_message *message);
void       trb_impacts_free(trb_impacts *impacts);
void       trb_impacts_forget(const trb_model *m, trb_impacts *impacts);
/* How exactly impacts are followed. */
typedef struct trb_impact_measure {
  double share;              /* of an impact's speed and interference that a step may be wrong by */
  double least;              /* smallest factor of the tolerances */
  double velocity, position; /* absolute tolerances, m/s and m */
} trb_impact_measure;

/* Factors for a step of a length from a state on. */
void trb_impacts_look(trb_impacts *impacts, const trb_dynamics *d, const trb_motion *motion, double time, const double *y, double step,
                      const trb_impact_measure *measure);

#endif
