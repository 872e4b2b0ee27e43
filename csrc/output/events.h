/* Events: instants at which a function of the motion passes through zero. */
#ifndef ZD_EVENTS_H
#define ZD_EVENTS_H

#include "../linalg/bracket.h"
#include "between.h"
#include "reading.h"

typedef struct zd_watch {   /* where there are events, (events,) each */
    const zd_events *events;    /* NULL: there are none */
    zd_output *output;
    zd_reader reader;       /* of those that the core knows */
    double *before, *now;   /* their values at the ends of the step */
    zd_bracket *bracket;    /* when they happen in it; at infinity where they do not */
    zd_state end;           /* of the step, corrected */
    zd_state early, late, mixed;    /* the states at both sides of an event, and between them where they are mixed */
    int *found;             /* how often they have */
    int failed;             /* which could not be evaluated, counted from 1 */
    int ended;              /* which ended the run, counted from 1 */
} zd_watch;

zd_watch zd_watch_take(zd_arena *arena, const zd_events *events, zd_output *output);
int zd_watch_start(zd_watch *self);
/* Finds those of the step just made, which was corrected or not; where one of them is terminal, the motion and `end` are taken to it. */
int zd_watch_after(zd_watch *self, int corrected, double *end);

#endif
