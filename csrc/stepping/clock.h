/* The times of steps of fixed size, and the time of day. */
#ifndef ZD_CLOCK_H
#define ZD_CLOCK_H

#include <stdint.h>

/* When a step of fixed size ends, the last of them at `end`. Never accumulated, so that slicing a run changes nothing. */
double zd_time_of_step(double t0, double size, int64_t step, int64_t steps, double end);
double zd_seconds_now(void);

#endif
