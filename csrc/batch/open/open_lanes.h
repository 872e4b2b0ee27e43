
#pragma once

#include "../group.h"

/* Open runs in SIMD lanes, groups of as many as a vector has lanes. */

/* Place of a run: in its lane, or made individually because the lanes cannot make its steps. */
typedef struct zd_lane_slot {
    unsigned char is_in;    /* true: the lane has the present state of the run */
    unsigned char is_behind;    /* true: inputs have changed since the run itself had the last ones */
    unsigned char is_slow;  /* true: no step of the last advance, made individually, was in closed form */
} zd_lane_slot;

/* Source from which lanes read an input: a number of their data, of their inputs, or -1. */
typedef struct zd_lane_input_slot {
    int input;
    int64_t in_data, in_inputs;
} zd_lane_input_slot;

typedef struct zd_lane_inputs {
    int count, places, derivations;
    zd_lane_input_slot *place;     /* (places,) */
    void (**derive)(double *data);  /* (derivations,): functions that recompute what the system derives from its data */
    const double **value;           /* (runs,) memory of the values (count,), which are read at the start of each advance */
    double *held, *lower, *upper;   /* (runs, count): values as the lanes have them, and limits */
    double *numbers;                /* (doubles,): data of one lane */
} zd_lane_inputs;

struct zd_open_lanes {
    const zd_open_runs *runs;
    int64_t first, count;   /* the runs of these lanes */
    const zd_lane_functions *functions;
    const zd_elimination *order;    /* closed-form functions of a single run, common to all runs in lanes */
    zd_lanes lanes;         /* numbers of the present group */
    double *image;          /* (groups, numbers): those of each group between two advances */
    size_t numbers;         /* doubles of the state of a group */
    zd_lane_slot *place;   /* (count,) */
    zd_lane_inputs inputs;
    int64_t *goal;          /* (lanes,): step at which each lane of the present group stops */
    double *y, *scratch;    /* (size,): state of one lane; for functions of its system */
};

/* Inputs of open runs in lanes. */

zd_lane_inputs zd_lane_inputs_create(zd_arena *arena, const zd_open_runs *runs, int64_t first, int64_t count);
/* True if run i has the places and functions of the first one. */
int zd_lane_inputs_fit(const zd_open_lanes *self, int64_t i);
/* Takes over the inputs of run i, which writes new ones first; returns true if it had new ones. */
int zd_lane_inputs_enter(zd_open_lanes *self, int64_t i);
/* Gives run i the inputs of its lane; has_moved: the run is to be at another step than before. */
void zd_lane_inputs_put_back(zd_open_lanes *self, int64_t i, int has_moved);
/* Reads the inputs of run i, in a lane of the present group: 1 if they are new, 0 if not, -1 if they are refused and those before stay. */
int zd_lane_inputs_read(zd_open_lanes *self, int lane, int64_t i);

/* Transfer of open runs between a lane and their own memory. */

/* True if a run at the end of a step may continue in a lane. */
int zd_lane_may_enter(const zd_open_lanes *self, const zd_run *run);
/* Lane <- state of run i, whose order of elimination is chosen later. */
void zd_lane_enter(zd_open_lanes *self, int lane, int64_t i);
/* Run i <- state y of a lane at time t, after so many steps. Returns the status of the run. */
int zd_lane_put_back(zd_open_lanes *self, int lane, int64_t i, double t, double steps, const double *y);
