/* zerodrift: constrained multibody systems without constraint drift.
 *
 * The public C interface. The system interface itself stands in include/zerodrift/system.h, which is shipped to authors of systems.
 * Declarations only: CFFI reads this text after the preprocessor. Equation numbers are those of W. Blajer, "Elimination of Constraint
 * Violation and Accuracy Aspects in Numerical Simulation of Multibody Systems", Multibody System Dynamics 7 (2002) 265-284.
 */
#ifndef ZERODRIFT_H
#define ZERODRIFT_H

#include <stddef.h>

#include "include/zerodrift/system.h"

/* ---- statuses, the entries of ZD_STATUS_LIST ---- */

typedef struct zd_status_row {
    int status;
    const char *symbol;     /* "ZD_DONE" */
    const char *error;      /* name of the exception that Python raises; "": the base class, ZerodriftError */
    const char *sentence;   /* its meaning, for messages */
} zd_status_row;

const zd_status_row *zd_status_at(int row);     /* NULL: past the last entry */

/* ---- the terms of a system, the entries of ZD_TERM_LIST ---- */

typedef struct zd_term_row {
    int term;               /* its bit */
    const char *symbol;     /* name of the bit: "ZD_M" */
    const char *name;       /* its member of zd_terms: "M" */
    const char *shape;      /* "ZD_MATRIX(nv, nv)" */
    size_t offset;          /* offset of the member in zd_terms, bytes */
    enum zd_depends depends;
    const char *text;
} zd_term_row;

typedef struct zd_shape {
    int dimensions;         /* 0: a number, 1: (size[0],), 2: (size[0], size[1]) */
    int size[2];
} zd_shape;

const zd_term_row *zd_term_at(int row);                         /* NULL: past the last entry */
zd_shape zd_term_shape(const zd_system *system, int row);       /* shape of the dense term in the equations */
size_t zd_term_size(const zd_system *system, int row);          /* number of doubles that evaluate() writes, packed if structured */

/* Cost of eliminating C W C^T of a declared structure, W = M^-1: numbers of multiplications to form C W C^T, to factor it, and to solve
 * with its factors. Entry [0] counts blocks for whose size there is a compiled kernel, entry [1] all other blocks. */
typedef struct zd_structure_work {
    int columns, blocks, rows;  /* block columns; blocks below the diagonal, fill-in included; scalar rows */
    double products[2], factors[2], solves[2];
    int has_products;           /* true if the system's own products replace C, so that C is not stored */
    int is_of_many;             /* true if there are so many constraints that bifurcations are not searched for */
    int is_alike;               /* true if the bodies of each constraint contribute similar amounts, so that solutions need no check */
    double share;               /* smallest relative pivot (pivot / its diagonal entry before elimination); 0: a pivot was not positive */
} zd_structure_work;

/* Counts the work at (t, p, v) = (0, p, 0), where M must be diagonal. All counts are 0 for a system without a structure. Fails with
 * ZD_NO_MEMORY, or with the status of evaluate(). */
int zd_structure_count(const zd_system *system, const double *p, zd_structure_work *work);

/* The bit of the first requested term with an entry that is not finite; 0 if all are finite. */
int zd_first_not_finite(const zd_system *system, int want, const zd_terms *terms);

/* Checks that sizes, terms and other members of a system agree; else ZD_BAD_ARGUMENT, with the reason in `message`. */
int zd_check_system(const zd_system *system, char *message, int message_size);

/* ---- the four tables ---- */

enum zd_table { ZD_SYSTEMS, ZD_FORMULATIONS, ZD_INTEGRATORS, ZD_CORRECTIONS };

int zd_rows(enum zd_table table);
const zd_card *zd_row(enum zd_table table, int row);
int zd_row_named(enum zd_table table, const char *name);    /* index of the entry of that name; -1: none */
int zd_default_row(enum zd_table table);        /* index of the default entry */
int zd_correction_requires(int correction);     /* bits of the terms that a system must provide for this correction */
int zd_suits(const zd_system *system, int integrator);      /* true if the integrator applies to the system */
int zd_formulation_suits(const zd_system *system, int formulation);     /* likewise for a formulation */

