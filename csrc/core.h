/* The core's own words: a point of the motion, and what a row of each table consists of. */
#ifndef ZD_CORE_H
#define ZD_CORE_H

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "workspace.h"
#include "zerodrift.h"

/* ---- a point: all that is known at one (t, p, v), computed when first wanted and never twice ---- */

enum {                                  /* known beside the system's own terms */
    ZD_FACTORED = 1 << 16,              /* the formulation's leading matrix, at this (t, p) */
    ZD_ACCELERATED = 1 << 17,           /* vdot and lambda, at this (t, p, v) */
    ZD_COMPLEMENTED = 1 << 18,          /* the complement D and what goes with it, at this (t, p) */
    ZD_RANKED = 1 << 19,                /* which rows of C count, at this (t, p) */
    ZD_OF_VELOCITY = ZD_BIAS | ZD_FORCE | ZD_XI | ZD_POWER | ZD_GAMMA | ZD_ACCELERATED
};

typedef struct zd_rank zd_rank;         /* rank.h */

typedef struct zd_point {
    const zd_system *system;
    zd_statistics *statistics;
    int known;              /* what of all this is valid now */
    double t, *p, *v;
    zd_terms terms;
    double *vdot, *lambda;  /* (nv,), (m,) */
    double *force, *rhs;    /* (nv,), (m,): right sides being put together */
    zd_rank *rank;
    int rows, holonomic;    /* rows of C that count (m, unless some follow from others), and the holonomic ones, which come first */
    const double *C;        /* (rows, nv): those that count */
    double *unit, *per_unit;    /* (nv,): natural size of what each velocity is the rate of, see measure.c; and 1 / unit */
    double *per_unit_p;         /* (nq,): 1 / the same of the coordinates */
    double *size;           /* (m,): of the rows of C, and so of Phi, in these units */
    double *per_size;       /* (m,): 1 / size */
    int measured;           /* whether these are known */
    int culprit;            /* the coordinate or row that a failed factorization names */
    double defect;          /* what a failed iteration was left with */
} zd_point;

static inline int zd_constraints(const zd_system *system) { return system->mh + system->mn; }

zd_point *zd_point_take(zd_arena *arena, const zd_system *system, zd_statistics *statistics);
void zd_point_move(zd_point *point, double t, const double *p, const double *v);
void zd_point_move_velocity(zd_point *point, const double *v);
int zd_point_need_missing(zd_point *point, int missing);
void zd_point_force(const zd_point *point, double *force);          /* f - d */
void zd_point_velocity_violation(const zd_point *point, double *Psi);   /* (5); needs C, Phi_t */
void zd_point_rate(const zd_point *point, const double *v, double *pdot);   /* (1); needs A */
double zd_point_kinetic(const zd_point *point);     /* needs M */
double zd_point_potential(const zd_point *point);   /* needs V */
int zd_point_is_finite(const zd_point *point);      /* its p and v */
double zd_max_abs(int n, const double *x);          /* infinite if any is not a number */
double zd_max_scaled(int n, const double *x, const double *scale);    /* of |x_i| scale_i, likewise; measure.c */
int zd_point_measure(zd_point *point);              /* unit and size, from where the point is; measure.c */
double zd_point_violation(const zd_point *point);   /* largest |Phi| in units of its row's size; needs Phi */

/* Has the terms in `want` computed, those that the system has and that are not known yet. */
static inline int zd_point_need(zd_point *point, int want)
{
    int missing = want & point->system->provides & ~point->known;
    return missing ? zd_point_need_missing(point, missing) : ZD_DONE;
}

/* ---- a formulation: a leading matrix and its solve, and the state that is integrated ---- */

typedef struct zd_formulation {
    zd_card card;
    int violates;           /* ZD_PHI, ZD_C: which of (3), (5) its solutions drift from */
    int inverts_mass;       /* whether M has to be definite; else M is only where the constraints leave the velocities free */
    /* Both are told of as many constraints as are independent. */
    int (*state_size)(const zd_system *system);
    void *(*take)(zd_arena *arena, const zd_system *system);
    /* The leading matrix at the point, from M and the rows of C that count. */
    int (*factor)(void *self, zd_point *point);
    /* M x + C^T lambda = force, C x = rhs, with what was factored. force NULL: zero; lambda NULL: not wanted. */
    void (*solve)(void *self, const double *force, const double *rhs, double *x, double *lambda);
    int (*enter)(void *self, zd_point *point, double t, const double *y);   /* state -> (p, v) of the point */
    int (*leave)(void *self, zd_point *point, double *y);                   /* (p, v) of the point -> state */
    /* Gives the point the v that follows from its p and the state; NULL where v is part of the state. */
    int (*settle)(void *self, zd_point *point);
    int (*rate)(void *self, zd_point *point, double *ydot);                 /* needs the acceleration */
} zd_formulation;

/* ---- an integrator: one step of an opaque state ---- */

typedef struct zd_rate {
    int (*evaluate)(void *context, double t, const double *y, double *ydot);
    void *context;
    int size;               /* of the state */
} zd_rate;

