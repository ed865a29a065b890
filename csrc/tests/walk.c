/* One right-hand side of a plain scene, for .ci/walk.py: what ran before it is forgotten. */
#include <stdlib.h>

#include "rig.h"

void __gcov_reset(void);

int main(void)
{
  unsigned long long seed = 7;
  static double      y[512], rates[512];
  const trb_params   p = rig_params();
  trb_system        *system = rig_system(&p);
  trb_motion        *motion = rig_motion(rig_state(system, 4930.0, 300.0, y), 300.0);
  trb_dynamics      *d = rig_dynamics(system, motion);
  rig_disturb(system, &seed, y);
  trb_rhs(d, NULL, 0.01, y, rates);
  __gcov_reset();
  trb_rhs(d, NULL, 0.0101, y, rates);
  return 0;
}