const zd_kind *zd_kind_of(int row);

/* ---- events: instants at which a function of the motion passes through zero ---- */

/* Source of an argument of an event function: a quantity of the motion, or a constant. */
enum zd_source { ZD_READS_TIME, ZD_READS_P, ZD_READS_V, ZD_READS_MEASURE, ZD_READS_NUMBER };

typedef struct zd_argument {
    enum zd_source what;
    int index;              /* entry of p or v, or index of a measure, which must depend on positions or velocities only */
    int component;          /* component of the measure */
    double number;          /* value of ZD_READS_NUMBER */
} zd_argument;

/* Event function that the core evaluates without a callback: zero of function(x) - value. */
typedef struct zd_event {
    int readings;           /* number of arguments; 0: zd_events.evaluate() is called instead */
    const zd_argument *reading;  /* (readings,) the arguments x */
    double (*function)(const double *x);    /* NULL: x[0] itself */
    double value;           /* the event occurs when the function passes through this value */
} zd_event;

typedef struct zd_events {
    int count;
    const int *direction;   /* (count,) 1: from below, -1: from above, 0: either */
    const int *terminal;    /* (count,) the run ends at this occurrence of the event, counted from 1; 0: never */
    const zd_event *known;  /* (count,) functions that the core evaluates; NULL: all are evaluated by the callback */
    const zd_system *of;    /* system whose measures are read; NULL: the simulated system */
    void *data;
    /* Callbacks: value of an event function, and notification of an event at its instant. Both return 0, or ZD_CALLBACK on failure. */
    int (*evaluate)(void *data, int event, double t, const double *p, const double *v, double *value);
    int (*found)(void *data, int event, double t, const double *p, const double *v);
} zd_events;

/* ---- outputs: measures that are recorded in every sample ---- */

typedef struct zd_outputs {
    const zd_system *of;    /* system whose measures are evaluated, with the same coordinates; NULL: the simulated system */
    int count;
    const int *measure;     /* (count,) indices of measures; a sample holds their components in this order */
} zd_outputs;

/* ---- inputs: numbers that the caller sets between steps ---- */

typedef struct zd_input_place {
    int input;                  /* index of the input that is written there */
    int is_speed;               /* false: place[0] is the input. True: the speed is place[0] + place[1] (t - place[2]); it follows the
                                 * input linearly over one step of fixed size */
    double *place;              /* in the data of the system, which belongs to this run */
} zd_input_place;

typedef struct zd_inputs {
    int count;
    const double *value;        /* (count,): read at the start of each advance; the places hold the initial ones already */
    const double *lower, *upper;    /* (count,): limits */
    int places;
    const zd_input_place *place;    /* (places,) */
    int derivations;            /* functions that recompute what the system derives from its data */
    void (*const *derive)(double *data);    /* (derivations,) */
    double *const *data;        /* (derivations,) */
} zd_inputs;

/* ---- settings of a run ---- */

enum { ZD_CORRECTIONS_MAX = 8, ZD_ROW_VALUES = 16 };

/* Parameters of a formulation, an integrator or a correction, in the order of its card. */
typedef struct zd_given {
    int given;                      /* 0: the correction is off; a formulation or an integrator has its default parameters */
    double value[ZD_ROW_VALUES];    /* values of all parameters, vectors entry after entry */
} zd_given;

/* Action at a bifurcation, where constraints that are independent elsewhere become dependent, so that several motions satisfy them: end
 * the run, or continue along the present branch; from rest, along the branch of least acceleration. */
enum zd_on_singular { ZD_STOP, ZD_CONTINUE };

/* Sizes of steps: given, or by the error estimate of the integrator. */
enum zd_steps { ZD_FIXED_STEPS, ZD_ADAPTIVE_STEPS };

