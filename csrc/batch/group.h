/* Runs in lanes, with the checks that are made lane by lane. */
#pragma once

#include "../contact/gaps.h"
#include "../output/watch.h"
#include "../run/run.h"
#include "batch.h"
#include "lanes/numbers.h"

/* Statistics of a lane's energy corrections. */
typedef struct zd_lane_energy {
    int64_t corrections, skipped;
    double corrected;       /* J */
    int skipped_since_sample;
} zd_lane_energy;

/* Event location in the step that a lane has just made. */
typedef struct zd_lane_search {
    enum { ZD_FOUND_ALL, ZD_SAMPLES_STEP, ZD_FINDS_PAIRS, ZD_LOCATES, ZD_LOCATES_END, ZD_CUTS, ZD_GOES_BEFORE, ZD_GOES_BEHIND } stage;
    int sample;             /* number of the next sample within the step */
    int event, point;       /* the event being located; the second of the points between which it is */
    int number;             /* number of its occurrences located in the step */
    int index;              /* index of the occurrence whose state is found */
    double *before, *now;   /* (events,): event functions at the ends of the step */
    double number_of_now;   /* number of the step that ended at `now`; -1: none */
    zd_zeros *zeros;        /* (events,): values within the step */
    zd_occurrence *occurrence;  /* (events * ZD_MAX_POINTS,): in the step, by event and time */
    int occurrences;        /* their number */
    int last;               /* index of the one that ends the run; -1: none */
    zd_occurrence cut;      /* the same, where the step was repeated up to it */
    double *early;          /* (size,): state before the event */
    double *mixed;          /* (size,): state at the event */
    int ended;              /* the event that ends the run or acts, counted from 1; 0: none */
    int goes_on;            /* 1: it only acts */
    double end;             /* time of that event */
    int *acts;              /* (events,): 1 if it acts at that time */
    int is_cut;             /* 1: the last step was repeated up to that event */
    int is_at_end;          /* 1: the lane has reached it, and the samples before are saved */
} zd_lane_search;

typedef struct zd_lane_run {    /* state of the run in a lane */
    int64_t number;         /* index in the batch; -1: none */
    int64_t samples;        /* number of samples saved */
    int64_t next;           /* index of the next time of t_eval */
    int is_complete;        /* 1: the sample at the event that ended the run is saved */
    double kinetic_at_start, kinetic;   /* J: kinetic energy at the start, and its largest value */
    double energy;          /* J: energy at the start */
    double *C;              /* (m, nv): in characteristic scales, at the end of the step */
    double number_of_C;     /* number of the step at whose end C was evaluated; -1: none */
    zd_lane_search search;  /* event location */
    zd_gaps gaps[2];        /* gaps of contacts at the start and the end of the step */
    zd_lane_energy of_energy;
    int is_off;             /* 1: a check found an energy error that deserves a warning */
} zd_lane_run;

typedef struct zd_lane_group {
    const zd_batch *batch;
    const zd_single_run *own;
    const zd_lane_functions *functions;
    zd_system *system;      /* full system of that run, whose data become those of a lane where constraints switch */
    zd_run *run;            /* run that evaluates starts and checks; it stays in the phase in which no group acts */
    void *start;            /* its memory for starts */
    zd_lanes lanes;
    zd_lane_run run_of[ZD_MAX_LANES];
    int64_t next, active;   /* next run to begin; number of runs in lanes */
    double *p, *v, *C;      /* (nq,), (nv,), (m, nv): state and constraint matrix of one lane */
    double *numbers;        /* (doubles,): data of one lane, which events change; NULL: none do */
    zd_terms terms;         /* terms of the system, for C alone */
    zd_reader reader;       /* reader of event functions */
} zd_lane_group;

/* lanes.c: allocates the lanes of a run. It is called twice: first with an empty arena, to count the memory. */
void zd_lanes_create(zd_lanes *self, zd_arena *arena, const zd_run *run, const zd_lane_functions *functions,
                     const zd_closed_form *closed_form, int64_t doubles);
/* Functions of the unit, and the system's closed-form functions for it; NULL: there are none. */
const zd_lane_functions *zd_lane_functions_of(const zd_system *system, enum zd_unit unit, const zd_closed_form **closed_form);
/* Copies all numbers of a lane from another one; or sets them from the run, which is at its start. */
void zd_lanes_copy(zd_lanes *self, int from, int to);
void zd_lanes_load(zd_lanes *self, int lane, zd_run *run, const double *data, int64_t doubles);

