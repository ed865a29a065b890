/* The operations of SUNDIALS' serial vector that a step is full of, compiled once an instruction set as the other kernels are. */
#include <math.h>

#include "stepping/vectors.h"

#ifndef TRB_KERNEL_VARIANT
#define TRB_KERNEL_VARIANT scalar
#endif
#define TRB_JOIN_(a, b) a##b
#define TRB_JOIN(a, b) TRB_JOIN_(a, b)

enum { ACCUMULATORS = 16 };

static long length_of(N_Vector v) { return (long)N_VGetLength(v); }

/* z may be x or y: entries are read before they are written, but the compiler has to be told. */
#if defined(__GNUC__) && !defined(__clang__)
#define ENTRIES _Pragma("GCC ivdep")
#else
#define ENTRIES
#endif

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  const double *from = N_VGetArrayPointer(x), *other = N_VGetArrayPointer(y);
  double       *to = N_VGetArrayPointer(z);
  const long    n = length_of(x);
  ENTRIES for (long i = 0; i < n; i++) to[i] = a * from[i] + b * other[i];
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
  ENTRIES for (long i = 0; i < n; i++) to[i] = a * from[i];
}

static sunrealtype rms_norm(N_Vector x, N_Vector w)
{
  const double *value = N_VGetArrayPointer(x), *weight = N_VGetArrayPointer(w);
  const long    n = length_of(x), whole = n - n % ACCUMULATORS;
  double        sums[ACCUMULATORS] = {0}, sum = 0.0;
  for (long i = 0; i < whole; i += ACCUMULATORS)
    for (int k = 0; k < ACCUMULATORS; k++) sums[k] += value[i + k] * weight[i + k] * (value[i + k] * weight[i + k]);
  for (long i = whole; i < n; i++) sums[i - whole] += value[i] * weight[i] * (value[i] * weight[i]);
  for (int k = 0; k < ACCUMULATORS; k++) sum += sums[k];
  return sqrt(sum / (double)n);
}

void TRB_JOIN(trb_vector_use_, TRB_KERNEL_VARIANT)(N_Vector v)
{
  v->ops->nvconst = constant;
  v->ops->nvlinearsum = linear_sum;
  v->ops->nvscale = scale;
  v->ops->nvwrmsnorm = rms_norm;
}
