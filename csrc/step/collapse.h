/* Collapse of adaptive steps at one place, as where a force jumps back and forth with the sign of a speed. */
#ifndef ZD_COLLAPSE_H
#define ZD_COLLAPSE_H

#include "../paths/path.h"

typedef struct zd_collapse {
    double share;           /* size of a step below which it may count, relative to the span of the run; 0: none counts */
    int64_t count;          /* steps counted at one place */
    double t, h;            /* s: start of the first of them, and size of the last */
    double *rate;           /* (nv,): mean accelerations in the last of them */
    double *change;         /* (nv,): sum of their changes from one to the next, in characteristic scales */
} zd_collapse;

zd_collapse zd_collapse_create(zd_arena *arena, int nv);
/* `most`: settings->max_steps */
void zd_collapse_begin(zd_collapse *self, int64_t most);
/* Counts the step of size h just made, whose error scale is `scale` (size,); ZD_COLLAPSED at the last that is allowed at one place. */
int zd_collapse_count(zd_collapse *self, const zd_stepper *stepper, double h, const double *scale);
int zd_collapse_velocity(const zd_collapse *self, int nv);      /* index of the velocity whose rate changed most */

#endif
