/* Runs side by side: open ones, and batches: part of zerodrift.h. */
#ifndef ZERODRIFT_MANY_RUNS_H
#define ZERODRIFT_MANY_RUNS_H

#include "run.h"

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
/* zd_run_measure() of all: values (runs, size). systems (runs,): those that have the measures. For a measure of accelerations no run may be
 * behind its lane. */
int zd_open_runs_measure(const zd_open_runs *self, const zd_system *const *systems, int measure, double *values, double *scratch);

/* True if SIMD lanes suit the system and the settings of a run, provided that it has closed-form functions for them. */
int zd_lanes_serve_settings(const zd_system *system, const zd_settings *settings);
/* SIMD lanes for the runs from `first` on, in which each run has the bits that it has alone; NULL if they do not serve these runs. */
zd_open_lanes *zd_open_lanes_create(const zd_open_runs *runs, int64_t first, int64_t count);
void zd_open_lanes_free(zd_open_lanes *self);
/* zd_open_runs_advance() of these runs. A run itself may then be behind its lane. */
void zd_open_lanes_advance(zd_open_lanes *self, int64_t steps, double t);
/* Brings run i, which is behind its lane, to the present state; returns its status. */
int zd_open_lanes_update_run(zd_open_lanes *self, int64_t i);
/* Run i is replaced by another one. */
void zd_open_lanes_discard(zd_open_lanes *self, int64_t i);

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
    int64_t *samples;               /* (runs,) samples stored */
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

/* Completes the samples of a run in SIMD lanes, which store states only: multipliers, violations, energies and outputs at p (samples, nq),
 * v (samples, nv), with the energy input (samples,). `run` must be newly created from the same start, and can only be freed afterwards. */
int zd_run_record_states(zd_run *run, int64_t samples, const double *t, const double *p, const double *v, const double *input,
                         zd_record *record);

/* Tables of a batch from the parameters of a kind of system (runs, all parameters): constants (runs, kind->constants), starts (runs, nq),
 * (runs, nv). Returns the index of the first run whose parameters are invalid, with the reason; `runs` if all are valid. */
int64_t zd_batch_of_kind(const zd_kind *kind, int64_t runs, const double *parameters, double *constants, double *p0, double *v0,
                         const char **reason);
/* Calls derive() for each row of data (runs, doubles). */
void zd_batch_derive(void (*derive)(double *data), int64_t runs, int64_t doubles, double *data);

#endif
