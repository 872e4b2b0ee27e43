/* A run: its samples, its statistics, its state: part of zerodrift.h. */
#ifndef ZERODRIFT_RUN_H
#define ZERODRIFT_RUN_H

#include <stddef.h>

#include "settings.h"

/* ---- a run ---- */

typedef struct zd_statistics {
    int64_t steps;                 /* accepted steps */
    int64_t closed_form_steps;          /* accepted steps on the closed-form path */
    int64_t rejected;              /* steps repeated with a smaller size, since their error estimate was too large or they failed */
    int64_t output_steps;          /* shorter steps to times between steps, for samples or to locate events */
    int64_t evaluations;           /* calls of the system's evaluate() */
    int64_t factorizations;        /* factorizations of leading matrices */
    int64_t solves;                /* solves with their factors */
    int64_t position_iterations;   /* iterations of (25a) */
    int64_t max_position_iterations;   /* the most in one step */
    int64_t velocity_corrections;
    int64_t energy_corrections;
    int64_t energy_skipped;        /* energy corrections left out, since (29) has no bounded solution: T too small for the violation */
    int64_t damped;                /* position corrections that converged only with shortened iterations */
    int64_t subdivided;            /* fixed steps made in parts, since their correction failed */
    int64_t too_long;              /* fixed steps longer than the method is stable for or, if it is always stable, can resolve */
    int64_t stiff;                 /* checked steps whose size was limited by stability, not by the error tolerance */
    int64_t implicit_iterations;   /* Newton iterations of implicit integrators */
    int64_t embedding_iterations;  /* Newton iterations for p = g(q) */
    int64_t repartitions;          /* changes of the independent variables between steps, or to (p, v) near a bifurcation */
    int64_t rank;                  /* rank of C; less than m if constraints are redundant */
    int64_t rank_drops;            /* steps in which the rank was temporarily lower */
    int64_t unresolved;            /* checked fixed steps that do not resolve the motion of some coordinate */
    double unresolved_time;        /* s: end of the first of them */
    double part_error;             /* largest estimated error of one coordinate over recent steps, in its characteristic scale */
    int64_t part;                  /* index of that coordinate, of a velocity if there is a kinematic matrix, or nv + index of a quaternion;
                                    * after ZD_COLLAPSED, of the velocity whose rate jumps */
    double smallest_pivot;         /* smallest relative pivot of C M^-1 C^T, for structures with many constraints; 0: not monitored */
    double smallest_pivot_time;    /* s: time of that pivot */
    int64_t smallest_pivot_row;    /* constraint of that pivot */
    double energy_corrected;       /* J: largest energy added or removed by one energy correction */
    double omitted_bounce_time;    /* s: duration of bounces omitted, as contacts that separate slower than the rest speed stay closed */
    double omitted_bounce_energy;  /* J: their kinetic energy */
} zd_statistics;

typedef struct zd_warning_limits {  /* beyond these, a completed run gives a warning */
    double pivot;               /* zd_statistics.smallest_pivot; smaller ones give it */
    double energy_error, energy_correction;     /* errors of (28) and energy_corrected, relative to the largest kinetic energy */
    double energy_rounding;     /* errors of (28) that are rounding, relative to kinetic and potential energy */
} zd_warning_limits;

const zd_warning_limits *zd_limits_of_warnings(void);

typedef struct zd_record {      /* samples of a run, one per saved instant; memory belongs to the caller */
    int64_t capacity, samples;  /* allocated and stored; a full record pauses the run, which continues with a new or emptied one */
    double *t;                  /* (capacity,) s */
    double *p, *v, *multipliers;                    /* (capacity, nq), (capacity, nv), (capacity, m) */
    double *position_violation, *velocity_violation;    /* (capacity, mh), (capacity, m) */
    double *kinetic, *potential, *input, *energy_violation; /* (capacity,) J; the last three NULL without potential */
    int *iterations;            /* (capacity,) most position iterations in one step since the previous sample */
    int *energy_skipped;        /* (capacity,) energy corrections left out since the previous sample */
    double *outputs;            /* (capacity, components of all outputs); NULL without outputs */
} zd_record;

