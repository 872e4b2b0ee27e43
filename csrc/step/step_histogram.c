/* Distribution of adaptive steps in time: the end of every stride-th step is saved; when the array is full, the stride doubles. */
#include "step_loop.h"

zd_step_histogram zd_step_histogram_create(zd_arena *arena, double t0)
{
    zd_step_histogram histogram = {zd_arena_doubles(arena, ZD_STEP_HISTOGRAM), 1, 1, 1};
    if (histogram.t) histogram.t[0] = t0;
    return histogram;
}

void zd_step_histogram_save(zd_step_histogram *histogram, double t)
{
    if (histogram->count == ZD_STEP_HISTOGRAM) {
        for (int i = 0; 2 * i < ZD_STEP_HISTOGRAM; i++) histogram->t[i] = histogram->t[2 * i];
        histogram->count = ZD_STEP_HISTOGRAM / 2;
        histogram->stride *= 2;
    }
    histogram->t[histogram->count++] = t;
    histogram->left = histogram->stride;
}

void zd_step_histogram_half(const zd_step_histogram *histogram, double *from, double *to)
{
    int half = histogram->count / 2;
    *from = histogram->t[0];
    *to = histogram->t[half];
    for (int i = 1; i + half < histogram->count; i++) {
        if (!(histogram->t[i + half] - histogram->t[i] < *to - *from)) continue;
        *from = histogram->t[i];
        *to = histogram->t[i + half];
    }
}
