/* One step of a run: step.c */
#ifndef ZD_STEP_H
#define ZD_STEP_H

#include "step_loop.h"

/* Makes the next step of the run, fixed or adaptive. */
int zd_step(zd_step_loop *loop);
/* Makes a step to a time within the last one, from where the stepper is, with all corrections. */
int zd_substep(zd_step_loop *loop, double t);
/* Makes one attempt on the present evaluation path. */
int zd_step_attempt(zd_step_loop *loop, const zd_attempt *attempt);

#endif
