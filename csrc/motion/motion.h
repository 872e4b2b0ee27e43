/* The motion of a system: its equations in one formulation, with the enabled corrections. Integrators and corrections use nothing else, and
 * the evaluation paths what they need besides: paths/path.h.
 */
#pragma once

#include "../formulations/formulation.h"
#include "../linalg/small.h"
#include "../step_limits.h"
#include "correction.h"
#include "derivatives.h"

/* States of a motion that can be restored. */

typedef struct zd_state {
    double t;
    double *p, *v;          /* (nq,), (nv,) */
    double *extra;          /* entries of the integrated state that follow the formulation's */
} zd_state;

/* Acceleration at a zd_state, restored with it so that a step from there needs no evaluation. */
typedef struct zd_cached_accelerations {
    double *vdot;           /* (nv + m,): with lambda, as at a point */
    double *pivots;         /* (nv,): pivots of the closed-form path, if the order is not negative */
    int order;              /* elimination order of these pivots, as zd_path has it */
    double smallest;        /* smallest of them, as zd_path has it */
    int are_known;          /* true if the fields above are set */
} zd_cached_accelerations;

typedef struct zd_last {    /* the current step: its size, and the state at its start */
    double t, h;
    double *y, *p, *v;      /* (size,), (nq,), (nv,) */
    void *chosen;           /* copy of the formulation's choice of variables at the start; NULL: no copy is made */
} zd_last;

/* An enabled correction. */
typedef struct zd_active {
    const zd_correction *row;
    void *self;
    int every;              /* steps between two applications */
    int extra;              /* offset of its own entries in the state, counted from the end of the formulation's part */
    int extra_size;
} zd_active;

/* Rate of the integrated state, the interface that integrators use. */
typedef struct zd_rate {
    int (*evaluate)(void *context, double t, const double *y, double *ydot);
    void *context;
    int size;               /* entries of the state */
    int pairs;              /* n if the state begins with p (n,) and v (n,), pdot = v, and no rate depends on other entries; else 0 */
    /* The closed-form functions, if they alone give the rate of a state (p, v); otherwise NULL. */
    const zd_elimination *closed_form;
    const zd_system *system;
    const double *inputs;   /* (2 inputs + 1,): of the system; NULL without inputs */
    const double *vdot;     /* (nv,): the point's acceleration, for a step that starts there; NULL: it is evaluated with the rate */
    const int *known;       /* mask of the quantities known at the point */
    /* J (size, size) <- derivatives with respect to the state; increment (size,): changes of its entries for differences. Nonzero: not
     * available at this state. NULL: never available. */
    int (*jacobian)(void *context, double t, const double *y, const double *increment, double *J);
    /* For states in independent velocities: (p, v) (nq + nv,) of a state, and the formulation's part of the state of (p, v). NULL: the state
     * begins with p and v. */
    int (*expand)(void *context, double t, const double *y, double *whole);
    int (*reduce)(void *context, double t, const double *whole, double *y);
} zd_rate;

/* Rates at the start of a step, and at a stage within it. */
static inline int zd_rate_of_beginning(const zd_rate *rate, double t, const double *restrict y, double *restrict ydot)
{
    if (!rate->vdot || !(*rate->known & ZD_ACCELERATED)) return rate->evaluate(rate->context, t, y, ydot);
    const int n = rate->system->nv;
    for (int i = 0; i < n; i++) ydot[i] = y[n + i], ydot[n + i] = rate->vdot[i];
    return ZD_DONE;
}

static inline int zd_rate_of_stage(const zd_rate *rate, double t, const double *restrict y, double *restrict ydot)
{
    if (!rate->closed_form) return rate->evaluate(rate->context, t, y, ydot);
    const zd_system *system = rate->system;
    const int nq = system->nq;
    if (!(system->provides & ZD_A))
        for (int i = 0; i < nq; i++) ydot[i] = y[nq + i];
    int status = rate->closed_form->accelerate(rate->closed_form, system->data, rate->inputs, &t, y, y + nq, NULL, ydot, ydot + nq, NULL,
                                               NULL, NULL);
    return status ? ZD_CALLBACK : ZD_DONE;
}

/* Counters since the last sample, and maxima over all samples. */
typedef struct zd_tally {
    int iterations;         /* largest number of position iterations of a step */
    int energy_skipped;     /* skipped energy corrections */
    int start_saved;        /* true if the sample of the start has been saved, is not requested, or waits for room */
    double energy_error;    /* J: largest |Psi_E| of all samples; NaN if one of them is NaN */
} zd_tally;

/* (28): reference of the energy balance. */
typedef struct zd_balance {
    double initial;         /* E0, J */
    const double *input;    /* J: energy input, the last entry of the state; NULL if the system has none */
    zd_energy_jump jump;    /* the last change of E0 */
} zd_balance;