typedef struct zd_integrator {
    zd_card card;
    const void *table;      /* coefficients, for methods that share a stepper */
    int (*suits)(const zd_system *system);      /* NULL: it takes any */
    void *(*take)(zd_arena *arena, const void *table, const zd_system *system, int size);
    int (*step)(void *self, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics);
    /* Instead of it, where rates are not enough and a step has constraints and impulses of its own. */
    int (*step_of_run)(void *self, zd_run *run, double h);
    double decay;           /* the largest |lambda h| for which y' = lambda y with lambda < 0 decays; 0: any */
    /* The error of the step just made to y at t1, root mean square in units of scale, and |lambda h| of what changes fastest
     * there, 0: not known; NULL where card.error_order is 0. */
    int (*error)(void *self, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                 double *lambda_h);
} zd_integrator;

/* ---- a correction: something done to the right side of (6), or to the state after a step ---- */

typedef struct zd_correction {
    zd_card card;
    int (*enabled)(const zd_settings *settings);
    int needs;              /* terms for `stabilize` and `extra_rate` */
    void *(*take)(zd_arena *arena, const zd_system *system, const zd_settings *settings);
    int (*after_step)(void *self, zd_run *run);
    /* xi -> xi_stab, with what the correction has integrated along with the state, if it does */
    void (*stabilize)(void *self, const zd_settings *settings, const zd_point *point, const double *extra, double *rhs);
    int (*extra_size)(const zd_system *system, const zd_settings *settings);
    void (*extra_rate)(const zd_point *point, double *rate);
} zd_correction;

/* ---- the run ---- */

enum { ZD_CORRECTIONS_MAX = 8, ZD_MESSAGE = 400 };

typedef struct zd_active {
    const zd_correction *row;
    void *self;
    int extra;              /* where in the state that stands which it integrates along */
    int extra_size;
} zd_active;

typedef struct zd_control {
    double h;               /* the next step */
    double *scale;          /* (size,): what the error is measured in */
    double *y1, *f0, *f1;   /* (size,): for the choice of the first step */
    int held, free;         /* steps that were as long as stability allows; not so, in succession */
} zd_control;

typedef struct zd_last {    /* the step being made: its size, and where it began */
    double t, h;
    double *y, *p, *v;      /* (size,), (nq,), (nv,) */
} zd_last;

typedef struct zd_place {   /* where a run was */
    double t;
    double *p, *v;          /* (nq,), (nv,) */
    double *extra;          /* what the state has besides them */
} zd_place;

typedef struct zd_guard {   /* where a step began, with which its end is compared */
    int kept;               /* whether there is such */
    int branch, stability;  /* what is looked at */
    int looking;            /* whether at the stability of the next step */
    double astray, nearby, limit;   /* bounds of these, to the powers that are compared */
    double *pdot, *vdot;    /* (nq,), (nv,): there; p and v are those of `last` */
    double *rate;           /* (nq,): pdot at the end */
    double *p, *v, *C;      /* (nq,), (nv,), (mh, nv): at the end, while the point is elsewhere */
    double speed;           /* |pdot|^2 there, in natural units */
    int streak;             /* steps in succession that were longer than the method is stable for */
    double fourth;          /* (omega h)^4, the largest seen */
    double kinetic;         /* energy, likewise */
} zd_guard;

typedef struct zd_crossing {    /* the rows of C where the step began, to see what has become of them */
    int kept;               /* whether there are such */
    int passes;             /* whether the step may pass a bifurcation */
    double *C;              /* (m, nv), times the squares of the natural units */
    double *before;         /* likewise, at the last look */
    double *p, *p1, *v1;    /* (nq,), (nq,), (nv,): where one is, and the end */
    double *turn;           /* (m, m) */
    int *order;             /* (m,) */
} zd_crossing;

typedef struct zd_output {
    zd_place before, after; /* the step */
    long next;              /* of settings.t_eval */
    int between;            /* whether the run is on its way there: such points are always corrected */
} zd_output;

typedef struct zd_watch {   /* where there are events, (events,) each */
    double *before, *now;   /* their values at the ends of the step */
    double *time;           /* when they happen in it; infinite where they do not */
    int *found;             /* how often they have */
    int failed;             /* whether it was an event that could not be evaluated */
    int ended;              /* which ended the run, counted from 1 */
} zd_watch;