typedef struct zd_saved {       /* samples of a run that saved every step; at least one */
    int64_t samples;
    const double *t;            /* (samples,) s, increasing */
    const double *p, *v;        /* (samples, nq), (samples, nv) */
    const double *input;        /* (samples,) J; NULL without input power */
    int ends_in_event;          /* true if the last sample is a terminal event */
    const signed char *state;   /* (samples, groups) of each group from the sample on, as in zd_transition; NULL without groups */
    int64_t stride;             /* doubles between consecutive samples, the same for each array; 0: arrays are contiguous */
} zd_saved;

typedef struct zd_run zd_run;

/* Number of steps from t0 to t1: a span within rounding of a whole number of steps has that many, else a shorter step is added. */
double zd_count_steps(double t0, double t1, double step);

/* True if a run with these settings can use closed-form functions; otherwise a system need not provide them. */
int zd_takes_closed_form(const zd_settings *settings);
/* True if these are the functions of a formulation in independent velocities. */
int zd_takes_embeddings(const zd_settings *settings);
/* True if the formulation can use closed-form functions of this system. */
int zd_may_have_closed_form(const zd_system *system, const zd_settings *settings);
/* Checks that formulation, integrator and corrections are compatible; else the reason is in `message`. */
int zd_check_methods_agree(const zd_settings *settings, char *message, int message_size);
/* True if a run with these settings uses the system's Taylor series. */
int zd_takes_series(const zd_settings *settings);
/* True if it uses the system's Jacobian, if provided. */
int zd_takes_jacobian(const zd_settings *settings);
/* Vector unit of the closed-form functions that a run of this system uses; -1: it uses none. */
int zd_closed_form_unit(const zd_system *system, const zd_settings *settings);

/* Creates a run with all its memory. On failure NULL, with the reason in `status` and `message` (at least one character). */
zd_run *zd_run_create(const zd_system *system, const zd_settings *settings, const double *p0, const double *v0,
                      int *status, char *message, int message_size);
void zd_run_free(zd_run *run);
/* Steps until the end, the goal, a full record, or until about `seconds` have passed. Slicing does not change the bits of the result.
 * record NULL: no samples are saved; t_eval must not be given then. */
int zd_run_advance(zd_run *run, zd_record *record, double seconds);
/* Sets the goal: so many steps from the present state, or the time t if that comes first (INFINITY: none). ZD_BAD_ARGUMENT: t is before the
 * present time. Fixed steps reach a time within rounding of a whole number of steps as t0 + k step; otherwise the last one is shortened, and
 * further steps are counted from there. Adaptive steps end at t. */
int zd_run_set_goal(zd_run *run, int64_t steps, double t);
/* Moves the run to another state at its time, which must satisfy the constraints: ZD_BAD_START. The balance (28) is of the energy
 * from there on, and the next sample is that of this state. */
int zd_run_set_state(zd_run *run, const double *p, const double *v);
/* zd_run_set_goal() at a number of steps, and zd_run_advance() for a time slice: ZD_PAUSED after that, to be advanced further. */
int zd_run_step(zd_run *run, int64_t steps, zd_record *record);
/* The present state: time, p (nq,), v (nv,). The pointers stay valid as long as the run. */
double zd_run_time(const zd_run *run);
const double *zd_run_p(const zd_run *run);
const double *zd_run_v(const zd_run *run);
int64_t zd_run_step_number(const zd_run *run);              /* steps made */
int zd_run_ended_by(const zd_run *run);                     /* index of the terminal event at which it is; -1: none */
int zd_run_acting(const zd_run *run);                       /* after ZD_PAUSED: index of the event at which the caller acts; -1: none */
/* Accelerations (nv,) and multipliers (m,) at the present state, which are those of the next step's start. */
int zd_run_accelerations(zd_run *run, double *vdot, double *multipliers);
/* value (size,) <- a measure of a system with the equations of the run, at its present state; t, p and v of a run in SIMD lanes may be ahead
 * of it, for a measure of positions or velocities. scratch: memory of the measures, and nv + m. */
int zd_run_measure(zd_run *run, const zd_system *system, int measure, double t, const double *p, const double *v, double *value,
                   double *scratch);
