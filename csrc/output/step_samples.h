/* Samples of event functions within a step. */
#ifndef ZD_STEP_SAMPLES_H
#define ZD_STEP_SAMPLES_H

#include "watch.h"

/* y (n,) <- the cubic Hermite polynomial of a step of size h, at a fraction x of it */
void zd_interpolate_cubic(int n, double x, double h, const double *y0, const double *rate0, const double *y1, const double *rate1,
                          double *y);
/* Evaluates the rates at the start of a fixed step; without them, events are sought by the ends of the step alone. */
void zd_watch_before(zd_watch *self);
/* Applies all corrections at the point. */
int zd_watch_correct(zd_stepper *stepper);
/* Moves to a time within the step or at its ends, corrected. */
int zd_watch_move(zd_watch *self, double t);
/* Leaves the end of the step for values within it. Dense output belongs to the step before the corrections at the point. */
int zd_watch_leave(zd_watch *self);
/* *occurs <- true if any event may occur in the step to the point, by both ends and by values between them. */
int zd_watch_predict(zd_watch *self, int *occurs);
/* Sets the ends of the step in the points of all events, and the number of samples between them. */
void zd_watch_span(zd_watch *self);
/* Points of all events between which they pass zero at most once; the end of the step has been saved. */
int zd_watch_sample(zd_watch *self);

#endif
