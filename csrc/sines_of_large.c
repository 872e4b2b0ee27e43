/* Sines and reductions of large arguments, for libraries compiled without them. */
#include "include/zerodrift/sines.h"
#include "zerodrift.h"

void zd_sines_of_large(int n, const double *angle, double *s, double *c)
{
    zd_large_sines(n, angle, s, c);
}

void zd_reductions_of_large(int n, const double *angle, double *r, double *tail, uint64_t *quadrant)
{
    zd_reduce_large_ones(n, angle, r, tail, quadrant);
}
