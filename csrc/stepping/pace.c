/* How chosen steps lie in time: the times of every so many of them are kept; where there is no room left, every other one is let go. */
#include "pace.h"

zd_pace zd_pace_take(zd_arena *arena, double t0)
{
    zd_pace pace = {zd_take_doubles(arena, ZD_PACE), 1, 1, 1};
    if (pace.t) pace.t[0] = t0;
    return pace;
}

void zd_pace_keep(zd_pace *pace, double t)
{
    if (pace->count == ZD_PACE) {
        for (int i = 0; 2 * i < ZD_PACE; i++) pace->t[i] = pace->t[2 * i];
        pace->count = ZD_PACE / 2;
        pace->stride *= 2;
    }
    pace->t[pace->count++] = t;
    pace->left = pace->stride;
}

void zd_pace_half(const zd_pace *pace, double *from, double *to)
{
    int half = pace->count / 2;
    *from = pace->t[0];
    *to = pace->t[half];
    for (int i = 1; i + half < pace->count; i++) {
        if (!(pace->t[i + half] - pace->t[i] < *to - *from)) continue;
        *from = pace->t[i];
        *to = pace->t[i + half];
    }
}