struct zd_run {
    zd_settings settings;
    zd_system system;
    zd_statistics statistics;
    const zd_formulation *formulation;
    void *solver;
    const zd_integrator *integrator;
    void *stepper;
    zd_active active[ZD_CORRECTIONS_MAX];
    int corrections;
    int violates;           /* what the projection has to correct: the formulation's, or outside a run, everything */
    int acceleration_needs; /* terms behind (8), (9), (13) with the corrections that are on */
    zd_rate rate;
    zd_point *point;
    double *y;              /* the integrated state: the formulation's, what corrections add, the energy input (28) */
    const double *state;    /* that of the point: y, or a stage of the integrator */
    int own_size;           /* of the formulation's part of it */
    int extras;             /* numbers in the state that corrections add */
    double *input;          /* the last of y where the system has energy input, else 0 */
    double *Psi;            /* (m,) */
    double *factor;         /* (nv, nv): of M at the start, to see whether it is positive definite */
    double no_input;
    double energy0;         /* E0 of (28) */
    double t;               /* where the run has got to */
    int begun;              /* whether the row of the start has been saved, if wanted */
    long step, steps;       /* begun; to do, where they are of fixed size */
    zd_last last;
    zd_control control;     /* where steps are chosen */
    zd_output output;       /* where something between steps is wanted */
    zd_watch watch;
    zd_guard guard;
    zd_crossing crossing;
    zd_place whole;         /* where the step that is made in parts began */
    int parts;              /* of the step being made, if more than one: each is corrected */
    int iterations;         /* most position iterations of a step since the last saved row */
    int energy_skipped;     /* energy corrections left out since then */
    int status;
    char message[ZD_MESSAGE];
};

/* Whether this step is one of every so many, or the last. One of every 1 is not worth a division, the slowest of instructions. */
static inline int zd_run_is_due(const zd_run *run, long every)
{
    return every == 1 || run->step % every == 0 || run->t == run->settings.t1 || run->output.between || run->parts;
}

/* dynamics.c: what integrators, corrections and recorder ask of a run */
int zd_has_energy(const zd_system *system);
int zd_has_input(const zd_system *system);  /* of energy, besides V: then it is integrated along */
int zd_run_rate(void *run, double t, const double *y, double *ydot);
int zd_run_factor(zd_run *run);             /* the leading matrix at the point */
void zd_run_solve(zd_run *run, const double *force, const double *rhs, double *x, double *lambda);  /* with what was factored */
int zd_run_accelerate(zd_run *run);         /* vdot, lambda at the point */
int zd_run_energy_violation(zd_run *run, double *violation, double *kinetic);   /* (28) */
int zd_run_correct(zd_run *run);            /* all corrections that are on, in their order */

/* arguments.c: refuses what no caller should hand in, with a sentence; for a run also when it begins, ends and saves */
int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size);
int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size);

/* run.c: a run standing at (t, p, v), with the rank there found, but not yet checked. NULL if there is no memory, which status and
 * message then say; otherwise status is what came of finding the rank. */
zd_run *zd_run_open(const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size);
int zd_run_place(zd_run *run, double t, const double *p, const double *v);
int zd_run_start_energy(zd_run *run);       /* E0 of (28), from the point */
double zd_run_time(const zd_run *run, long step);

/* simulate.c: a step, and its two halves */
int zd_run_step(zd_run *run, double h, double t1);
int zd_run_make_step(zd_run *run, double h);    /* as the integrator does it */
int zd_run_integrate(zd_run *run, double h);    /* y from t to t + h */
int zd_run_land(zd_run *run, double t1);        /* the point at t1, corrected, and y to match */
int zd_run_return(zd_run *run);                 /* point and y to where the step began */

/* control.c: a step whose size the error decides */
int zd_control_start(zd_run *run);
int zd_control_step(zd_run *run);

/* guard.c: whether a step can be believed */
zd_guard zd_guard_take(const zd_run *run, zd_arena *arena);
int zd_guard_begin(zd_run *run);            /* keeps where the run is */
int zd_guard_step(zd_run *run, double h);   /* compares with that where a step of size h has led, and keeps it */

/* crossing.c: whether a bifurcation lies within a step */
zd_crossing zd_crossing_take(zd_arena *arena, const zd_system *system);
int zd_crossing_begin(zd_run *run);         /* keeps where the run is */
/* Keeps where a step of size h has led, by so much in natural units, squared; ZD_PASSED if a bifurcation lies in between. */
int zd_crossing_step(zd_run *run, double h, double moved);
int zd_crossing_pass(zd_run *run, double h, double t1);     /* the step again, through it, if that is wanted and the motion leads there */

/* output.c: values between steps */
void zd_place_keep(const zd_run *run, zd_place *place);
int zd_place_return(zd_run *run, const zd_place *place);
void zd_output_before(zd_run *run);
int zd_output_after(zd_run *run, zd_record *record);
int zd_output_move(zd_run *run, double t);      /* to any time of the step, once its end is kept */
void zd_output_keep_end(zd_run *run);
int zd_output_is_complete(const zd_run *run);

/* events.c */
int zd_events_start(zd_run *run);
int zd_events_after(zd_run *run);               /* finds those of the step; a terminal one becomes the run's end */

/* not_finite.c: the term that is to blame for a failure, and where; 0: none is */
int zd_run_not_finite(zd_run *run, int status, double *t);

/* recorder.c */
int zd_record_row(zd_run *run, zd_record *record);

/* status.c */
int zd_explain(zd_run *run, int status);    /* writes the run's message, gives the status back */

#endif