/* lane_samples.c: saves the samples that are due at the end of the last step and within it. */
void zd_lane_group_save(zd_lane_group *self);
/* Sets the time and step number of the lane's next sample. */
void zd_lane_group_set_next(zd_lane_group *self, int lane);

/* lane_state.c: true if the rows of C have turned by so much in a long step that it is rejected. */
int zd_lane_group_is_turned(zd_lane_group *self, int lane);
/* True if the energy error of the run in the lane is too small for a warning. */
int zd_lane_group_keeps_energy(zd_lane_group *self, int lane);
/* Sets the checking run to the state y of a lane at t. */
void zd_lane_group_stand(zd_lane_group *self, int lane, double t, const double *y);
void zd_lane_group_note_start(zd_lane_group *self, int lane);

/* lane_checks.c: correct_rest of zd_lanes. */
void zd_lane_group_correct_rest(void *group, const double *t, double *y, int forced);

/* lane_checks.c: full checks of the last step, in lanes in which they are due: resolution of each velocity, and energy. */
void zd_lane_group_check_closely(zd_lane_group *self);

zd_lane_search zd_lane_search_create(zd_arena *arena, const zd_lanes *lanes);
/* lane_event_samples.c: value of an event function at the gathered state; those of all at the state y. */
double zd_lane_group_evaluate(zd_lane_group *self, int lane, int event, double t);
void zd_lane_group_evaluate_all(zd_lane_group *self, int lane, double t, const double *y, double *values);
/* Change of an event function when the gathered state changes by its rounding. */
double zd_lane_group_rounding(zd_lane_group *self, int lane, int event, double t, double value);
/* Begins the samples of the step: sets its ends in the points of all events. */
void zd_lane_group_span(zd_lane_group *self, int lane);
/* Values of event functions by cubic Hermite polynomials; returns 1 if an event may occur twice. */
int zd_lane_group_predict(zd_lane_group *self, int lane);
/* Adds the gathered state to the samples of the step. */
void zd_lane_group_add_sample(zd_lane_group *self, int lane, double t);

/* lane_events.c: locates the events of the last steps. */
void zd_lane_group_locate(zd_lane_group *self);
/* Sets the state of the lane to that at the event that ends its run. */
void zd_lane_group_go_to_end(zd_lane_group *self, int lane);

/* lane_contacts.c: true if all contacts stay open in the last step of a lane, and the user has no events. */
int zd_lane_contacts_stay_open(zd_lane_group *self, int lane);
/* True if the event at which the search stands is that of a contact; the lane then leaves. */
int zd_lane_contact_leaves(zd_lane_group *self, int lane);

/* lane_actions.c: number of the occurrence of the event that ends the run; the next one, if it acts. */
int64_t zd_lane_last_of(const zd_lane_group *self, const zd_lane_run *run, int event);
/* Sets inputs in lanes that are at an event which acts, and lets them go on. */
void zd_lane_group_act(zd_lane_group *self);

/* Copies the state y of a lane to p, v. */
void zd_lane_group_gather(const zd_lane_group *self, int lane, const double *y);
/* Argument `data` of functions of the checking run, for these numbers of a system; for those of a lane. */
const void *zd_lane_group_data_of(const zd_lane_group *self, const void *numbers);
const void *zd_lane_group_data(const zd_lane_group *self, int lane);

static inline double zd_lane_number(const zd_lanes *self, const double *numbers, int64_t i, int lane)
{
    return numbers[i * self->lanes + lane];
}

/* to (count,) <- the numbers of a lane. */
static inline void zd_lane_store(const zd_lanes *self, int lane, int64_t count, const double *from, double *to)
{
    for (int64_t i = 0; i < count; i++) to[i] = zd_lane_number(self, from, i, lane);
}

static inline void zd_lane_set(const zd_lanes *self, double *numbers, int64_t i, int lane, double value)
{
    numbers[i * self->lanes + lane] = value;
}

/* Number of the user's events, which come before those of contacts. */
static inline int zd_lane_group_own_events(const zd_lane_group *self)
{
    return self->batch->settings->events ? self->batch->settings->events->count : 0;
}

static inline int zd_lane_has_run(const zd_lane_group *self, int lane)
{
    return self->run_of[lane].number >= 0 && self->lanes.leaves[lane] == 0;
}
