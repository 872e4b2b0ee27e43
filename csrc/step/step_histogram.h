/* Distribution of adaptive steps in time, in memory of fixed size. */
#ifndef ZD_STEP_HISTOGRAM_H
#define ZD_STEP_HISTOGRAM_H

#include <stdint.h>

#include "../workspace.h"

enum { ZD_STEP_HISTOGRAM = 256 };

typedef struct zd_step_histogram {
    double *t;              /* (ZD_STEP_HISTOGRAM,), s: end of step i * stride; the start of the run for i = 0 */
    int count;              /* saved times */
    int64_t stride, left;   /* steps between two saved times; steps until the next */
} zd_step_histogram;

zd_step_histogram zd_step_histogram_create(zd_arena *arena, double t0);
void zd_step_histogram_save(zd_step_histogram *histogram, double t);
void zd_step_histogram_half(const zd_step_histogram *histogram, double *from, double *to);   /* shortest interval with half of the steps */
static inline void zd_step_histogram_step(zd_step_histogram *histogram, double t)
{
    if (--histogram->left == 0) zd_step_histogram_save(histogram, t);
}

#endif
