/* Checks that count and report. A test is a program: static functions full of checks, and a main that calls them and returns
 * check_report(). */
#ifndef TRB_TESTS_CHECK_H
#define TRB_TESTS_CHECK_H

#include <math.h>
#include <stdio.h>
#include <string.h>

static int check_count, check_failures;

static inline int check_that(int holds, const char *file, int line, const char *text)
{
  check_count++;
  if (!holds && ++check_failures <= 20) printf("%s:%d: %s\n", file, line, text);
  return holds;
}

static inline int check_near(double value, double expected, double tolerance, const char *file, int line, const char *text)
{
  const int holds = fabs(value - expected) <= tolerance;
  check_count++;
  if (!holds && ++check_failures <= 20) printf("%s:%d: %s = %.17g, not %.17g +- %.3g\n", file, line, text, value, expected, tolerance);
  return holds;
}

static inline int check_text(const char *text, const char *part, const char *file, int line)
{
  const int holds = strstr(text, part) != NULL;
  check_count++;
  if (!holds && ++check_failures <= 20) printf("%s:%d: '%s' does not say '%s'\n", file, line, text, part);
  return holds;
}

static inline int check_report(void)
{
  printf("%d checks, %d failed\n", check_count, check_failures);
  return check_failures > 0 || check_count == 0;
}

#define CHECK(condition) check_that((condition) ? 1 : 0, __FILE__, __LINE__, #condition)
/* |value - expected| <= tolerance; a NaN fails. */
#define CHECK_NEAR(value, expected, tolerance) check_near(value, expected, tolerance, __FILE__, __LINE__, #value)
#define CHECK_RELATIVE(value, expected, tolerance) check_near(value, expected, (tolerance) * fabs(expected), __FILE__, __LINE__, #value)
#define CHECK_SAYS(text, part) check_text(text, part, __FILE__, __LINE__)

#endif
