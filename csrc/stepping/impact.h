/* Tolerances of bodies that are about to hit each other or are in contact: smaller where the impact is gentle. */
#ifndef TRB_STEPPING_IMPACT_H
#define TRB_STEPPING_IMPACT_H

#include "motion/dynamics.h"

/* Speeds at which bodies met. */
typedef struct trb_impacts {
  /* of each roller relative to the body that it hits: when they met, or now if they are about to, m/s; INFINITY: they are apart. Then the
   * same for each pair without a roller, by its number in the system */
  double     *speed;
  double     *factor;                  /* of the tolerances: one for each roller, then one for each body of the system */
  trb_body_at bodies[TRB_MOST_BODIES]; /* scratch */
  trb_memory  memory;                  /* of all arrays */
} trb_impacts;

/* They are freed with their memory. */
trb_status trb_impacts_create(const trb_model *m, trb_impacts *impacts, trb_message *message);
void       trb_impacts_forget(const trb_model *m, trb_impacts *impacts);
/* How exactly impacts are followed. */
typedef struct trb_impact_measure {
  double share;              /* of an impact's speed and interference that a step may be wrong by */
  double least;              /* smallest factor of the tolerances */
  double velocity, position; /* absolute tolerances, m/s and m */
} trb_impact_measure;

/* Computes the factors for a step of a given length that starts at a state. chosen: the n rollers that may hit something, ascending; others have a factor of 1,
 * and their speeds are forgotten. A body has the least factor of the pairs that it is one of: what no impact is about to reach keeps its tolerances. */
void trb_impacts_look(trb_impacts *impacts, const trb_dynamics *d, const trb_motion *motion, double time, const double *y, double step,
                      const trb_impact_measure *measure, const int *chosen, int n);

#endif
