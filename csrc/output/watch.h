/* Event functions of a run: their values, and what their location needs. */
#pragma once

#include "../contact/gaps.h"
#include "../linalg/bracket.h"
#include "reading.h"
#include "within_step.h"
#include "zeros.h"

typedef struct zd_occurrence {
    int event, point;       /* the second of the points between which it lies */
    zd_bracket bracket;     /* s: its instant */
} zd_occurrence;

/* Rates at one end of a fixed step, of the cubic Hermite polynomial. */
typedef struct zd_end_rates {
    double *pdot, *vdot;    /* (nq,), (nv,); NULL with adaptive steps */
    int are_known;          /* true if both are set */
} zd_end_rates;

typedef struct zd_watch {
    const zd_events *events;    /* NULL: none */
    zd_output *output;
    zd_reader reader;       /* evaluates event functions without callbacks */
    double *before, *now;   /* (events,) values at the start and the end of the step */
    zd_zeros *zeros;        /* (events,) values within the step */
    zd_occurrence *occurrence;  /* (events * ZD_MAX_POINTS,) in the step, by event and time */
    int occurrences;        /* their number */
    int last;               /* index of the one that ends the run */
    zd_end_rates at_start, at_end;  /* rates at the ends of the step */
    zd_gaps gaps[2];        /* gaps of contacts there; NULL arrays: no constraint switches */
    int end_gaps;           /* index of those at the end of the step */
    zd_state end;           /* end of the step, corrected */
    zd_state early, late, mixed;    /* states before and after an event; interpolated */
    int *found;             /* (events,) number of occurrences */
    int failed;             /* 1 + index of an event that could not be evaluated; 0: none */
    int ended;              /* 1 + index of the event that ended the run; 0: none */
    int disarmed;           /* 1 + index of the event from which the next step begins; 0: none */
    int *acts;              /* (events,) true if it acts at the present instant */
    double *acted;          /* (events, 2), s: the last two times at which it did */
    int next_action;        /* index of the action that is due next at this instant */
    int calls;              /* 1 + index of the event at which the caller acts now; 0: none */
} zd_watch;

/* Value of an event function at the point, whose accelerations are computed if it reads them; those of all events. */
int zd_watch_evaluate(zd_watch *self, int event, double *value);
int zd_watch_evaluate_all(zd_watch *self, double *values);
/* The same at a given state, whose accelerations are those of the point. */
int zd_watch_evaluate_at(zd_watch *self, int event, const zd_state *state, double *value);
int zd_watch_reads_accelerations(const zd_watch *self, int event);
/* x (n,) changed by the rounding of states, up and down in a pattern of the seed. */
void zd_perturb(int n, const double *x, unsigned seed, double *perturbed);
/* Change of an event function when the state at the point changes by its rounding. */
int zd_watch_rounding(zd_watch *self, int event, double value, double *rounding);

/* True at an event that ends the run, not one that only acts. */
static inline int zd_watch_ends(const zd_watch *self)
{
    return self->ended && self->found[self->ended - 1] == self->events->terminal[self->ended - 1];
}

/* Samples of event functions within a step. */

/* y (n,) <- the cubic Hermite polynomial of a step of size h, at a fraction x of it */
void zd_interpolate_cubic(int n, double x, double h, const double *y0, const double *rate0, const double *y1, const double *rate1,
                          double *y);
/* Sets the value of the disarmed event function, which is zero to rounding, to its change at the start of the next step: its zero there is
 * not an event, and its return to zero is one. */
int zd_watch_arm(zd_watch *self);
/* Evaluates the rates at the start of a fixed step; without them, events are sought by the ends of the step alone. */
void zd_watch_before(zd_watch *self);
/* Applies all corrections at the point. */
int zd_watch_correct(zd_stepper *stepper);
/* Moves to a time within the step or at its ends, corrected. */
int zd_watch_move(zd_watch *self, double t);
/* Leaves the end of the step for values within it. Dense output belongs to the step before the corrections at the point. */
int zd_watch_leave(zd_watch *self);
/* Finds the gaps of contacts at the ends of the step, if there are any. */
int zd_watch_find_gaps(zd_watch *self);
/* *occurs <- true if any event may occur in the step to `end`, by both ends and by values between them. */
int zd_watch_predict(zd_watch *self, int *occurs);
/* Sets the ends of the step in the points of all events, and the number of samples between them. */
void zd_watch_span(zd_watch *self);
/* Points of all events between which they pass zero at most once; the end of the step has been saved. */
int zd_watch_sample(zd_watch *self);

/* Events: instants at which a function of the motion passes through zero. */

zd_watch zd_watch_create(zd_arena *arena, const zd_events *events, zd_output *output);
int zd_watch_start(zd_watch *self);
/* Locates and reports the events of the last step; a terminal event moves the motion, and `end`, to its instant. */
int zd_watch_after(zd_watch *self, int corrected, double *end);
