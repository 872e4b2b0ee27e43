/* Runs in lanes, with what is looked at lane by lane. */
#ifndef ZD_BATCH_GROUP_H
#define ZD_BATCH_GROUP_H

#include "../linalg/bracket.h"
#include "../output/reading.h"
#include "../run/run.h"
#include "lane_numbers.h"
#include "single_run.h"

/* What a lane's energy corrections have done, as the statistics have it */
typedef struct zd_lane_energy {
    int64_t corrections, skipped;
    double corrected;       /* J */
    int skipped_since_row;
} zd_lane_energy;

/* What is looked for in the step that a lane has just made: where events happen, at times within it. */
typedef struct zd_lane_search {
    enum { ZD_FOUND_ALL, ZD_LOCATES, ZD_LOCATES_END, ZD_CUTS, ZD_GOES_BEFORE, ZD_GOES_BEHIND } stage;
    int event;              /* which it is at */
    double *before, *now;   /* (events,): their values at the ends of the step */
    double number_of_now;   /* the step whose end that is; -1: none */
    zd_bracket *bracket;    /* (events,): when they happen; at infinity where they do not */
    double *early;          /* (size,): the state before the event, */
    double *mixed;          /* (size,): and where it happens */
    int ended;              /* which ends the run, counted from 1, */
    double end;             /* and when */
    int is_cut;             /* whether the last step has been made again, to there */
    int is_at_end;          /* whether the lane has got there, and its rows before that are saved */
} zd_lane_search;

typedef struct zd_lane_run {    /* in a lane */
    int64_t number;         /* of the batch; -1: none */
    int64_t rows;           /* saved so far */
    int64_t next;           /* of t_eval */
    int is_complete;        /* whether the row is saved at which an event has ended it */
    double kinetic_at_start, kinetic;   /* J; the largest that was seen */
    double energy;          /* J: without what has come in since the start */
    double *C;              /* (m, nv): in natural units, at the end of the step */
    double number_of_C;     /* the step at whose end C was evaluated; -1: not yet */
    zd_lane_search search;  /* where there are events */
    zd_lane_energy of_energy;
    int is_off;             /* whether the energy was off, where it was looked at, by more than nobody is told of */
} zd_lane_run;

typedef struct zd_lane_group {
    const zd_batch *batch;
    const zd_single_run *own;
    const zd_lane_functions *functions;
    zd_run *run;            /* checks at starts and at ends */
    void *start;            /* its memory for that */
    zd_lanes lanes;
    zd_lane_run run_of[ZD_MOST_LANES];
    int64_t next, active;   /* the run that begins next; how many are in lanes */
    double *p, *v, *C;      /* (nq,), (nv,), (m, nv): of one lane */
    zd_terms terms;         /* of the system, for C alone */
    zd_reader reader;       /* of events */
} zd_lane_group;

/* lanes.c: lays out the lanes of a run with direct functions or pins, the other being NULL. Called twice:
 * the first time only counts the memory. */
void zd_lanes_take(zd_lanes *self, zd_arena *arena, const zd_run *run, const zd_lane_functions *functions, const zd_direct *direct,
                   const zd_pins_plan *pins, int64_t doubles);
const zd_lane_functions *zd_lane_functions_for(enum zd_unit unit);
/* The functions for the unit, and those of the system that go with them; NULL: there are none. */
const zd_lane_functions *zd_lane_functions_of(const zd_system *system, enum zd_unit unit, const zd_direct **direct);
/* Everything of a lane, from another one or from the run, which stands at its start. */
void zd_lanes_copy(zd_lanes *self, int from, int to);
void zd_lanes_load(zd_lanes *self, int lane, zd_run *run, const double *data, int64_t doubles);

/* rows.c: saves what is due in the lanes, at the end of the last step and within it. */
void zd_lane_group_save(zd_lane_group *self);
/* When somebody has to look at the lane again. */
void zd_lane_group_set_next(zd_lane_group *self, int lane);

/* lane_state.c: whether the rows of C have turned by so much in a long step that it is not believed */
int zd_lane_group_is_turned(zd_lane_group *self, int lane);
/* Whether the run in the lane keeps its energy, where it is, as well as runs do that nobody is warned of. */
int zd_lane_group_keeps_energy(zd_lane_group *self, int lane);
/* Takes the run that checks at lanes to the state y at t of one. */
void zd_lane_group_stand(zd_lane_group *self, int lane, double t, const double *y);
void zd_lane_group_note_start(zd_lane_group *self, int lane);

/* lane_energy.c: as zd_lanes has correct_rest */
void zd_lane_group_correct_rest(void *group, const double *t, double *y, int forced);

/* lane_checks.c: lanes whose turn it is look at the step just made: at each part by itself, and at the energy. */
void zd_lane_group_check_closely(zd_lane_group *self);

/* lane_events.c: where events happen in the steps just made */
zd_lane_search zd_lane_search_take(zd_arena *arena, const zd_lanes *lanes);
void zd_lane_group_locate(zd_lane_group *self);
/* Takes the lane to the event that ends its run. */
void zd_lane_group_go_to_end(zd_lane_group *self, int lane);

/* The state y of a lane, as systems take it */
void zd_lane_group_gather(const zd_lane_group *self, int lane, const double *y);
const void *zd_lane_group_data(const zd_lane_group *self, int lane);

static inline double zd_lane_number(const zd_lanes *self, const double *numbers, int64_t i, int lane)
{
    return numbers[i * self->lanes + lane];
}

static inline void zd_lane_set(const zd_lanes *self, double *numbers, int64_t i, int lane, double value)
{
    numbers[i * self->lanes + lane] = value;
}

static inline int zd_lane_has_run(const zd_lane_group *self, int lane)
{
    return self->run_of[lane].number >= 0 && self->lanes.leaves[lane] == 0;
}

#endif