typedef struct zd_settings {
    int formulation, integrator;    /* indices in their tables */
    double t0, t1;                  /* s */
    enum zd_steps steps;
    double step;                    /* fixed steps: size, s; the last one is shortened to end at t1 */
    double rtol, atol;              /* adaptive steps: tolerances of the local error of the state */
    double first_step, max_step;    /* adaptive steps, s; 0: not given, unbounded */
    double max_move;                /* adaptive steps: largest change of an entry of p in one step, in its unit; 0: unbounded */
    int64_t max_steps;              /* adaptive steps: the run fails after this many; 0: unbounded */
    int64_t save_every;             /* steps per sample */
    const double *t_eval;           /* (t_evals,) s: times of samples, instead of save_every; NULL: not given */
    int64_t t_evals;
    const zd_events *events;        /* NULL: none */
    const zd_outputs *outputs;      /* NULL: none */
    const zd_inputs *inputs;        /* NULL: none */
    zd_given of_formulation, of_integrator;
    zd_given correction[ZD_CORRECTIONS_MAX];        /* parameters of each correction, in the order of their table */
    enum zd_on_singular on_singular;
    int direct;                     /* true: the closed-form path is taken if the system provides applicable closed-form functions */
    enum zd_unit vector;            /* widest vector unit that these may use */
    int given_jacobian;             /* true if C and Phi_t are hand-written: they are compared with differences of Phi at intervals */
    int is_open;                    /* true: the run has no end, and returns to the start of a step that fails; t1 only serves the
                                     * checks of the start, as the time scale of the motion */
} zd_settings;

/* Default parameters of a card. */
zd_given zd_initial(const zd_card *card);
/* Pointer to the value of the parameter of that name; NULL: the card has no such parameter. */
double *zd_value_named(zd_given *given, const zd_card *card, const char *name);
/* Checks the parameters by the rules of their card and of the entry itself; the first violation is described in `message`. */
int zd_check_given(enum zd_table table, int row, const zd_given *given, char *message, int message_size);

enum zd_unit zd_processor_unit(void);       /* widest vector unit of this processor */
int zd_processor_has(enum zd_unit unit);

/* Sines and reductions of large arguments, passed to libraries compiled with ZD_LARGE_SINES_OF_CORE: see zerodrift/sines.h. */
void zd_sines_of_large(int n, const double *angle, double *s, double *c);
void zd_reductions_of_large(int n, const double *angle, double *r, double *tail, uint64_t *quadrant);

/* ---- a run ---- */

typedef struct zd_statistics {
    int64_t steps;                 /* accepted steps */
    int64_t direct_steps;          /* accepted steps on the closed-form path */
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
} zd_statistics;

typedef struct zd_warning_limits {  /* beyond these, a completed run gives a warning */
    double pivot;               /* zd_statistics.smallest_pivot; smaller ones give it */
    double energy_error, energy_correction;     /* errors of (28) and energy_corrected, relative to the largest kinetic energy */
    double energy_rounding;     /* errors of (28) that are rounding, relative to kinetic and potential energy */
} zd_warning_limits;

const zd_warning_limits *zd_limits_of_warnings(void);

typedef struct zd_record {      /* samples of a run, one per saved instant; memory belongs to the caller */
    int64_t capacity, rows;        /* samples allocated and stored; a full record pauses the run, which continues with a new or emptied one */
    double *t;                  /* (capacity,) s */
    double *p, *v, *multipliers;                    /* (capacity, nq), (capacity, nv), (capacity, m) */
    double *position_violation, *velocity_violation;    /* (capacity, mh), (capacity, m) */
    double *kinetic, *potential, *input, *energy_violation; /* (capacity,) J; the last three NULL without potential */
    int *iterations;            /* (capacity,) most position iterations in one step since the previous sample */
    int *energy_skipped;        /* (capacity,) energy corrections left out since the previous sample */
    double *outputs;            /* (capacity, components of all outputs); NULL without outputs */
} zd_record;

typedef struct zd_saved {       /* samples of a run that saved every step; at least one */
    int64_t rows;
    const double *t;            /* (rows,) s, increasing */
    const double *p, *v;        /* (rows, nq), (rows, nv) */
    const double *input;        /* (rows,) J; NULL without input power */
    int ends_in_event;          /* true if the last sample is a terminal event */
    int64_t stride;             /* doubles between consecutive samples, the same for each array; 0: arrays are contiguous */
} zd_saved;

typedef struct zd_run zd_run;

