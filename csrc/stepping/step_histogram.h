/* How chosen steps lie in time, in memory that does not grow with their number. */
#ifndef ZD_STEP_HISTOGRAM_H
#define ZD_STEP_HISTOGRAM_H

#include <stdint.h>

#include "../workspace.h"

enum { ZD_STEP_HISTOGRAM = 256 };

typedef struct zd_step_histogram {
    double *t;              /* (ZD_STEP_HISTOGRAM,): t[i] is where step i * stride ended, the start for i = 0 */
    int count;
    int64_t stride, left;   /* steps between two of these; until the next */
} zd_step_histogram;

zd_step_histogram zd_step_histogram_take(zd_arena *arena, double t0);
void zd_step_histogram_keep(zd_step_histogram *histogram, double t);
void zd_step_histogram_half(const zd_step_histogram *histogram, double *from, double *to);   /* the shortest span of time with half of the steps */
static inline void zd_step_histogram_step(zd_step_histogram *histogram, double t)
{
    if (--histogram->left == 0) zd_step_histogram_keep(histogram, t);
}

#endif
