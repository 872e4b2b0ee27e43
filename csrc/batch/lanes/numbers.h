/* Runs in SIMD lanes: each lane has its own time, step and order of elimination, independent of the others. */
#pragma once

#include "../../integrators/runge_kutta.h"

enum { ZD_MAX_LANES = 8 };

/* Weights of a sum over stages, without zeros. */
typedef struct zd_weights {
    int count, stage[ZD_MAX_STAGES];
    double weight[ZD_MAX_STAGES];
} zd_weights;

/* A Runge-Kutta method: its tableau without zeros. */
typedef struct zd_method {
    const zd_tableau *tableau;
    int stages, error_order;
    zd_weights a[ZD_MAX_STAGES], b, e, e3;
    zd_weights more[ZD_MAX_STAGES], d[ZD_MAX_STAGES];    /* dense output */
} zd_method;

/* Event that is one entry of y reaching a level. */
typedef struct zd_watched {
    int entry;
    double level;
} zd_watched;

/* Numbers common to all lanes, then those of each lane. */
typedef struct zd_lanes {
    const zd_closed_form *closed_form;
    zd_method method;
    int lanes, nq, nv, m, mh, size;     /* size: of the state y = p, v and, if required, the energy input */
    int has_A, has_input, max_iterations, corrects;
    int is_fixed;
    int rounds_products;                /* true if sums over stages have the bits of a single run, whose products are not fused */
    double t0, end, step, steps;        /* steps: number of fixed steps */
    double rtol, atol, longest, tiny, max_steps, save_every, decay;
    double every;                       /* number of steps between projections; the last step is projected, too */
    double astray, nearby, limit;       /* limits of safeguards/safeguards.h */
    double weight;                      /* weight of safeguards/safeguards.h for this order of the method */
    int order_of_method;
    enum { ZD_WATCHES_NOTHING, ZD_WATCHES_NUMBERS, ZD_WATCHES_STEPS } watches;  /* entries of y in fixed steps, or others */
    int events;
    /* Corrections besides the projection, of y at t in the lanes with is_corrected; NULL: none. `forced`: in any step. */
    void (*correct_rest)(void *of, const double *t, double *y, int forced);
    void *of;                           /* its argument, the zd_lane_group */
    const zd_watched *watched;          /* (events,) if events are of entries of y */
    /* Per lane: the lanes of each number are adjacent. A condition is 1 if it holds, else 0. */
    double *first;          /* first number of all */
    int64_t count, states;  /* total number per lane; number of those that are kept from one advance to the next, which come first */
    double *data;           /* (doubles,): data of the systems */
    double *inputs;         /* (2 inputs + 1,): inputs of the systems; NULL without inputs */
    double *from_zero;      /* contiguous numbers that are 0 at the start of a run */
    int64_t numbers_from_zero;
    double *is_active;      /* 1: the lane has a run; 0: it makes steps of size 0 */
    double *t, *number;     /* time reached; number of steps made */
    double *h, *after_rejection;    /* next adaptive step; 1: the one before was rejected */
    double *next_t, *next_number;   /* time and step number at which advance() returns for this lane */
    double *y, *y0;         /* (size,): state at the end of the last step, and at its start */
    double *t_before;       /* time at its start */
    double *pdot, *vdot;    /* (nq,), (nv,): rates at y */
    double *power;          /* W: power at y */
    double *pivots;         /* (nv,): pivots at y, of its order */
    double *order;          /* index of its order of elimination; NAN: to be chosen */
    double *speed;          /* |pdot|^2 at y, characteristic scales */
    double *streak;         /* number of successive steps beyond the stability limit */
    double *inverse_unit_p, *inverse_unit;  /* (nq,), (nv,): 1 / characteristic scales of p, of v */
    double *allowed, *inverse_size;         /* (mh,): tolerance, and 1 / size of Phi */
    double *scale;          /* (orders, nv): scales of the pivots */
    double *iterations, *rejected;          /* counts of iterations and of rejected steps */
    double *peak_iterations;                /* largest number of iterations of a step since the last sample */
    double *leaves;         /* 1: the run cannot be made in lanes and is repeated individually */
    double *is_long;        /* 1: the last step was so long that the row space of C may have reversed */
    double *is_corrected;   /* 1: correct_rest() applies to the lane */
    double *next_check, *check_soon;      /* step after which full checks are due; 1: they are due sooner */
    double *check_pause, *last_checked;     /* number of steps between full checks; step of the last one */
    /* (nv,), fixed steps: zd_resolution of each velocity, and the unresolved ones recorded. */
    double *error, *path, *place, *lowest, *highest;
    double *unresolved, *unresolved_time, *part_error, *part;
    double *at_limit, *below_limit, *stiff;     /* number of steps at the stability limit, and below; counted as stiff */
    double *fastest;        /* largest speed at a full check */
    double *has_event;      /* 1: an event may have occurred in the last accepted step */
    double *t_sample, *is_wanted;      /* a time within the last step; 1: the state there is required */
    double *y_sample, *lambda_sample;     /* (size,), (m,): state and multipliers there */
    /* Work space of a step. */
    double *k;              /* (stages with those of the dense output, size): rates */
    double *stage, *y1;     /* (size,) */
    double *tolerated;      /* (size,): error tolerance of adaptive steps */
    double *pdot1, *vdot1, *power1, *pivots1;
    double *Phi, *dp, *dv;  /* (mh,), (nq,), (nv,) */
    double *other;          /* (nq + nv + m + 1 + nv,): results of another order of elimination */
    double *polynomial;     /* (coefficients, size): dense output of the last step, if required */
    int has_polynomial;
} zd_lanes;

/* True if the method has dense output for adaptive steps. */
static inline int zd_lanes_have_dense_output(const zd_lanes *self) { return !self->is_fixed && self->method.tableau->coefficients; }

/* Functions of one vector unit. */
typedef struct zd_lane_functions {
    int lanes;              /* 0: the compiler does not support the unit */
    /* Chooses the order of elimination of lanes in which it is NAN, and evaluates the accelerations there. */
    void (*choose)(zd_lanes *self);
    /* Evaluates the accelerations anew, after a change of data, with the orders of elimination of the lanes. */
    void (*renew)(zd_lanes *self);
    /* Makes steps until a lane requires attention. */
    void (*advance)(zd_lanes *self);
    /* y_sample <- state at t_sample in lanes with is_wanted, on the constraints; with `multipliers`, lambda_sample, too. */
    void (*move_within)(zd_lanes *self, int multipliers);
    /* substep: the same by a shorter step, even if the method has dense output; cut: that step also replaces the last one. */
    void (*substep)(zd_lanes *self);
    void (*cut)(zd_lanes *self);
    /* Full checks of the last step in lanes with is_wanted, and the step of their next one. */
    void (*check)(zd_lanes *self);
} zd_lane_functions;

extern const zd_lane_functions zd_lanes_baseline, zd_lanes_avx2, zd_lanes_avx512;