/* The equations of motion as an evaluation path has them. */
typedef struct zd_equations {
    int (*accelerate)(zd_motion *motion);   /* vdot and lambda at the point */
    int (*rate)(void *motion, double t, const double *y, double *ydot);     /* ydot of the integrated state */
    int (*unpack)(zd_motion *motion, double t, double *y);      /* moves the point to the formulation's part of the state y */
    int (*pack)(zd_motion *motion, double *y);     /* y <- that part at the point */
    /* The same at the end of a step, with the point's dependent entries; `within`: without a new choice of variables, for values within it */
    int (*finish)(zd_motion *motion, double *y, int within);
    int (*expand)(void *motion, double t, const double *y, double *whole);      /* as in zd_rate, for states in independent velocities */
    int (*reduce)(void *motion, double t, const double *whole, double *y);
    int terms;              /* mask of zd_motion.acceleration_needs: the terms that accelerate() evaluates */
    int updates;            /* true if a formulation with update() calls it at corrected positions, and may choose its variables anew */
} zd_equations;

extern const zd_equations zd_equations_by_matrices;     /* motion.c */

/* Range of the bit patterns of doubles of one sign, which as integers are ordered as the magnitudes are. */
typedef struct zd_range {
    uint64_t least, width;
} zd_range;

/* Evaluation path of the current step. On the closed-form path accelerations and projections come from the system's closed-form functions; on
 * the matrix path, from the formulation's leading matrix. The latter always exists and is taken in any doubt: paths/path.c. */
typedef struct zd_path {
    const zd_closed_form *closed_form;
    const zd_equations *equations;  /* in closed form */
    const zd_elimination *first;    /* (orders,): elimination orders for this formulation */
    int orders;
    int embeds;             /* true if the state is in independent velocities, for which all fields from `state` on are: embed.c */
    int order;              /* index of the elimination order of the current step; negative: it takes the matrix path */
    int was_taken;          /* true if steps were made in closed form since the last checks of the matrix path */
    int continues;          /* true if the quick check has passed, so that the next step may reuse this elimination order */
    double *scale;          /* (orders, nv): factor that makes each pivot relative, from zd_closed_form_find_scales(); 0 until then */
    zd_range *range;        /* (nv,): a pivot in its range is large, of the same sign, and within a factor of four of its last value */
    int ranges;             /* number of ranges: pivots of the order, at least one */
    double smallest;        /* smallest relative pivot at the end of the last step; 0: not known */
    double *pivots, *before;    /* (nv,): at the point, with its acceleration; at the start of the step. Unused ones are 1 */
    double *pdot;           /* (nq,): at the point, of a system with A */
    double *pdot_of_stage;  /* (nq,): at a stage; that of the point stays, as a rejected step begins with it again */
    double *dp, *dv;        /* (nq,), (nv,): corrections of one iteration */
    double *allowed;        /* (mh,): largest |Phi| that meets the projection's tolerance */
    int finishes;           /* true if one function projects and computes the acceleration at the end of a step */
    int is_plain;           /* true if a step needs nothing else, with a state (p, v), pdot = v, that equals the point's at its ends */
    int64_t energy_skipped; /* counters at the start of the step, restored if it is repeated on the matrix path */
    int64_t energy_corrections;
    double energy_corrected;
    int skipped_since_row;
    double power;           /* W: at the point, of a system with energy input */
    zd_entries state;       /* entries of p and v in the state */
    double *p, *v, *vdot, *Phi;     /* (nq,), (nv,), (nv,), (mh,): of the state being evaluated, which may differ from the point */
    double *unbounded;      /* (mh,): infinite bounds of |Phi|, for a given p */
    double *D;              /* (m, nv - m): at the point, derivatives of dependent by independent velocities */
} zd_path;

/* Memory for the Jacobian of the rate. */
typedef struct zd_chain {
    zd_residual_state residuals;    /* and the four fields that follow: for systems without a Jacobian of their own */
    double *lambda;         /* (m,): multipliers of the independent constraints, zero for the redundant ones */
    double *changes;        /* (nv + m + nq + 1,): derivatives of residuals, A v and power along one direction */
    double *right;          /* (nv + m,): right side for the derivatives of vdot and lambda */
    double *lambda_along;   /* (m,): derivatives of lambda along one direction, of a system with energy input */
    double *unit;           /* (nq + nv,): direction along one entry of a state (p, v) */
    double *scratch;        /* work array of the system's functions */
    double *J;              /* (nq + nv + 1, nq + nv): the system's */
    double *Psi_p;          /* (m, nq): derivatives of (5) with respect to p, the system's; NULL: not provided */
    double *Psi_along;      /* (size, m): the same along the first rows of T; this and T are for states in independent velocities */
    double *T;              /* (size, nq + nv): derivatives of p and v with respect to each entry of the formulation's part of the state */
    double *rates;          /* (nq + nv + 1,): derivatives of pdot, vdot and power with respect to one entry */
    double *picked;         /* (size,): the independent entries of `rates` */
} zd_chain;

