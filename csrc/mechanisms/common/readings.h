/* Access to values and rates of marker quantities at one state. */
#ifndef ZD_COMMON_READINGS_H
#define ZD_COMMON_READINGS_H

typedef struct zd_readings {
    double (*value)(const void *mechanism, const void *frame, int quantity);
    double (*rate)(const void *mechanism, const void *frame, int quantity);
    const void *mechanism, *frame;
    const double *inputs;       /* values of the user functions of forces, if some of these read reactions */
    double *x, *xdot, *out;     /* inputs of user functions, (longest,) each, and their output, (longest + 3,) */
} zd_readings;

static inline double zd_value_of(const zd_readings *at, int quantity) { return at->value(at->mechanism, at->frame, quantity); }
static inline double zd_rate_of(const zd_readings *at, int quantity) { return at->rate(at->mechanism, at->frame, quantity); }

#endif
