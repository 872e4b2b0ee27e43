/* A run and its components. */
#ifndef ZD_RUN_H
#define ZD_RUN_H

#include "../motion/motion.h"
#include "../output/within_step.h"
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

typedef struct zd_speeds_before {   /* speeds at the start of the step, to which a failed one returns */
    double *place;          /* (places, 3) */
    int is_new, has_ramp;
    int64_t jumps;
} zd_speeds_before;

typedef struct zd_held_inputs {     /* inputs of the settings, as the present step has them */
    double *value;          /* (count,) */
    unsigned char *has_changed;     /* (count,): 1 for inputs that changed since the last step */
    zd_speeds_before before;
    zd_jump jump;           /* the last one; open for runs whose speeds jump only */
    zd_state start;         /* state at which it is made */
    double *rhs, *x;        /* (m,), (nv,): Psi, and the change of velocities */
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

/* Recomputes what the system derives from its data, after a change of inputs. */
static inline void zd_inputs_derive(const zd_inputs *inputs)
{
    for (int i = 0; i < inputs->derivations; i++) inputs->derive[i](inputs->data[i]);
}

/* jump.c: a jump of speeds, before and after the new ones are written; the second function moves the velocities. */
int zd_jump_begin(zd_run *run);
int zd_jump_end(zd_run *run);
/* Sets each speed that is an input to the number which the velocities at the point fit. Psi (m,) is overwritten. */
int zd_speeds_fit(zd_run *run, double *Psi);
/* The sentence on the speed that differs most from its input after that. */
void zd_speeds_say(const zd_run *run, char *to, size_t size);

#endif
