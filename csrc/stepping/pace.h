/* How chosen steps lie in time, in memory that does not grow with their number. */
#ifndef ZD_PACE_H
#define ZD_PACE_H

#include <stdint.h>

#include "../workspace.h"

enum { ZD_PACE = 256 };

typedef struct zd_pace {
    double *t;              /* (ZD_PACE,): t[i] is where step i * stride ended, the start for i = 0 */
    int count;
    int64_t stride, left;   /* steps between two of these; until the next */
} zd_pace;

zd_pace zd_pace_take(zd_arena *arena, double t0);
void zd_pace_keep(zd_pace *pace, double t);
void zd_pace_half(const zd_pace *pace, double *from, double *to);   /* the shortest span of time with half of the steps */
static inline void zd_pace_step(zd_pace *pace, double t)
{
    if (--pace->left == 0) zd_pace_keep(pace, t);
}

#endif