/* Number of steps from t0 to t1: a span within rounding of a whole number of steps has that many, else a shorter step is added. */
double zd_count_steps(double t0, double t1, double step);

/* True if a run with these settings can use closed-form functions; otherwise a system need not provide them. */
int zd_takes_direct(const zd_settings *settings);
/* True if these are the functions of a formulation in independent velocities. */
int zd_takes_embeddings(const zd_settings *settings);
/* True if the formulation can use closed-form functions of this system. */
int zd_may_have_direct(const zd_system *system, const zd_settings *settings);
/* Checks that formulation, integrator and corrections are compatible; else the reason is in `message`. */
int zd_check_methods_agree(const zd_settings *settings, char *message, int message_size);
/* True if a run with these settings uses the system's Taylor series. */
int zd_takes_series(const zd_settings *settings);
/* True if it uses the system's Jacobian, if provided. */
int zd_takes_jacobian(const zd_settings *settings);
/* Vector unit of the closed-form functions that a run of this system uses; -1: it uses none. */
int zd_direct_unit(const zd_system *system, const zd_settings *settings);

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
int zd_run_aim(zd_run *run, int64_t steps, double t);
/* zd_run_aim() at a number of steps, and zd_run_advance() for a time slice: ZD_PAUSED after that, to be advanced further. */
int zd_run_step(zd_run *run, int64_t steps, zd_record *record);
/* The present state: time, p (nq,), v (nv,). The pointers stay valid as long as the run. */
double zd_run_time(const zd_run *run);
const double *zd_run_p(const zd_run *run);
const double *zd_run_v(const zd_run *run);
int64_t zd_run_step_number(const zd_run *run);              /* steps made */
int zd_run_ended_by(const zd_run *run);                     /* index of the terminal event at which it is; -1: none */
/* Accelerations (nv,) and multipliers (m,) at the present state, which are those of the next step's start. */
int zd_run_accelerations(zd_run *run, double *vdot, double *multipliers);
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

/* ---- many open runs, advanced together ---- */

typedef struct zd_open_runs {
    int64_t runs;
    zd_run *const *run;         /* (runs,) open runs of systems of one shape that do not call Python */
    int *status;                /* (runs,) of the last advance; a run that has failed (negative) is not advanced */
    double *t, *p, *v;          /* (runs,), (runs, nq), (runs, nv): present states */
    const double *const *data;  /* (runs,) numbers of each system, for SIMD lanes; NULL: there are none */
    int64_t doubles;            /* their count */
} zd_open_runs;

typedef struct zd_open_lanes zd_open_lanes;

/* Advances the runs from `first` on, so many steps each, or to a time if that comes first; and stores their states. A run stops at a
 * terminal event. Several threads may advance different ones at the same time. */
void zd_open_runs_advance(const zd_open_runs *self, int64_t first, int64_t count, int64_t steps, double t);
/* Stores the states only. */
void zd_open_runs_read(const zd_open_runs *self, int64_t first, int64_t count);

/* True if SIMD lanes suit the system and the settings of a run, provided that it has closed-form functions for them. */
int zd_lanes_serve_settings(const zd_system *system, const zd_settings *settings);
/* SIMD lanes for the runs from `first` on, in which each run has the bits that it has alone; NULL if they do not serve these runs. */
zd_open_lanes *zd_open_lanes_create(const zd_open_runs *runs, int64_t first, int64_t count);
void zd_open_lanes_free(zd_open_lanes *self);
/* zd_open_runs_advance() of these runs. A run itself may then be behind its lane. */
void zd_open_lanes_advance(zd_open_lanes *self, int64_t steps, double t);
/* Brings run i, which is behind its lane, to the present state; returns its status. */
int zd_open_lanes_settle(zd_open_lanes *self, int64_t i);
/* Run i is replaced by another one. */
void zd_open_lanes_forget(zd_open_lanes *self, int64_t i);

/* ---- saved states ---- */

/* Allows the state of a run to be saved: called after zd_run_create() from (p0, v0), before its first step. */
int zd_state_begin(zd_run *run, const double *p0, const double *v0);
size_t zd_state_size(const zd_run *run);        /* bytes of its state */
/* Writes the state into a block of zd_state_size() bytes, without addresses. `fingerprint`: text of up to 63 characters that identifies
 * the system with its parameters, and the build of the core. */
