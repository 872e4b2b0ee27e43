/* Events: instants at which a function of the motion passes through zero. */
#ifndef ZD_EVENTS_H
#define ZD_EVENTS_H

#include "step_samples.h"

zd_watch zd_watch_create(zd_arena *arena, const zd_events *events, zd_output *output);
int zd_watch_start(zd_watch *self);
/* Locates and reports the events of the last step; a terminal event moves the motion, and `end`, to its instant. */
int zd_watch_after(zd_watch *self, int corrected, double *end);

#endif
