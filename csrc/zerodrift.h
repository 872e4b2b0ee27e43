/* zerodrift: constrained multibody systems without constraint drift.
 *
 * The whole public C interface, with what a system is in the header that is shipped to those who write one. Declarations and nothing
 * else: CFFI reads what the preprocessor makes of this text. Equation numbers are those of W. Blajer, "Elimination of Constraint Violation
 * and Accuracy Aspects in Numerical Simulation of Multibody Systems", Multibody System Dynamics 7 (2002) 265-284.
 */
#ifndef ZERODRIFT_H
#define ZERODRIFT_H

#include <stddef.h>

#include "include/zerodrift/system.h"

/* ---- statuses, as ZD_STATUS_LIST has them ---- */

typedef struct zd_status_row {
    int status;
    const char *symbol;     /* "ZD_DONE" */
    const char *error;      /* the name of the error that Python raises; "": of the base of all */
    const char *sentence;
} zd_status_row;

const zd_status_row *zd_status_at(int row);     /* NULL: there are no more */

/* ---- the terms of a system, as ZD_TERM_LIST has them ---- */

typedef struct zd_term_row {
    int term;               /* its bit */
    const char *symbol;     /* what the bit is called: "ZD_M" */
    const char *name;       /* its member of zd_terms: "M" */
    const char *shape;      /* "ZD_MATRIX(nv, nv)" */
    size_t offset;          /* where that is, in bytes */
    enum zd_depends depends;
    const char *text;
} zd_term_row;

typedef struct zd_shape {
    int dimensions;         /* 0: a number, 1: (size[0],), 2: (size[0], size[1]) */
    int size[2];
} zd_shape;

const zd_term_row *zd_term_at(int row);                         /* NULL: there are no more */
zd_shape zd_term_shape(const zd_system *system, int row);       /* as the equations have it */
size_t zd_term_size(const zd_system *system, int row);          /* how many doubles evaluate() writes */

/* What it takes to eliminate C W C^T of a declared structure, W = M^-1. Multiplications are counted apart in blocks that have a kernel of
 * their size, [0], and in the others, [1]: of C W C^T, of its factors, and of a solve with them. */
typedef struct zd_structure_work {
    int columns, blocks, rows;  /* columns of blocks; blocks below the diagonal, with fill */
    double products[2], factors[2], solves[2];
    int has_products;           /* whether the system's own products serve, so that no C is stored */
    int is_of_many;             /* rows, so that bifurcations are not looked for */
    int is_alike;               /* whether bodies contribute alike to each row, so that solutions need not be compared */
    double share;               /* the smallest pivot, of its diagonal entry; 0: there is one that is not positive */
} zd_structure_work;

/* At (0, p, 0), where M has to be diagonal. Without a structure nothing is counted; ZD_NO_MEMORY, or what evaluate() has returned. */
int zd_structure_count(const zd_system *system, const double *p, zd_structure_work *work);

/* The first of the wanted terms that has an entry which is not finite, as its bit; 0: there is none. */
int zd_first_not_finite(const zd_system *system, int want, const zd_terms *terms);

/* Refuses a system whose sizes, terms or other members do not fit each other: ZD_BAD_ARGUMENT, and why in a sentence. */
int zd_check_system(const zd_system *system, char *message, int message_size);

/* ---- the four tables ---- */

enum zd_table { ZD_SYSTEMS, ZD_FORMULATIONS, ZD_INTEGRATORS, ZD_CORRECTIONS };

int zd_rows(enum zd_table table);
const zd_card *zd_row(enum zd_table table, int row);
int zd_row_named(enum zd_table table, const char *name);    /* -1: there is none */
int zd_default_row(enum zd_table table);    /* the one to take where nothing else is asked for */
int zd_correction_requires(int correction);     /* terms that a system has to provide for that row */
int zd_suits(const zd_system *system, int integrator);      /* whether that row can take the system */
int zd_formulation_suits(const zd_system *system, int formulation);

const zd_kind *zd_kind_of(int row);

/* ---- events: instants at which a function of the motion passes through zero ---- */

/* A number of the motion, or one that stays. */
enum zd_source { ZD_READS_TIME, ZD_READS_P, ZD_READS_V, ZD_READS_MEASURE, ZD_READS_NUMBER };