void zd_state_save(const zd_run *run, const char *fingerprint, void *block);
/* A run that continues with the bits of the one whose state was saved, by the same build of the core, with the same settings and vector
 * unit. Its state can be saved again. On failure NULL, with the reason in `status` and `message`. */
zd_run *zd_state_restore(const zd_system *system, const zd_settings *settings, const void *block, size_t bytes, const char *fingerprint,
                         int *status, char *message, int message_size);

/* ---- many runs of one system, whose numbers differ ---- */

enum zd_way { ZD_NOT_BEGUN, ZD_BY_ITSELF, ZD_IN_LANES, ZD_UNUSUAL };     /* execution of a run: none, single, SIMD lanes, left to caller */

/* Systems of one shape, a separate one for each run. */
typedef struct zd_family {
    const void *of;
    /* Makes the system of a run, and its start p (nq,), v (nv,) if that is not given. NULL: the caller must create this run individually
     * (ZD_UNUSUAL). free(*made) must follow in any case. Must be safe to call from several threads. */
    const zd_system *(*make)(const void *of, int64_t run, double *p, double *v, void **made);
    void (*free)(void *made);
} zd_family;

/* Runs that differ by the data of their system and by their start. Arrays hold run after run; a result that is NULL is not stored. */
typedef struct zd_batch {
    const zd_system *system;        /* system whose functions do not call Python */
    const zd_settings *settings;    /* settings of all runs; their events must be evaluated by the core, without callbacks */
    int settings_differ;            /* true if settings is (runs,); t0, events and outputs must be those of the first */
    int64_t runs;
    const double *data;             /* (runs, doubles): replaces the system's data; NULL: the same data for all */
    int64_t doubles;                /* size of the system's data; 0: it is not an array of doubles, and is the same for all */
    const zd_family *family;        /* NULL: all runs have `system`, except for its data */
    const double *p0, *v0;          /* (runs, nq), (runs, nv); NULL: provided by the family */
    const zd_settings *assembly;    /* starts are first projected onto the constraints by zd_project() with these; NULL: not projected */
    const int *hold_p, *hold_v;     /* (nq,), (nv,): coordinates and velocities held by the projection; NULL: none */
    int lanes;                      /* true: runs execute in SIMD lanes if possible */
    const int *stop;                /* all runs stop when this becomes nonzero; NULL: never */
    int64_t capacity;               /* samples allocated per run */
    double *t, *p, *v, *multipliers;        /* (runs, capacity), (runs, capacity, nq), (runs, capacity, nv), (runs, capacity, m) */
    double *input;                  /* (runs, capacity) J */
    int *iterations, *energy_skipped;       /* (runs, capacity) */
    double *outputs;                /* (runs, capacity, components of all outputs) */
    int64_t events_capacity;        /* occurrences allocated for each event of a run */
    int64_t *found;                 /* (runs, events) occurrences of each event, including those beyond events_capacity; NULL: no events */
    double *t_events, *p_events, *v_events; /* (runs, events, events_capacity), (.., nq), (.., nv): the first occurrences */
    int64_t *rows;                  /* (runs,) samples stored */
    int *status;                    /* (runs,) ZD_PAUSED if stopped */
    int *way;                       /* (runs,) zd_way: how the run was computed; ZD_UNUSUAL if left to the caller */
    zd_statistics *statistics;      /* (runs,) */
    double *kinetic, *energy_error; /* (runs,) J: see zd_run_kinetic() and zd_run_energy_error() */
    /* (runs,), of single runs only: see zd_run_omega_h(); largest |Phi| and |Psi| of the samples, NaN without samples; computing time, s */
    double *omega_h, *position_violation, *velocity_violation, *seconds;
    char *message;                  /* (runs, message_size): messages of runs that failed or ended early */
    int message_size;
} zd_batch;

