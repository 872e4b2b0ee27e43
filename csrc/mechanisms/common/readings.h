/* Access to values and rates of gauges at one state. */
#ifndef ZD_COMMON_READINGS_H
#define ZD_COMMON_READINGS_H

typedef struct zd_readings {
    double (*value)(const void *mechanism, const void *frame, int gauge);
    double (*rate)(const void *mechanism, const void *frame, int gauge);
    const void *mechanism, *frame;
    double *x, *xdot, *out;     /* inputs of user functions, (longest,) each, and their output, (longest + 3,) */
} zd_readings;

static inline double zd_value_of(const zd_readings *at, int gauge) { return at->value(at->mechanism, at->frame, gauge); }
static inline double zd_rate_of(const zd_readings *at, int gauge) { return at->rate(at->mechanism, at->frame, gauge); }

#endif
