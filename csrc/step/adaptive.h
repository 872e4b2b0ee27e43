/* Adaptive steps. */
#ifndef ZD_ADAPTIVE_H
#define ZD_ADAPTIVE_H

#include "step_loop.h"

zd_control zd_adaptive_create(zd_arena *arena, const zd_stepper *stepper, double t0);
/* Chooses the size of the first step; work (3, size). */
int zd_adaptive_start(zd_step_loop *loop, double *work);
/* Passes the approximate error scale of the next step to an integrator that needs it. */
void zd_adaptive_set_scale(zd_step_loop *loop);

#endif
