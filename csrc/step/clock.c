#include "step_loop.h"

#include <math.h>
#include <time.h>

#include "../zerodrift.h"

double zd_count_steps(double t0, double t1, double step)
{
    if (!(step > 0)) return 0;
    double ratio = (t1 - t0) / step, rounded = round(ratio);
    if (t1 > t0 && ratio == 0) return 1;        /* the quotient has underflowed */
    return fabs(ratio - rounded) <= 1e-9 * rounded ? rounded : ceil(ratio);
}

/* clock() is elapsed time on Windows, and CPU time of all threads elsewhere; some libraries for Windows have no timespec_get(). */
double zd_seconds_now(void)
{
#ifdef _WIN32
    return (double)clock() / CLOCKS_PER_SEC;
#else
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
#endif
}
