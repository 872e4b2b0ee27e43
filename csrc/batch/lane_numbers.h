/* Runs side by side in the lanes of a vector unit: each has its own time, step and order of elimination, and none sees the others. */
#ifndef ZD_LANE_NUMBERS_H
#define ZD_LANE_NUMBERS_H

#include "../integrators/runge_kutta.h"
#include "lane_pins.h"

enum { ZD_MOST_LANES = 8 };

/* A sum over stages, of those whose weights are not zero. */
typedef struct zd_weights {
    int count, stage[ZD_MOST_STAGES];
    double weight[ZD_MOST_STAGES];
} zd_weights;

/* A method: its tableau without zeros. */
typedef struct zd_method {
    const zd_tableau *tableau;
    int stages, error_order;
    zd_weights a[ZD_MOST_STAGES], b, e, e3;
    zd_weights more[ZD_MOST_STAGES], d[ZD_MOST_STAGES];    /* for values between */
} zd_method;

/* A number of y that is an event where it reaches a level. */
typedef struct zd_watched {
    int entry, direction;
    double level;
} zd_watched;

/* What is the same for all lanes, */
typedef struct zd_lanes {
    const zd_direct *direct;    /* NULL where there are pins instead */
    zd_lane_pins *pins;     /* NULL where there are direct functions */
    zd_method method;
    int lanes, nq, nv, m, mh, size;     /* size: of the state, p, v and what comes in of energy, if that is asked for */
    int has_A, has_input, max_iterations, corrects;
    int is_fixed;
    double t0, end, step, steps;        /* steps: how many, where they are of fixed size */
    double rtol, atol, longest, tiny, most_steps, save_every, decay;
    double every;                       /* one of so many steps is put back onto the constraints, and the last */
    double astray, nearby, limit;       /* as the guard has them, */
    double weight;                      /* and resolution.h, of a method of such an order */
    int order_of_method;
    enum { ZD_WATCHES_NOTHING, ZD_WATCHES_NUMBERS, ZD_WATCHES_STEPS } watches;  /* for events: of numbers of y alone, or else every step */
    int events;
    /* Corrections besides the projection, of y at t in the lanes of which is_corrected says so; NULL: none. `forced`: whatever the step. */
    void (*correct_rest)(void *of, const double *t, double *y, int forced);
    void *of;                           /* the group, for that */
    const zd_watched *watched;          /* (events,) where it watches numbers */
    /* and of each: so many numbers, each for all lanes beside each other. A condition is 1 where it holds, else 0. */
    double *first;          /* of all of them */
    int64_t count;          /* how many there are in all */
    double *data;           /* (doubles,) of the systems */
    double *from_zero;      /* what is 0 where a run begins: so many numbers follow each other */
    int64_t numbers_from_zero;
    double *is_active;      /* whether there is a run in the lane; else it makes steps of size 0 */
    double *t, *number;     /* where it has got to; how many steps it has made */
    double *h, *after_rejection;    /* the next step, where steps are chosen; whether the one before was too long */
    double *next_t, *next_number;   /* when somebody has to look at it */
    double *y, *y0;         /* (size,): at the end of the last step, and at its beginning */
    double *t_before;       /* where that was */
    double *pdot, *vdot;    /* (nq,), (nv,): at y */
    double *power;          /* W: at y */
    double *pivots;         /* (nv,): at y, of its order */
    double *order;          /* its number */
    double *speed;          /* |pdot|^2 at y, in natural units */
    double *streak;         /* steps in succession that were longer than the method is stable for */
    double *inverse_unit_p, *inverse_unit;  /* (nq,), (nv,) */
    double *allowed, *inverse_size;         /* (mh,): of Phi */
    double *scale;          /* (orders, nv): of the pivots */
    double *iterations, *rejected;          /* counts */
    double *most_iterations;                /* of a step, since somebody has set it to 0 */
    double *leaves;         /* whether the run has to be made by itself */
    double *is_long;        /* whether the last step was so long that rows of C may have turned in it */
    double *is_corrected;
    double *next_check, *check_soon;      /* the step after which somebody checks closely; whether that has to be sooner than it was */
    double *check_pause, *last_checked;     /* one of so many steps is looked at; the last that was */
    /* (nv,), where steps are of fixed size: of each part of the motion, what zd_resolution has;
     * and what has been seen of those not resolved. */
    double *error, *path, *place, *lowest, *highest;
    double *unresolved, *unresolved_time, *part_error, *part;
    double *at_limit, *below_limit, *stiff;     /* steps that are as long as stability allows, and not; those that count */
    double *fastest;        /* the largest speed where somebody did */
    double *has_event;      /* whether an event may have happened in the last step, which was accepted */
    double *t_row, *is_wanted;      /* a time within the last step, and whether it is to be looked at */
    double *y_row, *lambda_row;     /* (size,), (m,): what is found there */
    /* of the step being made */
    double *k;              /* (stages with those for values between, size): rates */
    double *stage, *y1;     /* (size,) */
    double *tolerated;      /* (size,): an error as large as this, where steps are chosen */
    double *pdot1, *vdot1, *power1, *pivots1;
    double *Phi, *dp, *dv;  /* (mh,), (nq,), (nv,) */
    double *other;          /* (nq + nv + m + 1 + nv,): what another order makes of it */
    double *polynomial;     /* (coefficients, size): through the last step, once it is asked for */
    int has_polynomial;
} zd_lanes;

/* Whether values within a step come from a polynomial. */
static inline int zd_lanes_may_spread(const zd_lanes *self) { return !self->is_fixed && self->method.tableau->coefficients; }

/* What one vector unit does. */
typedef struct zd_lane_functions {
    enum zd_unit unit;
    int lanes;
    /* Chooses the order of elimination of the lanes in which that is not known, NaN, and has the accelerations there. */
    void (*choose)(zd_lanes *self);
    /* Steps until a lane has to be looked at. */
    void (*advance)(zd_lanes *self);
    /* y_row at t_row, where it is wanted; its multipliers, too, where `multipliers`. */
    void (*move_between)(zd_lanes *self, int multipliers);
    /* The same by a shorter step whatever polynomial the method has; and where that step takes the place of the one made. */
    void (*substep)(zd_lanes *self);
    void (*cut)(zd_lanes *self);
    /* What lanes that are wanted see in the step they have just made, and when they look again. */
    void (*check)(zd_lanes *self);
} zd_lane_functions;

extern const zd_lane_functions zd_lanes_baseline, zd_lanes_avx2, zd_lanes_avx512;   /* without functions where the compiler cannot */

#endif
