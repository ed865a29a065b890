/* A fixed amount of work that never changes: what a second of this machine is worth (benchmarks/front.py). It is no part of trbdyn. One
 * unit inverts 12 by 12 matrices and takes exponentials and square roots of short arrays, as the steps of a bearing do. Prints the
 * processor time of one unit, in seconds, for each line that it reads. Do not change it: times of other days are divided by it. */
#include <math.h>
#include <stdio.h>
#include <time.h>

enum { N = 12, MATRICES = 4000, ELEMENTS = 96 };

static double invert(double a[N][N])
{
  double sum = 0.0;
  for (int p = 0; p < N; p++) {
    const double pivot = 1.0 / a[p][p];
    a[p][p] = 1.0;
    for (int c = 0; c < N; c++) a[p][c] *= pivot;
    for (int r = 0; r < N; r++) {
      if (r == p) continue;
      const double factor = a[r][p];
      a[r][p] = 0.0;
      for (int c = 0; c < N; c++) a[r][c] -= factor * a[p][c];
    }
  }
  for (int i = 0; i < N; i++) sum += a[i][(i + 1) % N];
  return sum;
}

static double unit(void)
{
  double a[N][N], x[ELEMENTS], sum = 0.0;
  for (int k = 0; k < MATRICES; k++) {
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) a[i][j] = (i == j ? 8.0 : 0.0) + 1.0 / (1.0 + (double)((i * 7 + j * 3 + k) % 11));
    sum += invert(a);
    for (int i = 0; i < ELEMENTS; i++) x[i] = (double)((i + k) % 17) * 0.1;
    for (int i = 0; i < ELEMENTS; i++) sum += exp(-x[i]) / sqrt(1.0 + x[i]);
  }
  return sum;
}

int main(void)
{
  volatile double kept = 0.0;
  for (int c = getchar(); c != EOF; c = getchar()) {
    if (c != '\n') continue;
    const clock_t began = clock();
    kept += unit();
    printf("%.9f\n", (double)(clock() - began) / CLOCKS_PER_SEC);
    (void)fflush(stdout);
  }
  return kept > 0.0 ? 0 : 1;
}
