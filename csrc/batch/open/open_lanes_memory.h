/* Open runs in SIMD lanes, groups of as many as a vector has lanes. */
#ifndef ZD_OPEN_LANES_MEMORY_H
#define ZD_OPEN_LANES_MEMORY_H

#include "../group.h"

/* Place of a run: in its lane, or made individually because the lanes cannot make its steps. */
typedef struct zd_lane_place {
    unsigned char is_in;    /* true: the lane has the present state of the run */
    unsigned char is_behind;    /* true: inputs have changed since the run itself had the last ones */
    unsigned char is_slow;  /* true: no step of the last advance, made individually, was in closed form */
} zd_lane_place;

/* Source from which lanes read an input: a number of their data, of their inputs, or -1. */
typedef struct zd_lane_input_place {
    int input;
    int64_t in_data, in_inputs;
} zd_lane_input_place;

typedef struct zd_lane_inputs {
    int count, places, derivations;
    zd_lane_input_place *place;     /* (places,) */
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
    zd_lane_place *place;   /* (count,) */
    zd_lane_inputs inputs;
    int64_t *goal;          /* (lanes,): step at which each lane of the present group stops */
};

#endif
