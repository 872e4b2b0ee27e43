/* Step loop of a run: its progress, and the control of its next step. */
#pragma once

#include <stdint.h>

#include "../linalg/bracket.h"
#include "../paths/path.h"
#include "../workspace.h"

/* The wall clock. */

double zd_seconds_now(void);

/* Distribution of adaptive steps in time, in memory of fixed size. */

enum { ZD_STEP_HISTOGRAM = 256 };

typedef struct zd_step_histogram {
    double *t;              /* (ZD_STEP_HISTOGRAM,), s: end of step i * stride; the start of the run for i = 0 */
    int count;              /* saved times */
    int64_t stride, left;   /* steps between two saved times; steps until the next */
} zd_step_histogram;

zd_step_histogram zd_step_histogram_create(zd_arena *arena, double t0);
void zd_step_histogram_save(zd_step_histogram *histogram, double t);
void zd_step_histogram_half(const zd_step_histogram *histogram, double *from, double *to);   /* shortest interval with half of the steps */
static inline void zd_step_histogram_step(zd_step_histogram *histogram, double t)
{
    if (--histogram->left == 0) zd_step_histogram_save(histogram, t);
}

/* Collapse of adaptive steps at one place, as where a force jumps back and forth with the sign of a speed. */

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
/* Counts the step of size h just made, whose error scale is `scale` (size,), NULL if it ended at a jump; ZD_COLLAPSED at the last that is
 * allowed at one place. */
int zd_collapse_count(zd_collapse *self, const zd_stepper *stepper, double h, const double *scale);
int zd_collapse_velocity(const zd_collapse *self, int nv);      /* index of the velocity whose rate changed most */

/* Attempts at a step. */
enum zd_attempt_kind {
    ZD_NEW_STEP,            /* step of the run, with error estimate and checks */
    ZD_THROUGH_BIFURCATION, /* the same, repeated with checks alone */
    ZD_REPEATED_STEP,       /* step between two samples of an earlier run, without checks */
    ZD_SUBSTEP,             /* step to a time within one of the run, without checks */
};
typedef struct zd_attempt {
    enum zd_attempt_kind kind;
    int forced;             /* true if all corrections are applied, due or not */
    int64_t step;           /* number of the step, by which corrections are due */
    double h, t1;           /* s: size, and time at the end */
} zd_attempt;

typedef struct zd_stiffness {
    int at_limit;           /* steps at the stability limit */
    int below_limit;        /* consecutive shorter steps */
} zd_stiffness;

typedef struct zd_control { /* control of adaptive steps */
    double h;               /* s: size of the next step */
    double bounded;         /* s: size of the current attempt, before rounding of its end */
    double smallest;        /* s: step size underflow */
    double longest;         /* s: bound of the size by contacts; INFINITY: none */
    double largest_factor;  /* ratio of the next size to the current one */
    double norm;            /* error estimate of the last attempt, RMS in units of scale; 0: fixed steps */
    double move;            /* largest change of a coordinate in the last step, in units of max_move; 0: max_move is not set */
    int is_by_move;         /* true if max_move has set h */
    zd_step_histogram histogram;    /* distribution of the steps in time */
    double *scale;          /* (size,): error scale, atol + rtol |y| */
    zd_stiffness stiffness;
    zd_collapse collapse;
} zd_control;

/* True if the error estimate and the change of coordinates in the last attempt are small enough. */
static inline int zd_control_accepts(const zd_control *control) { return control->norm <= 1 && control->move <= 1; }

/* Comparisons at which forces jump, as the present step has them. */

typedef struct zd_switching {
    int count;
    double *side;           /* (count,) sign that a difference is taken to have, see zd_system.switches */
    double *written;        /* (count,) the same at its place */
    double *before, *now;   /* (count,) differences at the start and the end of the attempt */
    double t_before;        /* s: time of the first */
    double *rate_before, *rate_now; /* (count,) their rates */
    zd_state ahead;         /* a state a little later */
    zd_bracket bracket;     /* s: the instant that is sought */
    double *largest;        /* (count,) the largest |difference| at samples; of steps that are repeated */
    double *at_a;           /* (count,) differences at its first end */
    int sought;             /* its switch; -1: none */
    int holds;              /* true if a side is not zero at its place */
    double h;               /* s: size of the step in which it was found */
    int is_released;        /* true if the step has failed with switches held */
    int is_shortened;       /* true if the step ends at a minimum of a difference */
    int is_cut;             /* true if the step ended at a change */
} zd_switching;

typedef struct zd_step_loop zd_step_loop;

