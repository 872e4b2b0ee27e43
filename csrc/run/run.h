/* A run and its components. */
#pragma once

#include "../motion/motion.h"
#include "../output/reading.h"
#include "../output/watch.h"
#include "../output/within_step.h"
#include "../safeguards/safeguards.h"
#include "../state/stepper.h"
#include "../step/step_loop.h"
#include "../zerodrift.h"

enum { ZD_MESSAGE = 500 };

typedef struct zd_outcome { /* the end of the run, once reached */
    int status;
    char message[ZD_MESSAGE];
} zd_outcome;

typedef struct zd_goal {    /* end of the present advance */
    int64_t step;           /* number of its last step; INT64_MAX: none */
    double end;             /* s: end of the loop before an event has cut the step */
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

typedef struct zd_phases zd_phases;

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
    zd_phases *phases;      /* phases.h; NULL: the system has no groups */
};

/* Recomputes what the system derives from its data, after a change of inputs. */
static inline void zd_inputs_derive(const zd_inputs *inputs)
{
    for (int i = 0; i < inputs->derivations; i++) inputs->derive[i](inputs->data[i]);
}

/* jump.c: a jump of speeds, before and after the new ones are written; the second function moves the velocities. */
int zd_jump_begin(zd_run *run);
int zd_jump_finish(zd_run *run);
/* Sets each speed that is an input to the number which the velocities at the point fit. Psi (m,) is overwritten. */
int zd_speeds_fit(zd_run *run, double *Psi);
/* The sentence on the speed that differs most from its input after that. */
void zd_speeds_say(const zd_run *run, char *to, size_t size);

/* Creates a run at (t, p, v) and finds the rank of C there; the start is not checked yet. NULL without memory, with status and message;
 * otherwise `status` is that of finding the rank. `at`: where the run is to be; NULL: in its own memory. */
zd_run *zd_run_open(zd_run *at, const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size);

/* Releases the memory of its components, in which a run may be itself. */
void zd_plan_free(zd_run *run);

/* Checks the start, the system and the tolerance, and prepares the first step. `status` is that of finding the rank. */
int zd_run_start(zd_run *run, int status, const double *p0, const double *v0);
/* The same from another start with other data, for a run that is not advanced afterwards: sets its scales, energy and first step, and the
 * acceleration if it has no closed-form functions. ZD_SINGULAR if neither closed-form functions nor blocks apply at this start. */
size_t zd_run_start_memory(const zd_run *run);      /* bytes of temporary memory for zd_run_start_elsewhere() */
int zd_run_start_elsewhere(zd_run *run, void *memory, const void *data, const double *p0, const double *v0);
/* Measures sizes anew at the present point, and compares positions with them: the largest violation, and true if a start may have it. */
int zd_start_measure(zd_run *run, double *violation, int *is_allowed);
/* Checks that a start satisfies the constraints within the tolerance; Psi (m,) is overwritten. */
int zd_start_check(zd_run *run, double *Psi);

/* Inputs of a run. */

/* Memory for the inputs of a run, which are those of its settings. */
zd_held_inputs zd_inputs_create(zd_arena *arena, const zd_inputs *inputs, const zd_motion *motion);
/* True if one of them is a speed; the place is that of a given input. */
int zd_inputs_have_speeds(const zd_inputs *inputs);
/* Reads the inputs at the start of an advance; ZD_BAD_INPUT leaves the ones before. */
int zd_inputs_read(zd_run *run);
/* Number of the doubles at the places of inputs; these copied from there, and written to them with what is derived from them. */
size_t zd_inputs_numbers(const zd_inputs *inputs);
void zd_inputs_save(const zd_inputs *inputs, double *to);
void zd_inputs_restore(const zd_inputs *inputs, const double *from);
/* Writes new inputs, none of which is a speed, to their places. */
void zd_inputs_write(zd_run *run);
/* Ends the ramps of speeds that were followed, begins new ones, or makes their jumps; limits the step to the end of a ramp. */
int zd_inputs_begin_step(zd_run *run);
/* Returns speeds to the start of the step. */
void zd_inputs_return(zd_run *run);

/* Open runs: the goal of the present advance, and the return from a step that failed. */

/* Removes the time and the step at which it ends. */
void zd_run_remove_end(zd_run *run);
/* Beginning of a step: an open run saves its start, and inputs are written. */
int zd_run_begin_step(zd_run *run);
/* Leaves the event at which the run has ended, or acts: it is armed again once its function has left zero. */
void zd_run_leave_event(zd_run *run);
/* Acts at the events of the present instant. ZD_PAUSED: it goes on, or the caller acts first; ZD_DONE: nothing acts, or an event ends it. */
int zd_run_act(zd_run *run);
/* Explains why the run ends; an open run that failed returns to the start of the step, from where it can go on. */
int zd_run_finish(zd_run *run, int status);

/* Writes the run's message, if it has none yet; returns the status, or a more specific one. */
int zd_explain(zd_run *run, int status);
/* Writes the beginning of a message, with time and step; returns its length. `steps` is 0 if their number is not known in advance. */
size_t zd_say_where(char *to, size_t size, double t, int64_t step, int64_t steps);
void zd_say_event(char *to, size_t size, int event);    /* message of a run ended by this event */

/* Meaning of a status, as a sentence. */

const char *zd_sentence(int status);

/* States between the samples of a finished run that saved every step. */

typedef struct zd_resample {
    zd_run *run;            /* a run from the same start, not advanced yet */
    const zd_saved *saved;
    int64_t sample;         /* sample at the start of the step repeated last; -1: none */
    int64_t known_samples;  /* number of samples whose comparisons at which forces jump are known */
    int is_general;         /* true if that step leaves the closed-form path for the matrix path */
    int has_polynomial;     /* true if its dense output is available */
} zd_resample;

/* Moves the run to time t, between the first and the last sample. */
int zd_resample_move(zd_resample *self, double t);