typedef struct zd_argument {
    enum zd_source what;
    int index;              /* of p, of v, or of a measure, which has to be one of positions or velocities */
    int component;          /* of the measure */
    double number;          /* one that stays */
} zd_argument;

/* A function of the motion that the core evaluates itself. */
typedef struct zd_event {
    int readings;           /* what it is a function of; 0: the core does not know, and has to ask */
    const zd_argument *reading;  /* (readings,) */
    double (*function)(const double *x);    /* of all of them; NULL: the first */
    double value;           /* which it reaches */
} zd_event;

typedef struct zd_events {
    int count;
    const int *direction;   /* (count,) 1: from below, -1: from above, 0: either */
    const int *terminal;    /* (count,) the run ends with so many of this event; 0: with none */
    const zd_event *known;  /* (count,) NULL: all have to be asked for */
    const zd_system *of;    /* whose measures they read; NULL: those of the system that is run */
    void *data;
    /* The value of an event that has to be asked for. Returns 0, or ZD_CALLBACK; the same goes for `found`, which is told where an event
     * happened. */
    int (*evaluate)(void *data, int event, double t, const double *p, const double *v, double *value);
    int (*found)(void *data, int event, double t, const double *p, const double *v);
} zd_events;

/* ---- outputs: measures that are recorded in every saved row ---- */

typedef struct zd_outputs {
    const zd_system *of;    /* whose measures: of what moves, or of its equations in another form; NULL: those of the system that is run */
    int count;
    const int *measure;     /* (count,) which of them; their components stand in a row one after the other */
} zd_outputs;

/* ---- settings of a run ---- */

enum { ZD_CORRECTIONS_MAX = 8, ZD_ROW_VALUES = 16 };

/* The parameters of a row of a table, as its card lists them. */
typedef struct zd_given {
    int given;                      /* 0: a correction is off; a formulation or an integrator has its initial ones */
    double value[ZD_ROW_VALUES];    /* one after the other */
} zd_given;

/* What to do at a bifurcation, where constraints depend on each other that are independent elsewhere, so that the motion can go on in
 * more than one way: end the run, or go on along the branch that the motion is on; from rest, along that of least acceleration. */
enum zd_on_singular { ZD_STOP, ZD_CONTINUE };

typedef struct zd_settings {
    int formulation, integrator;    /* rows of the tables */
    double t0, t1;                  /* s */
    double step;                    /* s; the last step is shortened to end at t1. 0: chosen by the error estimate */
    double rtol, atol;              /* of the state, per step, where steps are chosen */
    double first_step, max_step;    /* s; 0: no bound, nothing given */
    double max_move;                /* of an entry of p in a step, in its unit, where steps are chosen; 0: no bound */
    int64_t max_steps;                 /* where steps are chosen, the run fails after so many; 0: no bound */
    int64_t save_every;
    const double *t_eval;           /* (t_evals,) times to save at, instead of every so many steps; NULL: none */
    int64_t t_evals;
    const zd_events *events;        /* NULL: none */
    const zd_outputs *outputs;      /* NULL: none */
    zd_given of_formulation, of_integrator;
    zd_given correction[ZD_CORRECTIONS_MAX];        /* of each row of the table */
    enum zd_on_singular on_singular;
    int direct;                     /* whether direct functions are taken where the system brings any and they serve, */
    enum zd_unit vector;            /* and the last vector unit that these may use */
    int given_jacobian;             /* whether somebody wrote C and Phi_t down beside Phi: they are then compared now and then */
} zd_settings;

/* Its parameters as they are where nothing else is asked for. */
zd_given zd_initial(const zd_card *card);
/* Where one of them is among the values, by its name; NULL: there is none of that name. */
double *zd_value_named(zd_given *given, const zd_card *card, const char *name);
/* Whether they keep to the rules that their card states, and those of the row; else the first that does not is named in `message`. */
int zd_check_given(enum zd_table table, int row, const zd_given *given, char *message, int message_size);

enum zd_unit zd_processor_unit(void);       /* the last that this processor has */
int zd_processor_has(enum zd_unit unit);

/* What libraries are handed that were compiled with ZD_FAR_SINES_OF_CORE: see zerodrift/sines.h. */
void zd_far_sines(int n, const double *angle, double *s, double *c);
void zd_far_reductions(int n, const double *angle, double *r, double *tail, uint64_t *quadrant);