/* Sizes of steps: fixed.c, adaptive.c. NULL: nothing is done. */
typedef struct zd_step_sizes {
    int (*begin)(zd_step_loop *loop);   /* before the first attempt at a step */
    int (*next)(zd_step_loop *loop, zd_attempt *attempt);   /* size and end of the next attempt */
    void (*set_scale)(zd_step_loop *loop);  /* passes the approximate error scale to an integrator that needs it */
    int (*estimate)(zd_step_loop *loop, const zd_attempt *attempt);     /* control.norm and control.move of an integrated step */
    /* True if another attempt follows this one with *status; otherwise *status is that of the step. Not called for a whole fixed step that
     * succeeded. */
    int (*repeats)(zd_step_loop *loop, int *status);
} zd_step_sizes;

extern const zd_step_sizes zd_fixed_sizes, zd_adaptive_sizes;

struct zd_step_loop {
    const zd_settings *settings;
    zd_motion *motion;
    zd_stepper *stepper;
    zd_safeguards *safeguards;
    const zd_step_sizes *sizes;     /* fixed or adaptive */
    double end;             /* s: t1 of the settings, the time of a terminal event, or that to which an open run advances; INFINITY: none */
    double limit;           /* s: time that the current step does not pass, the end of an input's ramp; INFINITY: none */
    double before_break;    /* s: the same, shortly before the next break of the system */
    int64_t step;           /* number of the current step, from 1 */
    int64_t steps;          /* number of the fixed step that ends at `end`; 0: none */
    double t_begin;         /* s: time from which fixed steps are counted */
    int64_t steps_before;   /* number of steps before that time */
    zd_state undivided;     /* start of a step that is repeated in parts; of fixed steps only */
    int parts, part;        /* number of these parts, 0: the step is not divided; the current one, from 1 */
    zd_control control;
    zd_switching switching; /* adaptive steps */
};

static inline int zd_is_adaptive(const zd_step_loop *loop) { return loop->sizes == &zd_adaptive_sizes; }

/* True if `every` divides the number of the step, or it is the last one, or one of several parts. */
static inline int zd_step_loop_is_due(const zd_step_loop *loop, int64_t every)
{
    return zd_is_one_of(every, loop->step) || loop->stepper->t == loop->end || loop->parts;
}

/* s: latest end of the current step */
static inline double zd_step_loop_latest(const zd_step_loop *loop)
{
    const double limit = loop->before_break < loop->limit ? loop->before_break : loop->limit;
    return limit < loop->end ? limit : loop->end;
}

/* True if all enabled corrections were applied at the end of the step. */
static inline int zd_step_loop_is_corrected(const zd_step_loop *loop)
{
    return zd_motion_is_corrected(loop->motion, loop->step) || loop->stepper->t == zd_step_loop_latest(loop) || loop->parts;
}

/* Adaptive steps. */

zd_control zd_adaptive_create(zd_arena *arena, const zd_stepper *stepper, double t0);
/* Chooses the size of the first step; work (3, size). */
int zd_adaptive_start(zd_step_loop *loop, double *work);
/* Passes the approximate error scale of the next step to an integrator that needs it. */
void zd_adaptive_set_scale(zd_step_loop *loop);

/* Before an adaptive step: moves on to a break of the system that is next to the time, but not past the end, and finds the next one.
 * ZD_PAUSED after a jump of speeds. */
int zd_pass_break(zd_step_loop *loop);
/* Recomputes what is known at the point, after a change of what is not its state: of time by rounding, of inputs. */
int zd_renew(zd_step_loop *loop);

zd_switching zd_switching_create(zd_arena *arena, const zd_motion *motion);
/* Before the attempts at an adaptive step. */
int zd_switching_begin(zd_step_loop *loop);
/* After an attempt with *status: true if another follows it, whose size is set, since a switch changes in it. */
int zd_switching_repeats(zd_step_loop *loop, int *status);
/* For steps that are repeated: reads the differences at a state. Holds the switches that change where a step between the last two states
 * begins or ends, as between them; true if there are any. Takes the other sides, as this may err where a switch changes at both ends. */
void zd_switching_compare(zd_step_loop *loop, double t, const double *p, const double *v);
int zd_switching_hold_between(zd_step_loop *loop);
void zd_switching_turn(zd_step_loop *loop);
/* Lets the comparisons decide. */
void zd_switching_release(zd_step_loop *loop);

/* Passage through a bifurcation within a step. */

/* Finds the bifurcation in the step to t1; *found: true if the motion is continuous where the sign of the orientation changes. `make`: makes
 * a step to a time from the start of the last one, corrected but without checks. */
int zd_passage_find(zd_step_loop *loop, double t1, int (*make)(zd_step_loop *loop, double t), int *found);

/* One step of a run: step.c */

/* Makes the next step of the run, fixed or adaptive. */
int zd_step(zd_step_loop *loop);
/* Makes a step to a time within the last one, from where the stepper is, with all corrections. */
int zd_substep(zd_step_loop *loop, double t);
/* Makes one attempt on the present evaluation path. */
int zd_step_attempt(zd_step_loop *loop, const zd_attempt *attempt);
