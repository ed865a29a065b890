/* Runs the 30310 bearing of the paper for two turns of its shaft and prints the orbit of its cage.
 *
 *   cc orbit.c $(pkg-config --cflags --libs trbdyn) -lm -o orbit && ./orbit
 *   ./orbit axial_load=8000 speed_rpm=2000      numbers of the case may be given other values */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <trbdyn.h>

static int fail(const char *error)
{
  fprintf(stderr, "orbit: %s\n", error);
  return 1;
}

int main(int count, char **words)
{
  char      error[TRB_ERROR_LENGTH] = "out of memory";
  trb_case *bearing = trb_case_new();
  if (bearing == NULL) return fail(error);
  if (trb_case_set(bearing, "cage_y", -0.1e-3, error) != 0) return fail(error); /* m: the cage begins off its centre */
  for (int i = 1; i < count; i++) {
    char *value = strchr(words[i], '=');
    if (value == NULL) return fail("give numbers as name=value");
    *value++ = '\0';
    if (trb_case_set(bearing, words[i], strtod(value, NULL), error) != 0) return fail(error);
  }
  double speed_rpm, play;
  if (trb_case_get(bearing, "speed_rpm", &speed_rpm, error) != 0) return fail(error);
  if (trb_case_get(bearing, "play_radial", &play, error) != 0) return fail(error);

  trb_run *run = trb_run_new(bearing, "standard", error);
  trb_case_free(bearing);
  if (run == NULL) return fail(error);
  const double turn = 60.0 / fabs(speed_rpm);
  printf("    turns       x / um       y / um   orbit radius / Cpr   torque / N m\n");
  for (int i = 0; i <= 16; i++) {
    double place[3], torque;
    if (trb_run_to(run, turn * i / 8.0, error) != 0) return fail(error);
    if (trb_run_read(run, "cage_position", place, 3, error) != 0) return fail(error);
    if (trb_run_read(run, "inner_torque", &torque, 1, error) != 0) return fail(error);
    printf("%9.3f %12.3f %12.3f %20.4f %14.4f\n", i / 8.0, 1e6 * place[0], 1e6 * place[1], hypot(place[0], place[1]) / play, torque);
  }
  double loads[200], mean = 0.0;
  const int rollers = trb_run_size(run, "outer_load");
  if (trb_run_read(run, "outer_load", loads, 200, error) != 0) return fail(error);
  for (int i = 0; i < rollers; i++) mean += loads[i] / rollers;
  printf("%d rollers, mean load on the outer raceway %.1f N, %.0f steps, trbdyn %s\n", rollers, mean, trb_run_steps(run), trb_version());
  trb_run_free(run);
  return 0;
}
