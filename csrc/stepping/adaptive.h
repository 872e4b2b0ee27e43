/* Steps of the size that the error asked for allows. */
#ifndef ZD_ADAPTIVE_H
#define ZD_ADAPTIVE_H

#include "step_loop.h"

zd_control zd_adaptive_take(zd_arena *arena, const zd_stepper *stepper, double t0);
/* Chooses the first step; work (3, size). */
int zd_adaptive_start(zd_step_loop *loop, double *work);
int zd_adaptive_step(zd_step_loop *loop);
/* Tells the integrator, where it makes a difference to its step from here, by what the error of that will be measured, about. */
void zd_adaptive_weigh(zd_step_loop *loop);

#endif
