/* The course of a run: where it has got to, and what its next step is made with. */
#ifndef ZD_STEP_LOOP_H
#define ZD_STEP_LOOP_H

#include "../safeguards/safeguards.h"
#include "step_histogram.h"
#include "step.h"

typedef struct zd_control { /* where steps are chosen */
    double h;               /* the next step */
    zd_step_histogram histogram;           /* where the steps have been */
    double *scale;          /* (size,): what the error is measured in */
    double move;            /* of the step made last: its largest change of a coordinate, in units of max_move; 0: there is none */
    int at_limit;           /* steps that were as long as stability allows */
    int below_limit;        /* steps in succession that were shorter */
} zd_control;

typedef struct zd_step_loop {
    const zd_settings *settings;
    zd_motion *motion;
    zd_stepper *stepper;
    zd_safeguards *safeguards;
    double end;             /* s: t1 of the settings, or where an event has ended the run */
    int64_t step;              /* the number of the step being made, from 1 */
    int64_t steps;             /* how many there will be, where they are of fixed size */
    zd_state *undivided;    /* where the step began that is made in parts; NULL until there is one */
    int parts;              /* how many the step is made in; 0: it is undivided */
    zd_control control;
} zd_step_loop;

/* Whether the step is one of every so many, or the last, or made in parts. */
static inline int zd_step_loop_is_due(const zd_step_loop *loop, int64_t every)
{
    return zd_is_one_of(every, loop->step) || loop->stepper->t == loop->end || loop->parts;
}

/* Whether all corrections that are on were made at the end of the step. */
static inline int zd_step_loop_is_corrected(const zd_step_loop *loop)
{
    return zd_motion_is_corrected(loop->motion, loop->step) || loop->stepper->t == loop->end || loop->parts;
}

/* Back to where the step began, to make it in (p, v), with safeguards that may have seen its end already. */
int zd_step_loop_use_dependent(zd_step_loop *loop);
/* take_step.c: the next step, of fixed size or as the error asked for allows. */
int zd_step_loop_take_step(zd_step_loop *loop);

#endif
