/* A run and its components. */
#ifndef ZD_RUN_H
#define ZD_RUN_H

#include "../motion/motion.h"
#include "../output/between.h"
#include "../output/events.h"
#include "../output/record.h"
#include "../safeguards/safeguards.h"
#include "../step/step_loop.h"
#include "../paths/stepper.h"

enum { ZD_MESSAGE = 500 };

typedef struct zd_outcome { /* the end of the run, once reached */
    int status;
    char message[ZD_MESSAGE];
} zd_outcome;

typedef struct zd_goal {    /* end of the present advance of an open run */
    int64_t step;           /* number of its last step; INT64_MAX: none */
    zd_state good;          /* start of the present step, to which a failure returns; open runs only */
    int64_t good_step;      /* number of steps made there */
    double good_h;          /* s: adaptive steps: size of the next step there */
} zd_goal;

typedef struct zd_held_inputs {     /* inputs of the settings, as the present step has them */
    double *value;          /* (count + measures,) */
    double *measured, *scratch;     /* a measure; scratch memory of the measures */
    int64_t measured_step;  /* number of steps made when the measures were read, + 1 */
    int is_new;             /* true if they changed since the last step */
    int has_ramp;           /* true if the last step followed a speed, which is constant in the next */
} zd_held_inputs;

struct zd_run {
    zd_memory *memory;      /* its own, without what is allocated on demand */
    zd_memory *start;       /* (nq + nv,): p0 and v0, from zd_state_begin(); NULL: its state cannot be saved */
    zd_settings settings;
    zd_motion motion;
    zd_stepper stepper;
    zd_safeguards safeguards;
    zd_step_loop loop;
    zd_recorder recorder;
    zd_output output;       /* samples and events between steps, if requested */
    zd_watch watch;
    zd_tally tally;
    zd_outcome outcome;
    zd_goal goal;
    zd_held_inputs held;
};

#endif
