/* Integrators. A kind of integrator is a struct of functions, in a file of its name; trb_integrator_kinds lists them. */
#ifndef TRB_STEPPING_INTEGRATOR_H
#define TRB_STEPPING_INTEGRATOR_H

#include "motion/rhs.h"
#include "stepping/impact.h"
#include "system/assembly.h"

/* Settings of an integration. X(name, default, lower, upper, text) */
#define TRB_SETTINGS(X) \
  X(rtol,           1e-3,  1e-12, 0.1,  "relative tolerance of velocities") \
  X(atol_position,  9e-10, 1e-16, 1e-2, "tolerance of positions, m") \
  X(atol_angle,     9e-8,  1e-14, 1e-1, "tolerance of angles, rad") \
  X(atol_velocity,  3e-4,  1e-14, 10,   "tolerance of velocities, m/s") \
  X(atol_spin,      3e-2,  1e-12, 1e3,  "tolerance of angular velocities, rad/s") \
  X(max_order,      2,     1,     5,    "highest order of BDF") \
  X(rings_age,      2e-2,  0,     1e3,  "bearing time after which the part of the Jacobian from raceways and ribs is computed again, s") \
  X(rings_share,    0.1,   0,     1,    "share of a step's tolerance by which forces of raceways and ribs may be wrong between exact evaluations") \
  X(newton_share,   0.25,  1e-6,  1,    "share of the step's tolerance to which the equations of a step must hold") \
  X(impact_share,   0.03,  1e-4,  1e3,  "share of an impact's speed and interference that roller and cage may be off in a step") \
  X(impact_least,   4e-3,  1e-6,  1,    "smallest factor of their absolute tolerances for that") \
  X(max_step,       1e-3,  1e-12, 1e3,  "largest step, s") \
  X(first_step,     0,     0,     1,    "first step, s; 0: chosen by the integrator") \
  X(smallest_step,  1e-17, 0,     1,    "smallest step, s: below it the run stops with an error")

typedef struct trb_settings {
#define TRB_SETTING_MEMBER(name, standard, lower, upper, text) double name;
  TRB_SETTINGS(TRB_SETTING_MEMBER)
#undef TRB_SETTING_MEMBER
} trb_settings;

enum { TRB_N_SETTINGS = (int)(sizeof(trb_settings) / sizeof(double)) };

typedef struct trb_setting_info {
  const char *name;
  double      standard, lower, upper;
  const char *text;
} trb_setting_info;

extern const trb_setting_info trb_setting_table[TRB_N_SETTINGS];

/* What an integrator did. X(name, text) */
#define TRB_STATISTICS(X) \
  X(steps,                 "steps taken") \
  X(body_steps,            "the same of every body: of each roller, and of all others together") \
  X(rhs_evaluations,       "evaluations of the right-hand side by the integrator") \
  X(jacobian_evaluations,  "Jacobians") \
  X(linear_setups,         "factorisations") \
  X(nonlinear_iterations,  "iterations of Newton's method") \
  X(nonlinear_failures,    "steps repeated because Newton's method did not converge") \
  X(error_failures,        "steps repeated because their error was too large") \
  X(restarts,              "starts of the integrator") \
  X(last_step,             "size of the last step, s") \
  X(smallest_step,         "size of the smallest step, s") \
  X(last_order,            "order of the last step")

typedef struct trb_statistics {
#define TRB_STATISTIC_MEMBER(name, text) double name;
  TRB_STATISTICS(TRB_STATISTIC_MEMBER)
#undef TRB_STATISTIC_MEMBER
} trb_statistics;

typedef struct trb_integrator trb_integrator;

typedef struct trb_integrator_kind {
  const char *name;
  const char *text;
  /* why a simulation that is open has to be integrated by another method; NULL: it has not. NULL: this one takes all */
  const char *(*refuses)(const trb_integrator *it);
  trb_status (*create)(trb_integrator *it, trb_message *message);
  void (*free)(trb_integrator *it);
  /* start (again) at it->time, it->y */
  trb_status (*restart)(trb_integrator *it, trb_message *message);
  /* one step; moves it->time and it->y */
  trb_status (*step)(trb_integrator *it, trb_message *message);
  /* the solution inside the last step */
  trb_status (*interpolate)(trb_integrator *it, double time, double *y, trb_message *message);
  void (*statistics)(const trb_integrator *it, trb_statistics *statistics);
  /* index of the entry with the largest scaled error of the last step, or -1 */
  int (*worst)(trb_integrator *it);
} trb_integrator_kind;

/* A bearing of the assembly that is integrated. */
typedef struct trb_member {
  trb_dynamics     *dynamics; /* owned by the simulation */
  const trb_motion *motion;
  trb_impacts       impacts; /* of rollers and cage, with the factors of their tolerances */
} trb_member;

struct trb_integrator {
  const trb_integrator_kind *kind;
  const char                *reason; /* why it is not the first choice, where none was asked for; NULL: it is, or it was asked for */
  const trb_assembly        *assembly;
  trb_member                 members[TRB_MOST_MEMBERS];
  const char                *variant; /* kernel variant */
  trb_settings               settings;
  int                        n;        /* length of y */
  int                        n_main;   /* entries of rollers and hub */
  double                     time;     /* end of the last step, s */
  double                    *y;        /* state there; TRB_VECTOR_ROOM more behind it */
  double                    *scale;    /* absolute tolerance of every entry */
  double                    *relative; /* relative tolerance of every entry */
  void                      *self;     /* of the kind */
};

extern const trb_integrator_kind        trb_integrator_bdf, trb_integrator_erk, trb_integrator_multirate;
extern const trb_integrator_kind *const trb_integrator_kinds[];
extern const int                        trb_n_integrator_kinds;

/* Takes the kind where none was asked for: steps of each body, or BDF of all bodies together where that cannot be. */
void trb_integrator_choose(trb_integrator *it);

/* Tolerances of every entry at the present time. */
void trb_integrator_set_tolerances(trb_integrator *it);

/* Bodies whose steps are counted: rollers, and the hub as one. */
double trb_integrator_n_bodies(const trb_integrator *it);
/* Whether anything is prescribed that changes with time. */
int trb_integrator_is_driven(const trb_integrator *it);
/* Factors of a bearing's tolerances for a step of a length, where n of its rollers (ascending) may hit something (stepping/impact.h). */
void trb_integrator_look(trb_integrator *it, int member, double step, const int *chosen, int n);
/* Where the next step must end at the latest, and how long it may be, for what is prescribed of all bearings (motion/ring_motion.h). */
double trb_integrator_stop(const trb_integrator *it);
double trb_integrator_longest_step(const trb_integrator *it);
/* Index of the entry of an error with the largest share of its tolerance, or -1. */
int trb_integrator_worst(const trb_integrator *it, const double *error);

/* Right-hand side with a finite check: 0, or 1 if a rate is not finite: BDF then tries a smaller step, the explicit method stops with
 * an error. */
int trb_integrator_finite(const trb_integrator *it, const double *rates);
int trb_integrator_rates(trb_integrator *it, double time, const double *y, double *rates);

/* Error weights 1/(relative |y| + scale): positions and angles have no relative part, so that a roller's drift loosens nothing. */
void trb_integrator_weights(const trb_integrator *it, const double *y, double *weights);

#endif
