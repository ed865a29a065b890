/* The 30310 rig for C tests: parameters, its pocket, a model, states; and random numbers that are the same everywhere. */
#ifndef TRB_TESTS_RIG_H
#define TRB_TESTS_RIG_H

#include "body/cage.h"
#include "motion/record.h"
#include "stepping/jacobian.h"
#include "stepping/simulation.h"
#include "system/tapered.h"

enum { RIG_FACES = 4, RIG_SLICES = 24, RIG_ROOM = 600 };

/* 30310 with its oil at 60 C, effects of the paper, logarithmic profile, 24 uniform slices. */
trb_params rig_params(void);
/* The same with cylinders for cones: all four ribs, a little clearance along the axis. */
trb_params rig_cylinder(void);
/* Two bars and two end walls, as the plays Cpr 0.25 mm, Cpc 0.12 mm and axial 0.4 mm give them. */
void rig_faces(const trb_params *params, trb_face faces[RIG_FACES]);
/* A model of the parameters with the rig's faces and equal rollers; ends the program where that fails. */
trb_model *rig_model(const trb_params *params);
/* Rows of modes, as many as params.cage.n_modes says, for trb_model_set_modes: no cage's, but with all parts of a shape; freed by free. */
double *rig_modes(const trb_model *model, int *columns);
/* A system of such a model, with these modes; rig_free frees both. */
trb_system *rig_system(const trb_params *params);
void        rig_free(trb_system *system);
/* Where the coordinates of the cage begin in a state. */
int rig_cage(const trb_system *system);
/* A ring held at a displacement along z, at a speed, with gravity along -y. */
trb_motion  *rig_motion(double displacement_z, double shaft_speed);
trb_settings rig_settings(void);
/* Equilibrium under an axial load; gives the ring's displacement along z and fills a state of pure rolling. */
double rig_state(const trb_system *system, double axial_load, double shaft_speed, double *state);
/* What a test needs of a system for a motion, with plain kernels, and a simulation with the fastest ones; a failure ends the program. */
trb_dynamics   *rig_dynamics(const trb_system *system, const trb_motion *motion);
trb_jacobian   *rig_jacobian(const trb_system *system, const trb_motion *motion);
trb_arrow      *rig_arrow(const trb_system *system);
trb_detail     *rig_detail(const trb_system *system);
trb_simulation *rig_simulation(const trb_system *system, const trb_motion *motion, const char *kind, const trb_settings *settings,
                               const double *y);
/* A simulation of one bearing; kind: name of an integrator; variant: of a kernel variant or "". */
trb_status rig_create(const trb_system *system, const trb_motion *motion, const char *kind, const char *variant,
                      const trb_settings *settings, double time, const double *state, trb_simulation **simulation, trb_message *message);
/* Steps until a time is reached; a step that fails ends the program. */
void rig_run(trb_simulation *simulation, double until);
/* Disturb a state: rollers about it, velocities at some slip, the cage against its rollers so that pockets touch. */
void rig_disturb(const trb_system *system, unsigned long long *seed, double *state);

/* Uniform over -1 to 1. */
double rig_random(unsigned long long *seed);

/* What a bound was, and what it bounded. */
typedef struct rig_tried {
  double tightest; /* largest change over its bound */
  double mean;     /* the same, summed up */
  int    n;
} rig_tried;

void rig_note(rig_tried *tried, double change, double bound);

/* Back towards a state until no roller pushes the cage with more than a force. */
void rig_draw_back(trb_dynamics *d, double most, const double *to, double *state);

/* A bearing at 3000 rpm with its state at the start. */
typedef struct rig_bench {
  trb_system   *system;
  trb_motion   *motion;
  trb_dynamics *d;
  double        start[RIG_ROOM];
} rig_bench;

/* Of a system of parameters under an axial load; rig_close frees all. */
rig_bench rig_open(const trb_params *params, double load);
void      rig_close(rig_bench *bench);

/* Energy of all bodies and contacts at a state, less what was put in, plus what was lost, J. */
double rig_balance(const trb_system *system, const trb_motion *motion, double time, const double *y);

/* How far an arrow's Jacobian at a state lies from differences of the exact right-hand side, in units of the tolerances: the largest
 * difference of a row over its largest entry. d: dynamics of each of n systems that are simulated together. */
double rig_jacobian_error(trb_dynamics *const *d, int n, const trb_arrow *a, double time, double *y);

/* The same of the Jacobian that is computed at a state. */
double rig_jacobian_off(const trb_system *system, const trb_motion *motion, double time, double *y);

/* The whole Jacobian that an arrow holds: rows of `stride` entries, as many as the arrow has unknowns. */
void rig_expand(const trb_arrow *a, int stride, double *whole);

#endif
