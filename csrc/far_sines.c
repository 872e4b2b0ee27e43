/* Sines and reductions of large arguments, for libraries compiled without them. */
#include "include/zerodrift/sines.h"
#include "zerodrift.h"

void zd_far_sines(int n, const double *angle, double *s, double *c)
{
    zd_sines_far(n, angle, s, c);
}

void zd_far_reductions(int n, const double *angle, double *r, double *tail, uint64_t *quadrant)
{
    zd_reduce_those_far(n, angle, r, tail, quadrant);
}
