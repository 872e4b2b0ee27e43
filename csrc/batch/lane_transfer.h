/* Open runs in SIMD lanes, groups of as many as a vector has lanes; and their transfer between a lane and their own memory. */
#ifndef ZD_LANE_TRANSFER_H
#define ZD_LANE_TRANSFER_H

#include "group.h"

/* Place of a run: in its lane, or made individually because the lanes cannot make its steps. */
typedef struct zd_lane_place {
    unsigned char is_in;    /* true: the lane has the present state of the run */
    unsigned char has_new;  /* true: the inputs of the present advance differ from those before */
    unsigned char is_slow;  /* true: no step of the last advance, made individually, was in closed form */
} zd_lane_place;

struct zd_open_lanes {
    const zd_open_runs *runs;
    int64_t first, count;   /* the runs of these lanes */
    const zd_lane_functions *functions;
    const zd_elimination *order;    /* closed-form functions of a single run, common to all runs in lanes */
    zd_lanes lanes;         /* numbers of the present group */
    double *image;          /* (groups, numbers): those of each group between two advances */
    size_t numbers;         /* doubles of the state of a group */
    zd_lane_place *place;   /* (count,) */
    int64_t *goal;          /* (lanes,): step at which each lane of the present group stops */
};

/* True if a run at the end of a step may continue in a lane. */
int zd_lane_may_enter(const zd_open_lanes *self, const zd_run *run);
/* Lane <- state of run i, whose order of elimination is chosen later. */
void zd_lane_enter(zd_open_lanes *self, int lane, int64_t i);
/* Run i <- state y of a lane at time t, after so many steps. Returns the status of the run. */
int zd_lane_put_back(zd_open_lanes *self, int lane, int64_t i, double t, double steps, const double *y);

#endif