/* Jumps of the state so far, by zd_run_set_state() and of prescribed speeds at breaks, after which an advance pauses; and of the last one its
 * time, s, and the change of the energy, J, from which on the balance counts. */
typedef struct zd_energy_jump {
    int64_t count;
    double t, energy;
} zd_energy_jump;
const zd_energy_jump *zd_run_energy_jump(const zd_run *run);
/* Jumps of speeds so far. Of the last one: its time, s; its impulses (m,), of the constraints, with the sign of (7); and their works (m,), J,
 * whose sum enters the energy balance. Velocities are projected as in (25b): M (v+ - v-) = -C^T impulses. */
typedef struct zd_jump {
    int64_t count;
    double t;
    double *impulses, *works;
} zd_jump;
const zd_jump *zd_run_jump(const zd_run *run);
/* Changes of phase so far, of a system with groups, and the last one, after which an advance pauses. NULL: the system has no groups. */
typedef struct zd_transition {
    int64_t count;
    double t;               /* s */
    signed char *state;     /* (groups,) from then on: 0 open, released or without friction; 1 closed, joined or sticking; 2, 3 sliding with a
                             * positive or negative velocity; 4 closed or sticking together with others, which have its force */
    double *impulse;        /* (groups,) N s: of one-sided groups, in an impact */
    double *loss;           /* (groups,) J: energy lost by it, with its friction; of two-sided groups, by joining */
    double energy;          /* J: change of the energy */
} zd_transition;
const zd_transition *zd_run_transition(const zd_run *run);
/* Joins or releases a two-sided group at the present state, with a plastic impact, M (v+ - v-) = -C^T impulses. ZD_JOINED: Phi must be zero
 * to 1e-9 of the characteristic length, otherwise ZD_BAD_START; ZD_JOINED_HERE: Phi keeps its present value. ZD_BAD_ARGUMENT without such
 * a group. */
enum zd_joining { ZD_RELEASED, ZD_JOINED_HERE, ZD_JOINED };
int zd_run_switch(zd_run *run, int group, enum zd_joining how);
/* Largest |Phi| (3) of the active constraints at the present state. */
int zd_run_position_violation(zd_run *run, double *violation);
/* J: Psi_E (28) at the present state; ZD_NOT_FINITE where the system has no potential. */
int zd_run_energy_violation(zd_run *run, double *violation);
double zd_run_progress(const zd_run *run);                  /* 0 ... 1 */
const char *zd_run_message(const zd_run *run);              /* the first failure, one sentence */
const zd_statistics *zd_run_statistics(const zd_run *run);
/* Indices of permanently redundant constraints: rows (m,), increasing. Returns their number. */
int zd_run_redundant(const zd_run *run, int *rows);
/* (mh,): size of each position constraint at the start: its largest change when one coordinate moves by its characteristic scale, one
 * radian of an angle or the characteristic length of the mechanism. */
const double *zd_run_sizes(const zd_run *run);
double zd_run_kinetic(const zd_run *run);                   /* J: largest kinetic energy after a checked step */
double zd_run_energy_error(const zd_run *run);              /* J: largest |Psi_E| (28) of the samples so far */
double zd_run_omega_h(const zd_run *run);                   /* largest omega h of the motion in any fixed step */

/* ---- saved states ---- */

/* Allows the state of a run to be saved: called after zd_run_create() from (p0, v0), before its first step. */
int zd_state_begin(zd_run *run, const double *p0, const double *v0);
size_t zd_state_size(const zd_run *run);        /* bytes of its state */
/* Writes the state into a block of zd_state_size() bytes, without addresses. `fingerprint`: text of up to 63 characters that identifies
 * the system with its parameters, and the layout of the memory of runs. */
void zd_state_save(const zd_run *run, const char *fingerprint, void *block);
/* A run that continues the one whose state was saved, by a core of the same layout, with the same settings and vector unit: with its bits,
 * or, in closed form with vectors by a core of another compiler, to 1e-13. Its state can be saved again. On failure NULL, with the reason in
 * `status` and `message`. */
zd_run *zd_state_restore(const zd_system *system, const zd_settings *settings, const void *block, size_t bytes, const char *fingerprint,
                         int *status, char *message, int message_size);

#endif