/* ---- a run ---- */

typedef struct zd_statistics {
    int64_t steps;
    int64_t direct_steps;          /* of these, made by direct functions */
    int64_t rejected;              /* steps whose error estimate was too large, or that failed and were tried smaller */
    int64_t output_steps;          /* shorter ones, to times between steps: to be saved, or where an event is looked for */
    int64_t evaluations;           /* calls of the system */
    int64_t factorizations;        /* of leading matrices */
    int64_t solves;                /* with them */
    int64_t position_iterations;
    int64_t max_position_iterations;   /* in one step */
    int64_t velocity_corrections;
    int64_t energy_corrections;
    int64_t energy_skipped;        /* where (29) has no bounded solution: T too small for the violation */
    int64_t damped;                /* position corrections that converged only with shortened iterations */
    int64_t subdivided;            /* steps of fixed size that were made in parts, as their correction failed */
    int64_t too_long;              /* steps of fixed size, longer than the method is stable for or, if always stable, resolves */
    int64_t stiff;                 /* steps, of those looked at, that stability rather than the error asked for held down */
    int64_t implicit_iterations;   /* Newton iterations of implicit integrators */
    int64_t embedding_iterations;  /* Newton iterations for p = g(q) */
    int64_t repartitions;          /* changes of the independent variables between steps, or to (p, v) near a bifurcation */
    int64_t rank;                  /* of C; less than m where constraints are redundant */
    int64_t rank_drops;            /* steps in which it was less for a while */
    int64_t unresolved;            /* looks at steps of fixed size that showed a part of the motion which they do not resolve */
    double unresolved_time;     /* s: of the first */
    double part_error;          /* what successive steps miss of the motion of one part: the most, in natural units */
    int64_t part;                  /* the coordinate, or with a kinematic matrix the velocity, that it is; from nv on, a quaternion */
    double smallest_pivot;      /* of structures of many rows: the least part of its diagonal entry that a pivot of C M^-1 C^T was; 0: nowhere looked at */
    double smallest_pivot_time; /* s: where, */
    int64_t smallest_pivot_row;    /* and of which row */
    double energy_corrected;    /* J: the most that an energy correction has taken out or put in at once */
} zd_statistics;

typedef struct zd_record {      /* one row per saved instant; memory belongs to the caller */
    int64_t capacity, rows;        /* of any size: where it is full, the run goes on with another, or with the same emptied */
    double *t;                  /* (capacity,) */
    double *p, *v, *multipliers;                    /* (capacity, nq), (capacity, nv), (capacity, m) */
    double *position_violation, *velocity_violation;    /* (capacity, mh), (capacity, m) */
    double *kinetic, *potential, *input, *energy_violation; /* (capacity,) J; the last three NULL without potential */
    int *iterations;            /* (capacity,) most position iterations of a step since the row before */
    int *energy_skipped;        /* (capacity,) energy corrections left out since the row before */
    double *outputs;            /* (capacity, components of all outputs); NULL where there are none */
} zd_record;

typedef struct zd_saved {       /* the rows of a run in which every step was saved, at least one */
    int64_t rows;
    const double *t;            /* (rows,) increasing */
    const double *p, *v;        /* (rows, nq), (rows, nv) */
    const double *input;        /* (rows,) J; NULL where there is none */
    int ends_in_event;          /* whether the last row is a terminal event */
    int64_t stride;             /* numbers from a row to the next, the same in each array, as in a file of rows; 0: arrays are contiguous */
} zd_saved;

typedef struct zd_run zd_run;

/* Steps from t0 to t1: a span within rounding of a whole number of steps has that many, else a shorter one is added. */
double zd_count_steps(double t0, double t1, double step);

/* Whether a run with these settings takes direct functions, where its system brings any; for another they need not be made. */
int zd_takes_direct(const zd_settings *settings);
/* Whether these are others, namely for formulations in independent velocities. */
int zd_takes_embeddings(const zd_settings *settings);
/* Whether the formulation can take such functions of this system. */
int zd_may_have_direct(const zd_system *system, const zd_settings *settings);
/* Whether formulation, integrator and corrections go together; else says why not. */
int zd_check_methods_agree(const zd_settings *settings, char *message, int message_size);
/* Whether it takes the system's series. */
int zd_takes_series(const zd_settings *settings);
/* Whether it takes the system's Jacobian, where there is one. */
int zd_takes_jacobian(const zd_settings *settings);
/* The vector unit of the direct functions that a run of this system takes; -1: it takes none. */
int zd_direct_unit(const zd_system *system, const zd_settings *settings);