int zd_lanes_of_unit(enum zd_unit unit);     /* number of runs that share a vector of this unit; 0: the core is compiled without it */
/* Runs a batch. Failures of single runs are reported in their status and message; returned is only a lack of memory for the batch itself.
 * Several threads may run batches at the same time. */
int zd_batch_run(const zd_batch *batch);

/* Completes the samples of a run in SIMD lanes, which store states only: multipliers, violations, energies and outputs at p (rows, nq),
 * v (rows, nv), with the energy input (rows,). `run` must be newly created from the same start, and can only be freed afterwards. */
int zd_run_record_states(zd_run *run, int64_t rows, const double *t, const double *p, const double *v, const double *input,
                         zd_record *record);

/* Tables of a batch from the parameters of a kind of system (runs, all parameters): constants (runs, kind->constants), starts (runs, nq),
 * (runs, nv). Returns the index of the first run whose parameters are invalid, with the reason; `runs` if all are valid. */
int64_t zd_batch_of_kind(const zd_kind *kind, int64_t runs, const double *parameters, double *constants, double *p0, double *v0,
                         const char **reason);
/* Calls derive() for each row of data (runs, doubles). */
void zd_batch_derive(void (*derive)(double *data), int64_t runs, int64_t doubles, double *data);

/* ---- a system perturbed by rounding errors, to measure the sensitivity of its motion ---- */

/* Factors near 1 of the arguments of evaluate() and of the terms that it writes. Factors of M must be symmetric. */
typedef struct zd_perturbation {
    const double *numbers;      /* data of the series, found here as the first member; NULL: no series */
    const zd_series *series;    /* Taylor series of the perturbed motion; NULL: none */
    const zd_system *system;    /* the unperturbed system */
    double t;
    const double *p, *v;    /* (nq,), (nv,) */
    zd_terms terms;         /* factors of each term; NULL: unperturbed */
} zd_perturbation;

zd_system zd_perturbed(const zd_perturbation *perturbation);      /* refers to the perturbation and its system, which must outlive it */

/* ---- operations of a run for single states; on failure each writes one sentence into `message` ---- */

int zd_acceleration(const zd_system *system, int formulation, enum zd_on_singular on_singular, double t, const double *p, const double *v,
                    double *vdot, double *multipliers, char *message, int message_size);
/* The same at many states: t (rows,), p (rows, nq), v (rows, nv) give vdot (rows, nv) and multipliers (rows, m). */
int zd_accelerations(const zd_system *system, int formulation, enum zd_on_singular on_singular, int64_t rows, const double *t,
                     const double *p, const double *v, double *vdot, double *multipliers, char *message, int message_size);
/* A measure at many states: values (rows, size); scratch of the size that the measures declare. vdot and multipliers may be NULL if the
 * measure does not depend on them. */
int zd_measure_states(const zd_system *system, const double *inputs, int measure, int64_t rows, const double *t, const double *p,
                      const double *v, const double *vdot, const double *multipliers, double *values, double *scratch);

/* The terms in `want` at many states t (states,), p (states, nq), v (states, nv): `first` has the memory of the first, the others follow
 * it, (states, size) of each term, with a single scratch. */
int zd_evaluate_states(const zd_system *system, int want, int64_t states, const double *t, const double *p, const double *v,
                       const zd_terms *first);

/* Values, rates, Jacobians and biases, all requested, of several measures of positions or velocities at many states; their components follow
 * one another, (states, size of all) of each, of Jacobians (states, size of all, nv). */
int zd_measure_rates(const zd_system *system, const double *inputs, int count, const int *measures, int64_t states, const double *t,
                     const double *p, const double *v, const zd_measured *first, double *scratch);
/* Projects p and v in place onto the constraints by the corrections of `settings`. Coordinates and velocities with nonzero hold_p, hold_v
 * are held fixed (either may be NULL); iterations may be NULL. */
int zd_project(const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
               const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size);
/* States p (count, nq), v (count, nv) at times t (count,) within a finished run, from its samples of every step and its settings: the values
 * that the run itself would have saved at these times. Increasing times are fastest. */
int zd_states_between(const zd_system *system, const zd_settings *settings, const zd_saved *saved, int64_t count, const double *t, double *p,
                      double *v, char *message, int message_size);

#endif
