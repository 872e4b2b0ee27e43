/* Events: instants at which a function of the motion passes through zero. */
#ifndef ZD_EVENTS_H
#define ZD_EVENTS_H

#include "between.h"

typedef struct zd_watch {   /* where there are events, (events,) each */
    const zd_events *events;    /* NULL: there are none */
    zd_output *output;
    double *before, *now;   /* their values at the ends of the step */
    double *time;           /* when they happen in it; infinite where they do not */
    int *found;             /* how often they have */
    int failed;             /* whether it was an event that could not be evaluated */
    int ended;              /* which ended the run, counted from 1 */
} zd_watch;

zd_watch zd_watch_take(zd_arena *arena, const zd_events *events, zd_output *output);
int zd_watch_start(zd_watch *self);
/* Finds those of the step just made; where one of them is terminal, the motion and `end` are taken to it. */
int zd_watch_after(zd_watch *self, double *end);

#endif
