/* The operations of SUNDIALS' serial vector that take most of the time of a step, compiled once for each instruction set. */
#include <math.h>
#include <string.h>

#include "base/variant.h"
#include "stepping/blocks.h"
#include "stepping/vectors.h"

static long length_of(N_Vector v) { return (long)N_VGetLength(v); }

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  const double *from = N_VGetArrayPointer(x), *other = N_VGetArrayPointer(y);
  double       *to = N_VGetArrayPointer(z);
  const long    n = length_of(x);
  TRB_LANES for (long i = 0; i < n; i++) to[i] = a * from[i] + b * other[i];
}

static void constant(sunrealtype a, N_Vector z)
{
  double    *to = N_VGetArrayPointer(z);
  const long n = length_of(z);
  for (long i = 0; i < n; i++) to[i] = a;
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
  const double *from = N_VGetArrayPointer(x);
  double       *to = N_VGetArrayPointer(z);
  const long    n = length_of(x);
  TRB_LANES for (long i = 0; i < n; i++) to[i] = a * from[i];
}

/* Sum of squares of the weighted entries, no more than TRB_NP of them. */
static double sum_squares(const double *value, const double *weight, int n)
{
  double square[TRB_NP], sum = 0.0;
  for (int k = 0; k < n; k++) square[k] = value[k] * weight[k] * (value[k] * weight[k]);
  for (int k = 0; k < n; k++) sum += square[k];
  return sum;
}

static double mean_square(const double *value, const double *weight, int n)
{
  double sum = 0.0;
  for (int k = 0; k < n; k += TRB_NP) sum += sum_squares(value + k, weight + k, n - k < TRB_NP ? n - k : TRB_NP);
  return sum / n;
}

/* The same of a roller whose skew and tilt swing fast, with the spins that belong to them: these count by a share. */
static double swinging(const double *value, const double *weight, double share)
{
  const int swings[] = {TRB_ROLLER_skew, TRB_ROLLER_tilt, TRB_ROLLER_omega_n, TRB_ROLLER_omega_t};
  double    counts[TRB_NR];
  memcpy(counts, weight, sizeof counts);
  for (size_t i = 0; i < sizeof swings / sizeof *swings; i++) counts[swings[i]] *= share;
  return sum_squares(value, counts, TRB_NR);
}

/* The larger one; not a number (NaN) if either is none. */
static double larger(double a, double b) { return a >= b || isnan(a) ? a : b; }

/* The largest root mean square of a body. The mean over all entries would let a single roller, or a cage that hits its rollers, be
 * wrong by the root of the number of bodies times the tolerance. The tail of the state controls nothing. If an entry is not a number
 * (NaN), so is the norm. */
static sunrealtype norm_of_bodies(N_Vector x, N_Vector w)
{
  const double    *value = N_VGetArrayPointer(x), *weight = N_VGetArrayPointer(w);
  trb_body_entries entries;
  double           largest = 0.0;
  memcpy(&entries, value + length_of(x), sizeof entries);
  int at = entries.n_rollers * TRB_NR;
  for (int b = 0; b < entries.n_bodies; b++) {
    largest = larger(largest, mean_square(value + at, weight + at, entries.size[b]));
    at += entries.size[b];
  }
  for (int j = 0; j < entries.n_rollers; j++) {
    const double *own = value + j * TRB_NR, *per = weight + j * TRB_NR;
    const double  share = entries.swings == NULL ? 1.0 : entries.swings[j];
    largest = larger(largest, (share == 1.0 ? sum_squares(own, per, TRB_NR) : swinging(own, per, share)) / TRB_NR);
  }
  return sqrt(largest);
}

void TRB_JOIN(trb_vector_use_, TRB_KERNEL_VARIANT)(N_Vector v)
{
  v->ops->nvconst = constant;
  v->ops->nvlinearsum = linear_sum;
  v->ops->nvscale = scale;
  v->ops->nvwrmsnorm = norm_of_bodies;
}