/* All memory of a run is taken here. On failure returns NULL and says why in `status` and `message`, of at least one character. */
zd_run *zd_run_create(const zd_system *system, const zd_settings *settings, const double *p0, const double *v0,
                      int *status, char *message, int message_size);
void zd_run_free(zd_run *run);
/* Steps until the end, a full record, or about `seconds` have passed. The slicing changes no bit of the result. */
int zd_run_advance(zd_run *run, zd_record *record, double seconds);
double zd_run_progress(const zd_run *run);                  /* 0 ... 1 */
const char *zd_run_message(const zd_run *run);              /* the first failure, one sentence */
const zd_statistics *zd_run_statistics(const zd_run *run);
/* The constraints that follow from others wherever the system goes; their number. rows (m,), increasing. */
int zd_run_redundant(const zd_run *run, int *rows);
/* (mh,): the size of each row of Phi at the start: what the largest of its coordinates' natural motions makes of it, one radian
 * of an angle or the mechanism's own length. */
const double *zd_run_sizes(const zd_run *run);
double zd_run_kinetic(const zd_run *run);                   /* J: the largest energy seen after a step */
double zd_run_energy_error(const zd_run *run);              /* J: the largest |Psi_E| (28) of the rows saved so far */
double zd_run_omega_h(const zd_run *run);                   /* largest omega h of the motion in any step of fixed size */

/* ---- many runs of one system, whose numbers differ ---- */

enum zd_way { ZD_NOT_BEGUN, ZD_BY_ITSELF, ZD_IN_LANES, ZD_UNUSUAL };     /* how a run was made: not, as one that is created, or beside others */

/* Systems of one shape, of which every run has its own. */
typedef struct zd_family {
    const void *of;
    /* The system of a run, and where it starts if this is not known before, p (nq,), v (nv,). NULL: it is one that somebody has to look at
     * more closely. In any case free(*made) has to follow. Several threads may call it. */
    const zd_system *(*make)(const void *of, int64_t run, double *p, double *v, void **made);
    void (*free)(void *made);
} zd_family;

/* Runs that differ by the data of their system and by their start. Entries of a run follow those of the run before; results that are NULL are
 * not wanted. */
typedef struct zd_batch {
    const zd_system *system;        /* whose functions do not need Python */
    const zd_settings *settings;    /* whose events are all known: nobody is asked for them, nor told of them */
    int settings_differ;            /* whether they are (runs,), which begin at the same time, and have the events and outputs of the first */
    int64_t runs;
    const double *data;             /* (runs, doubles): in the place of the system's; NULL: that is the same for all */
    int64_t doubles;                /* that this is; 0: it consists of others, and is the same for all */
    const zd_family *family;        /* NULL: all have the system, but for its data */
    const double *p0, *v0;          /* (runs, nq), (runs, nv); NULL: as the family finds them */
    const zd_settings *assembly;    /* starts are put onto the constraints first, as zd_project() does it by these; NULL: they are not */
    const int *hold_p, *hold_v;     /* (nq,), (nv,): what that holds; NULL: nothing */
    int lanes;                      /* whether runs are made in vector lanes where they can */
    const int *stop;                /* no run goes on once this is not 0; NULL: all do */
    int64_t capacity;               /* rows of a run that there is room for */
    double *t, *p, *v, *multipliers;        /* (runs, capacity), (runs, capacity, nq), (runs, capacity, nv), (runs, capacity, m) */
    double *input;                  /* (runs, capacity) J */
    int *iterations, *energy_skipped;       /* (runs, capacity) */
    double *outputs;                /* (runs, capacity, components of all outputs) */
    int64_t events_capacity;        /* of each event of a run: so many that there is room for */
    int64_t *found;                 /* (runs, events) how often each has happened, also where there was no room for it; NULL: no events */
    double *t_events, *p_events, *v_events; /* (runs, events, events_capacity), (.., nq), (.., nv): where the first of them did */
    int64_t *rows;                  /* (runs,) that were saved */
    int *status;                    /* (runs,) ZD_PAUSED where it was stopped */
    int *way;                       /* (runs,) of zd_way; one that could not be created is not begun, and what its family does not make is unusual */
    zd_statistics *statistics;      /* (runs,) */
    double *kinetic, *energy_error; /* (runs,) as zd_run_kinetic() and zd_run_energy_error() have them */
    /* (runs,), of runs that are made by themselves: as zd_run_omega_h() has it; the largest |Phi| and |Psi| of the saved rows, NaN where
     * there are none; and the time that each took, in s */
    double *omega_h, *position_violation, *velocity_violation, *seconds;
    char *message;                  /* (runs, message_size): of runs that failed, or ended early */
    int message_size;
} zd_batch;

