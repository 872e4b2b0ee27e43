/* Times of fixed steps, and the wall clock. */
#ifndef ZD_CLOCK_H
#define ZD_CLOCK_H

#include <stdint.h>

/* Time at the end of a fixed step; the last one ends at `end`. Never accumulated, so that slices of a run do not change it. */
static inline double zd_time_of_step(double t0, double size, int64_t step, int64_t steps, double end)
{
    return step == steps ? end : t0 + (double)step * size;
}
double zd_seconds_now(void);

#endif
