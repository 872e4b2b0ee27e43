/* Events: instants at which a function of the motion passes through zero. */
#ifndef ZD_EVENTS_H
#define ZD_EVENTS_H

#include "../linalg/bracket.h"
#include "between.h"
#include "reading.h"

typedef struct zd_watch {
    const zd_events *events;    /* NULL: none */
    zd_output *output;
    zd_reader reader;       /* evaluates event functions without callbacks */
    double *before, *now;   /* (events,) values at the start and the end of the step */
    zd_bracket *bracket;    /* (events,) instants in the step; at infinity for events that do not occur */
    zd_state end;           /* end of the step, corrected */
    zd_state early, late, mixed;    /* states before and after an event; interpolated */
    int *found;             /* (events,) number of occurrences */
    int failed;             /* 1 + index of an event that could not be evaluated; 0: none */
    int ended;              /* 1 + index of the event that ended the run; 0: none */
} zd_watch;

zd_watch zd_watch_take(zd_arena *arena, const zd_events *events, zd_output *output);
int zd_watch_start(zd_watch *self);
/* Locates and reports the events of the last step; a terminal event moves the motion, and `end`, to its instant. */
int zd_watch_after(zd_watch *self, int corrected, double *end);

#endif