/* Memory for reactions and accelerations r that user functions u of forces read: reactions.c */
typedef struct zd_reactions {
    const zd_reading *reading;      /* n, k, and pairs of them; NULL: none are read */
    double *r, *r0, *r1;    /* (n,): r; R at the values u0 of those that read none, and 0; the solution */
    double *u, *u0, *u1;    /* (k,): u; u0; another u */
    double *u_r;            /* (reads,): derivative of each u with respect to each r that it reads */
    double *G;              /* (k, n): dR/du */
    double *R, *change, *scale; /* (n,): measured; change of r, in units of its scale */
    double *matrix, *inverse;   /* (n, n): factors of I - G du/dr, in the scales of r; its inverse */
    int *order;             /* (n,): of the factors */
    double force;           /* N, N m: largest force there */
    double determinant, condition;      /* numbers of the last matrix, for messages */
    int strongest;          /* user function with the largest entry in it */
    double *measured, *scratch; /* a measure; scratch memory of the measures */
} zd_reactions;

struct zd_motion {
    zd_system system;
    zd_statistics statistics;
    zd_tally *tally;        /* counters of the run */
    zd_point *point;        /* quantities at the current (t, p, v) */
    const zd_formulation *formulation;
    void *solver;           /* memory of the formulation */
    const zd_equations *equations;      /* chosen with the evaluation path */
    zd_span memory_of_chosen;   /* memory span of the formulation chosen in the settings */
    int drifts_from;        /* ZD_PHI, ZD_C: constraints that drift in this formulation; all of them outside a run */
    int corrects;           /* ZD_PHI, ZD_C: constraints that are corrected after a step */
    zd_constraint_target target;            /* accuracy of the constraints after corrections */
    int corrections_need;   /* terms that the enabled corrections need */
    int matrices;           /* ZD_M, ZD_C: terms to evaluate before the formulation factors */
    int acceleration_needs; /* terms that (8), (9), (13) need with the enabled corrections */
    zd_active active[ZD_CORRECTIONS_MAX];
    int corrections;        /* number of enabled corrections */
    int others_after_step;  /* number of those that are applied after a step, other than the projection */
    int is_stabilized;      /* true if one of them changes the right side of (6) */
    zd_rate rate;
    const double *state;    /* integrated state of the point: at the end of the step, or at a stage */
    int formulation_size;   /* entries of the formulation's part of the state; those of corrections and the energy input (28) follow */
    int corrections_size;   /* entries of the corrections' part of the state */
    zd_balance balance;
    zd_path path;
    zd_chain chain;
    zd_reactions reactions;
    zd_store store;         /* memory allocated on demand, after rare events */
    int in_run;             /* true if steps begin at states that satisfy the constraints */
};

/* create.c: initializes the motion in place. `independent` has the system's sizes with the number of independent constraints. */
void zd_motion_create(zd_motion *motion, zd_arena *arena, const zd_system *system, const zd_system *independent,
                    const zd_formulation *formulation, const void *given, enum zd_on_singular on_singular);
/* Adds a correction with its parameters. */
void zd_motion_enable(zd_motion *motion, zd_arena *arena, const zd_correction *correction, const void *given);
/* Attaches the state (rate.size,), after all corrections have been enabled. */
void zd_motion_attach(zd_motion *motion, double *state);
/* Sets what of the rate depends on the formulation, on all corrections and on the equations, after these are known. */
void zd_motion_describe_rate(zd_motion *motion);
/* whole.c: the rate's expand() and reduce() by the formulation */
int zd_motion_expand(void *motion, double t, const double *y, double *whole);
int zd_motion_reduce(void *motion, double t, const double *whole, double *y);

/* Solutions with the leading matrix */
int zd_motion_factor_anew(zd_motion *motion);
/* Factors the leading matrix at the point. */
static inline int zd_motion_factor(zd_motion *motion)
{
    return motion->point->known & ZD_FACTORED ? ZD_DONE : zd_motion_factor_anew(motion);
}
/* The same, if the next solve has this right side and result, unchanged. */
static inline int zd_motion_factor_for(zd_motion *motion, const double *force, const double *rhs, double *x)
{
    motion->point->awaited = (zd_right_side){force, rhs, x};
    int status = zd_motion_factor(motion);
    motion->point->awaited = (zd_right_side){NULL, NULL, NULL};
    return status;
}
/* Selects the independent constraints at the point, by factoring where the formulation does so. */
int zd_motion_find_independent(zd_motion *motion);
/* The formulation's solve, with right sides and multipliers of all constraints, redundant ones included. */
void zd_solve_with(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force, const double *rhs,
                   double *x, double *lambda);