int zd_lanes_of_unit(enum zd_unit unit);     /* how many runs are made side by side with it; 0: the core is compiled without it */
/* What is wrong with a run is said of that run; only where there is no memory for any it is returned. Calls for other batches may be made
 * at the same time. */
int zd_batch_run(const zd_batch *batch);

/* Rows of a run that was made in lanes, with what these leave out, from the states that they keep: (rows, nq), (rows, nv), and what has
 * come in of energy. The run has to be one from the same start, and is of no other use then. */
int zd_run_record_states(zd_run *run, int64_t rows, const double *t, const double *p, const double *v, const double *input, zd_record *record);

/* The tables of a batch from the parameters of a kind of system (runs, all parameters): constants (runs, kind->constants), starts (runs, nq),
 * (runs, nv). The number of the first run whose parameters are refused, and why; or `runs`. */
int64_t zd_batch_of_kind(const zd_kind *kind, int64_t runs, const double *parameters, double *constants, double *p0, double *v0,
                         const char **reason);
/* derive(row) for each row of data (runs, doubles). */
void zd_batch_derive(void (*derive)(double *data), int64_t runs, int64_t doubles, double *data);

/* ---- a system that is off by rounding, to see what that does to its motion ---- */

/* Factors near 1 of what the system is evaluated at, and of what it then writes. Entries of M come in equal pairs. */
typedef struct zd_perturbation {
    const double *numbers;      /* what its series read, which find them here: the first member; NULL: it has none */
    const zd_series *series;    /* of the motion that follows from all of this; NULL: it has none */
    const zd_system *system;
    double t;
    const double *p, *v;    /* (nq,), (nv,) */
    zd_terms terms;         /* NULL: as they are */
} zd_perturbation;

zd_system zd_perturbed(const zd_perturbation *perturbation);      /* it refers to the perturbation and to its system */

/* ---- the same operations outside a run; each writes a sentence into `message` where it fails ---- */

int zd_acceleration(const zd_system *system, int formulation, enum zd_on_singular on_singular, double t, const double *p, const double *v,
                    double *vdot, double *multipliers, char *message, int message_size);
/* The same at many states: t (rows,), p (rows, nq), v (rows, nv) give vdot (rows, nv) and multipliers (rows, m). */
int zd_accelerations(const zd_system *system, int formulation, enum zd_on_singular on_singular, int64_t rows, const double *t,
                     const double *p, const double *v, double *vdot, double *multipliers, char *message, int message_size);
/* A measure at many states: values (rows, size); scratch as the measures ask for. vdot, multipliers may be NULL where it does not depend
 * on them. */
int zd_measure_states(const zd_system *system, int measure, int64_t rows, const double *t, const double *p, const double *v,
                      const double *vdot, const double *multipliers, double *values, double *scratch);
/* Corrects p and v in place as the corrections that are given do, holding coordinates and velocities where hold_p, hold_v are
 * nonzero (either may be NULL); iterations may be NULL. */
int zd_project(const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
               const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size);
/* States p (count, nq), v (count, nv) at times t (count,) from the first to the last row of a run that was made with these settings, and that
 * saved every step: what it would have saved there. Times that increase take the least. */
int zd_states_between(const zd_system *system, const zd_settings *settings, const zd_saved *saved, int64_t count, const double *t, double *p,
                      double *v, char *message, int message_size);

#endif
