/* The core's roots, for a test to call: compiled together with csrc/linalg/roots.c. */
#include "linalg/roots.h"

void hypotenuses(int n, const double *x, const double *y, double *to)
{
    for (int i = 0; i < n; i++) to[i] = zd_hypotenuse(x[i], y[i]);
}

void roots(int n, int k, const double *x, double *to)
{
    for (int i = 0; i < n; i++) to[i] = zd_root(x[i], k);
}