/* Solves with the factors at the point. */
void zd_motion_solve(zd_motion *motion, const double *force, const double *rhs, double *x, double *lambda);

/* vdot and lambda at the point. */
static inline int zd_motion_accelerate(zd_motion *motion)
{
    return motion->point->known & ZD_ACCELERATED ? ZD_DONE : motion->equations->accelerate(motion);
}
/* Terms that zd_motion_accelerate() will evaluate at the point, for an evaluation together with others. */
static inline int zd_motion_acceleration_terms(const zd_motion *motion)
{
    return motion->point->known & ZD_ACCELERATED ? 0 : motion->acceleration_needs & motion->equations->terms;
}
static inline int zd_motion_updates(const zd_motion *motion) { return motion->formulation->update && motion->equations->updates; }
void zd_motion_stabilize(zd_motion *motion);    /* point.rhs <- point.rhs with the terms that corrections add to the right side of (6) */
/* zd_equations.unpack, pack and finish by the formulation */
int zd_motion_unpack(zd_motion *motion, double t, double *y);
int zd_motion_pack(zd_motion *motion, double *y);
int zd_motion_finish(zd_motion *motion, double *y, int within);
int zd_motion_rate(void *motion, double t, const double *y, double *ydot);     /* after a move of the point there */
void zd_motion_extra_rates(const zd_motion *motion, double *ydot);      /* rates of the corrections' part of the state */

/* jacobian.c: memory for the derivatives of the rate, which are then available. */
void zd_motion_create_jacobian(zd_motion *motion, zd_arena *arena);

static inline void zd_count_position_iterations(zd_motion *motion, int iterations)
{
    zd_statistics *statistics = &motion->statistics;
    statistics->position_iterations += iterations;
    if (iterations > statistics->max_position_iterations) statistics->max_position_iterations = iterations;
    if (iterations > motion->tally->iterations) motion->tally->iterations = iterations;
}

/* The corrections (25a), (26a), (27a), with unit quaternions, and (25b), (26b), (27b): to <- p - dp, to <- v - dv. `to` may be p or v. */
static inline void zd_correct_position(const zd_system *system, const double *p, const double *dp, double *to)
{
    ZD_SIZED(zd_subtract_pairs, system->nq, p, dp, to);
    zd_quaternions_normalise(system, to);
}
static inline void zd_correct_velocity(const zd_system *system, const double *v, const double *dv, double *to)
{
    ZD_SIZED(zd_subtract_pairs, system->nv, v, dv, to);
}

/* The projection (25)-(27), and the corrections that follow it, if they are due in this step; `forced`: in any */
int zd_motion_project(zd_motion *motion, int64_t step, int forced);
int zd_motion_correct_rest(zd_motion *motion, int64_t step, int forced);
int zd_motion_correct(zd_motion *motion);       /* applies all */
/* True if all corrections are due in this step. */
int zd_motion_is_corrected(const zd_motion *motion, int64_t step);
/* True if `step` is a multiple of `every`; for 1 without a division, the slowest of instructions. */
static inline int zd_is_one_of(int64_t every, int64_t step) { return every == 1 || step % every == 0; }

/* Energy balance */
int zd_has_energy(const zd_system *system);
int zd_has_input(const zd_system *system);          /* true if power is put in besides V; its integral is then part of the state */
static inline double zd_motion_input(const zd_motion *motion) { return motion->balance.input ? *motion->balance.input : 0; }   /* J */
int zd_motion_energy_violation(zd_motion *motion, double *violation, double *kinetic);     /* (28) */
int zd_motion_balance(zd_motion *motion, double *violation);      /* its violation alone, 0 without a potential */
/* Adds the change of the energy by a jump of the state at time t, J, to E0. */
void zd_motion_add_jump(zd_motion *motion, double t, double energy);
int zd_motion_start_energy(zd_motion *motion);      /* E0 of (28), from the point */

/* User functions of forces that read reactions and accelerations, which are solved together with the accelerations. */

/* Solves for what user functions of the system read, if any do so, at each evaluation of the accelerations. */
void zd_reactions_create(zd_motion *motion, zd_arena *arena);
/* u (functions,) <- values of the user functions at a state where vdot, lambda and efforts, NULL for none, are given. Returns ZD_DONE,
 * ZD_SEVERAL_MOTIONS, ZD_NO_MEMORY, or the status of a user function that failed. */
int zd_reactions_at(const zd_system *system, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                       const zd_efforts *efforts, double *u);
