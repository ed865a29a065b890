/* The library as a C program sees it: numbers by name, a run, quantities, errors. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "trbdyn.h"

static void test_numbers(void)
{
  char          error[TRB_ERROR_LENGTH] = "";
  trb_case     *c = trb_case_new();
  trb_described d;
  double        value = 0.0;
  int           n = 0;
  assert(c != NULL);
  for (; trb_case_describe(n, &d); n++) {
    assert(trb_case_get(c, d.name, &value, error) == 0);
    assert(value >= d.lower && value <= d.upper && d.text[0] != '\0' && d.unit[0] != '\0');
  }
  assert(n > 150 && !trb_case_describe(-1, &d));
  assert(trb_case_set(c, "axial_load", 3080.0, error) == 0 && trb_case_get(c, "axial_load", &value, NULL) == 0 && value == 3080.0);
  assert(trb_case_set(c, "axial_load", -1.0, error) != 0 && strstr(error, "axial_load = -1") != NULL);
  assert(trb_case_set(c, "n_rollers", 12.5, error) != 0 && strstr(error, "whole number") != NULL);
  assert(trb_case_set(c, "roller_diameter", NAN, error) != 0);
  assert(trb_case_set(c, "diameter", 1.0, NULL) != 0 && trb_case_get(c, "diameter", &value, error) != 0);
  assert(trb_case_get(c, "axial_load", &value, error) == 0 && value == 3080.0);
  assert(trb_error_text(0)[0] != '\0' && trb_version()[0] != '\0');
  trb_case_free(c);
  trb_case_free(NULL);
}

/* The paper's load of a roller, and that what is read belongs to the time that was asked for. */
static void test_run(void)
{
  char      error[TRB_ERROR_LENGTH] = "";
  trb_case *c = trb_case_new();
  trb_run  *run = trb_run_new(c, "standard", error), *other = trb_run_new(c, "standard", error);
  double    loads[64], first[3], second[3], time;
  assert(run != NULL && other != NULL && trb_run_time(run) == 0.0);
  trb_case_free(c);
  assert(trb_run_size(run, "outer_load") == 12 && trb_run_size(run, "nothing") == 0);
  assert(trb_run_read(run, "outer_load", loads, 64, error) == 0);
  for (int j = 0; j < 12; j++) assert(fabs(loads[j] - 1832.8) < 1.0);
  assert(trb_run_to(run, 1e-3, error) == 0 && trb_run_time(run) == 1e-3);
  assert(trb_run_read(run, "time", &time, 1, error) == 0 && time == 1e-3);
  /* times at which quantities are read do not change the steps */
  for (int i = 1; i <= 4; i++) assert(trb_run_to(other, 2.5e-4 * i, error) == 0);
  assert(trb_run_read(run, "cage_position", first, 3, error) == 0 && trb_run_read(other, "cage_position", second, 3, error) == 0);
  assert(memcmp(first, second, sizeof first) == 0 && trb_run_steps(run) == trb_run_steps(other));
  assert(trb_run_step(run, error) == 0 && trb_run_time(run) > 1e-3 && trb_run_steps(run) == trb_run_steps(other) + 1);
  assert(trb_run_to(run, 0.0, error) != 0 && strstr(error, "or later") != NULL);
  assert(trb_run_read(run, "outer_load", loads, 11, error) != 0 && strstr(error, "12 values") != NULL);
  assert(trb_run_read(run, "nothing", loads, 64, error) != 0);
  trb_described d;
  int           n = 0;
  while (trb_run_describe(run, n, &d)) n++;
  assert(n > 50);
  trb_run_free(run);
  trb_run_free(other);
  trb_run_free(NULL);
}

static void test_refusals(void)
{
  char      error[TRB_ERROR_LENGTH] = "";
  trb_case *c = trb_case_new();
  assert(trb_run_new(c, "best", error) == NULL && strstr(error, "fast, standard or reference") != NULL);
  assert(trb_case_set(c, "n_rollers", 20, error) == 0 && trb_run_new(c, "fast", error) == NULL && strstr(error, "overlap") != NULL);
  assert(trb_case_set(c, "n_rollers", 12, error) == 0 && trb_case_set(c, "axial_load", 1e8, error) == 0);
  assert(trb_run_new(c, "fast", NULL) == NULL);
  trb_case_free(c);
}

int main(void)
{
  test_numbers();
  test_run();
  test_refusals();
  return 0;
}
