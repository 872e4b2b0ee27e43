/* Event functions of a run: their values, and what their location needs. */
#ifndef ZD_WATCH_H
#define ZD_WATCH_H

#include "../linalg/bracket.h"
#include "within_step.h"
#include "reading.h"
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
    zd_state end;           /* end of the step, corrected */
    zd_state early, late, mixed;    /* states before and after an event; interpolated */
    int *found;             /* (events,) number of occurrences */
    int failed;             /* 1 + index of an event that could not be evaluated; 0: none */
    int ended;              /* 1 + index of the event that ended the run; 0: none */
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

#endif
