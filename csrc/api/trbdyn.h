/* trbdyn for C programs: a bearing by numbers with names, its simulation, and every quantity that it records.
 *
 *   trb_case *bearing = trb_case_new();                          the 30310 of the paper at 3000 rpm under 4930 N
 *   trb_case_set(bearing, "axial_load", 8000.0, error);
 *   trb_run *run = trb_run_new(bearing, "standard", error);      starts in its equilibrium at speed
 *   trb_run_to(run, 0.02, error);                                s
 *   trb_run_read(run, "cage_position", position, 3, error);      m
 *
 * A function that can fail gives NULL, or a status that is not 0, and writes what happened into a text of TRB_ERROR_LENGTH characters,
 * which may be NULL. All numbers are in SI units. Nothing is global: several runs may step in several threads, each run in one at a time. */
#ifndef TRB_API_TRBDYN_H
#define TRB_API_TRBDYN_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define TRB_API
#else
#define TRB_API __attribute__((visibility("default")))
#endif

enum { TRB_ERROR_LENGTH = 512 };

typedef struct trb_case trb_case; /* a bearing and what acts on it */
typedef struct trb_run  trb_run;  /* its simulation */

/* A number of a case, or a quantity that a run records. */
typedef struct trb_described {
  const char *name, *unit, *text;
  double      lower, upper; /* what a number of a case may be, the bounds included; 0 of a quantity */
} trb_described;

/* Version of the library, and the text of a status. */
TRB_API const char *trb_version(void);
TRB_API const char *trb_error_text(int status);

/* A case with the default effects; NULL: out of memory. */
TRB_API trb_case *trb_case_new(void);
TRB_API void      trb_case_free(trb_case *c);
/* Number i of a case, from 0 on; 0 where there is none any more. */
TRB_API int trb_case_describe(int i, trb_described *described);
/* Gives a number another value, or reads it. */
TRB_API int trb_case_set(trb_case *c, const char *name, double value, char *error);
TRB_API int trb_case_get(const trb_case *c, const char *name, double *value, char *error);

/* A simulation of a case, which is not needed any more: the ring at its equilibrium under the loads, rollers in pure rolling and evenly
 * spaced, the cage where cage_x and cage_y put it. accuracy: "fast", "standard" or "reference". */
TRB_API trb_run *trb_run_new(const trb_case *c, const char *accuracy, char *error);
TRB_API void     trb_run_free(trb_run *run);
/* One step of the integrator; or steps until a time (s) is passed, at which quantities are read then. */
TRB_API int trb_run_step(trb_run *run, char *error);
TRB_API int trb_run_to(trb_run *run, double time, char *error);
/* The time at which quantities are read, s, and the number of steps that were taken. */
TRB_API double trb_run_time(const trb_run *run);
TRB_API double trb_run_steps(const trb_run *run);
/* Quantity i of a run, from 0 on; 0 where there is none any more. How many values it has; 0: the bearing does not have it. */
TRB_API int trb_run_describe(const trb_run *run, int i, trb_described *described);
TRB_API int trb_run_size(const trb_run *run, const char *name);
/* Writes all values of a quantity, which must be as many as `size` or fewer. */
TRB_API int trb_run_read(trb_run *run, const char *name, double *values, int size, char *error);

#ifdef __cplusplus
}
#endif
#endif
