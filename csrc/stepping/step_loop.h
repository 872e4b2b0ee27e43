/* Step loop of a run: its progress, and the control of its next step. */
#ifndef ZD_STEP_LOOP_H
#define ZD_STEP_LOOP_H

#include "../safeguards/safeguards.h"
#include "step_histogram.h"
#include "step.h"

typedef struct zd_control { /* control of adaptive steps */
    double h;               /* s: size of the next step */
    zd_step_histogram histogram;    /* distribution of the steps in time */
    double *scale;          /* (size,): error scale, atol + rtol |y| */
    double move;            /* largest change of a coordinate in the last step, in units of max_move; 0: max_move is not set */
    int at_limit;           /* steps at the stability limit */
    int below_limit;        /* consecutive shorter steps */
} zd_control;

typedef struct zd_step_loop {
    const zd_settings *settings;
    zd_motion *motion;
    zd_stepper *stepper;
    zd_safeguards *safeguards;
    double end;             /* s: t1 of the settings, or the time of a terminal event */
    int64_t step;           /* number of the current step, from 1 */
    int64_t steps;          /* number of fixed steps of the run */
    zd_state *undivided;    /* start of a step that is repeated in parts; NULL until there is one */
    int parts;              /* number of these parts; 0: the step is not divided */
    zd_control control;
} zd_step_loop;

/* True if `every` divides the number of the step, or it is the last one, or one of several parts. */
static inline int zd_step_loop_is_due(const zd_step_loop *loop, int64_t every)
{
    return zd_is_one_of(every, loop->step) || loop->stepper->t == loop->end || loop->parts;
}

/* True if all enabled corrections were applied at the end of the step. */
static inline int zd_step_loop_is_corrected(const zd_step_loop *loop)
{
    return zd_motion_is_corrected(loop->motion, loop->step) || loop->stepper->t == loop->end || loop->parts;
}

/* Returns to the start of the step, to repeat it in (p, v); resets safeguards that have already saved its end. */
int zd_step_loop_use_dependent(zd_step_loop *loop);
/* take_step.c: makes the next step, fixed or adaptive. */
int zd_step_loop_take_step(zd_step_loop *loop);

#endif
