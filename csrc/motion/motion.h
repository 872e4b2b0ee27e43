/* The motion of a system: its equations in one formulation, with the corrections that are on. It is all that integrators and
 * corrections see.
 */
#ifndef ZD_MOTION_H
#define ZD_MOTION_H

#include "../formulations/formulation.h"
#include "correction.h"

/* A correction that is on. */
typedef struct zd_active {
    const zd_correction *row;
    void *self;
    int every;              /* how many steps it is made */
    int extra;              /* where, behind the formulation's part of the state, that stands which it integrates along */
    int extra_size;
} zd_active;

/* The rate of the integrated state, of which integrators know nothing else. */
typedef struct zd_rate {
    int (*evaluate)(void *context, double t, const double *y, double *ydot);
    void *context;
    int size;               /* of the state */
    int pairs;              /* n where it begins with p (n,) and v (n,), pdot = v, and nothing depends on what follows these; else 0 */
    /* Where the state is (p, v) and nothing but a direct function is behind it, that function; else NULL. */
    const zd_elimination *direct;
    const zd_system *system;
    const double *vdot;     /* (nv,): where it is known already for the state at which a step begins; else NULL */
    /* J (size, size) <- its derivatives by the state; not 0: they are not known here. NULL: they never are. */
    int (*jacobian)(void *context, double t, const double *y, double *J);
} zd_rate;

/* The rate of the state at which a step begins, and of a stage between its ends */
static inline int zd_rate_of_beginning(const zd_rate *rate, double t, const double *restrict y, double *restrict ydot)
{
    if (!rate->vdot) return rate->evaluate(rate->context, t, y, ydot);
    const int n = rate->system->nv;
    for (int i = 0; i < n; i++) ydot[i] = y[n + i], ydot[n + i] = rate->vdot[i];
    return ZD_DONE;
}

static inline int zd_rate_of_stage(const zd_rate *rate, double t, const double *restrict y, double *restrict ydot)
{
    if (!rate->direct) return rate->evaluate(rate->context, t, y, ydot);
    const zd_system *system = rate->system;
    const int nq = system->nq;
    if (!(system->provides & ZD_A))
        for (int i = 0; i < nq; i++) ydot[i] = y[nq + i];
    int status = rate->direct->accelerate(system->data, &t, y, y + nq, NULL, ydot, ydot + nq, NULL, NULL, NULL);
    return status ? ZD_CALLBACK : ZD_DONE;
}

/* What has happened since the last saved row, and what is known of all of them. */
typedef struct zd_tally {
    int iterations;         /* most position iterations of a step */
    int energy_skipped;     /* energy corrections left out */
    int start_saved;        /* whether the row of the start has been saved, if it is wanted, or waits for room */
    double energy_error;    /* J: the largest |Psi_E| of the saved rows; not a number if one of them is not */
} zd_tally;

/* (28): what the energy is compared with. */
typedef struct zd_balance {
    double initial;         /* E0, J */
    const double *input;    /* J, integrated along as the last number of the state; NULL where none comes in */
} zd_balance;

/* Of a number's bits, which without signs lie as the numbers do */
typedef struct zd_range {
    uint64_t least, width;
} zd_range;

/* The direct road: a step whose accelerations and corrections come from the system's direct functions. The general road, by the formulation's
 * leading matrix, is all that there is where `direct` is NULL, and what is taken in any doubt: see direct.c. */
typedef struct zd_path {
    const zd_direct *direct;
    const zd_elimination *order;    /* that this step is made with; NULL: it takes the general road */
    int was_taken;          /* whether steps have been made so since the safeguards of the general road last looked */
    int continues;          /* whether a glance at the end of a step has found that the next may be made likewise */
    double *scale;          /* (orders, nv): of each pivot, to be compared with its rows' sizes; none is 0 once they are known */
    zd_range *range;        /* (nv,): pivots within are large, of the same sign, and within a factor of four of what they were */
    int ranges;             /* how many of these: pivots of the order, at least one */
    double smallest;        /* of the pivots where a step has ended, in parts of what they are measured by; 0: not known */
    double *pivots, *before;    /* (nv,): at the point, once its acceleration is known; where the step began. Those that no order has are 1 */
    double *pdot;           /* (nq,): at the point, of a system with A */
    double *pdot_of_stage;  /* (nq,): at a stage, which leaves that of the point as it is: a step that is rejected begins with it again */
    double *dp;             /* (nq,): of an iteration onto the constraints */
    double *allowed;        /* (mh,): of Phi, so that the projection's tolerance is kept */
    int lands;              /* whether what ends a step is one function: its acceleration is then that of the end */
    int64_t energy_skipped; /* where the step began, as the statistics have them: a step that leaves the road is made again */
    int64_t energy_corrections;
    double energy_corrected;
    int skipped_since_row;
    double power;           /* W: at the point, of a system with energy input */
    const zd_elimination *first;    /* of the orders that serve the formulation, and how many there are */
    int orders;
    int embeds;             /* whether the state is in independent velocities; all that follows is for that: embed.c */
    zd_entries state;       /* what it has of p and v */
    double *p, *v, *vdot, *Phi;     /* (nq,), (nv,), (nv,), (mh,): of the state that is looked at; the point may be another */
    double *unbounded;      /* (mh,): what is allowed of Phi where p is what it is */
    double *D;              /* (m, nv - m): at the point, of the velocities that are solved for */
} zd_path;

/* Memory for the Jacobian of the rate, by the chain rule from the derivatives that the system brings */
typedef struct zd_chain {
    double *scratch;        /* of the system's functions */
    double *J;              /* (nq + nv + 1, nq + nv): the system's, and all that follows, for states in independent velocities */
    double *Psi_p;          /* (m, nq): derivatives of (5) by p */
    double *T;              /* (size, nq + nv): of p and v by each entry of the formulation's part of the state */
    double *rates;          /* (nq + nv + 1,): of p, v and the energy input, by one of them, */
    double *picked;         /* (size,): and those that the state has */
} zd_chain;

struct zd_motion {
    zd_system system;
    zd_statistics statistics;
    zd_tally *tally;        /* of the run */
    zd_point *point;        /* where the motion is */
    const zd_formulation *formulation;
    void *solver;           /* the formulation's memory, */
    zd_span memory_of_chosen;   /* and all that was laid out for that of the settings */
    int drifts_from;        /* what the projection has to correct: the formulation's, or outside a run, everything */
    int corrects;           /* ZD_PHI, ZD_C: which of the two corrections after a step are made for */
    zd_constraint_target target;            /* what they promise of both */
    int corrections_need;   /* terms behind the corrections that are on */
    int matrices;           /* ZD_M, ZD_C: what the formulation's factorization does not have evaluated itself */
    int acceleration_needs; /* terms behind (8), (9), (13) with the corrections that are on */
    zd_active active[ZD_CORRECTIONS_MAX];
    int corrections;        /* how many are on */
    int is_stabilized;      /* whether one of them changes the right side of (6) */
    zd_rate rate;
    const double *state;    /* the point's: that of the step's end, or a stage of the integrator */
    int formulation_size;   /* of the state's first part: the formulation's. Corrections' and the energy input (28) follow */
    int corrections_size;   /* of what corrections integrate along */
    zd_balance balance;
    zd_path path;
    zd_chain chain;
    zd_store store;         /* what is taken once something rare has happened */
    int in_run;             /* whether steps begin where the constraints are known to hold */
};

/* take.c: lays out the motion in place. `independent` has the system's sizes with as many constraints as count. */
void zd_motion_take(zd_motion *motion, zd_arena *arena, const zd_system *system, const zd_system *independent,
                    const zd_formulation *formulation, const void *given);
/* Adds a correction with its parameters. */
void zd_motion_enable(zd_motion *motion, zd_arena *arena, const zd_correction *correction, const void *given);
/* Gives the motion the state (rate.size,), whose sizes are known once all corrections are. */
void zd_motion_attach(zd_motion *motion, double *state);
/* Once the formulation and all corrections are there: see zd_rate. */
void zd_motion_count_pairs(zd_motion *motion);

/* solve.c */
int zd_motion_factor_anew(zd_motion *motion);
/* The leading matrix at the point. */
static inline int zd_motion_factor(zd_motion *motion)
{
    return motion->point->known & ZD_FACTORED ? ZD_DONE : zd_motion_factor_anew(motion);
}
/* The same, where this is solved for next, with nothing in it changed. */
static inline int zd_motion_factor_for(zd_motion *motion, const double *force, const double *rhs, double *x)
{
    motion->point->awaited = (zd_right_side){force, rhs, x};
    int status = zd_motion_factor(motion);
    motion->point->awaited.x = NULL;
    return status;
}
/* Which rows count at the point, also by factoring, where that tells. */
int zd_motion_find_rows(zd_motion *motion);
/* The formulation's solve, with right sides and multipliers of all rows, whichever of them count at the point. */
void zd_solve_with(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force, const double *rhs,
                   double *x, double *lambda);
/* With what was factored. */
void zd_motion_solve(zd_motion *motion, const double *force, const double *rhs, double *x, double *lambda);

/* accelerate.c */
int zd_motion_accelerate_anew(zd_motion *motion);
/* vdot, lambda at the point. */
static inline int zd_motion_accelerate(zd_motion *motion)
{
    return motion->point->known & ZD_ACCELERATED ? ZD_DONE : zd_motion_accelerate_anew(motion);
}
int zd_motion_rate(void *motion, double t, const double *y, double *ydot);
int zd_motion_direct_rate(void *motion, double t, const double *y, double *ydot);   /* the same along the direct road */
void zd_motion_extra_rates(const zd_motion *motion, double *ydot);      /* of what corrections integrate along */

/* jacobian.c: the derivatives of the rate where the system brings its own, with constraints as they are; of (8) where M is regular, which
 * those of all formulations follow from. */
zd_chain zd_chain_take(const zd_motion *motion, zd_arena *arena);
int zd_motion_jacobian(void *motion, double t, const double *y, double *J);

/* direct.c */
/* Those for one trajectory, and not several at once, of the last unit up to this one; NULL: the system brings none for such formulations. */
const zd_direct *zd_direct_of(const zd_system *system, const zd_formulation *formulation, enum zd_unit unit);
/* Lays out the direct road, where the system brings one for the formulation and this vector unit or one before it. */
void zd_direct_take(zd_motion *motion, zd_arena *arena, enum zd_unit unit);
/* Which road a step takes that begins at the point. */
void zd_direct_choose(zd_motion *motion);
void zd_direct_leave(zd_motion *motion);
/* What the energy correction has counted in a step goes with it: as it stands where the step begins. */
void zd_direct_remember_energy(zd_motion *motion);
void zd_direct_forget_energy(zd_motion *motion);
/* By what the pivots of all orders are measured. */
void zd_direct_measure(zd_motion *motion);
/* Whether the pivots at the end of the step, in which the motion has moved by so much, are what they were where it began: else that is
 * ZD_SINGULAR, and the step has to be made on the general road. */
int zd_direct_compare(zd_motion *motion, double moved);
static inline int zd_is_direct(const zd_motion *motion) { return motion->path.order != NULL; }

/* Whether functions failed that nothing can take the place of: a direct one that does leaves its work to the others. */
static inline int zd_callable_failed(const zd_motion *motion, int status) { return status == ZD_CALLBACK && !zd_is_direct(motion); }
/* Whether a step begins where a glance at the one before has seen that it may be made likewise. */
static inline int zd_direct_continues(zd_motion *motion)
{
    int continues = motion->path.continues && (motion->point->known & ZD_ACCELERATED);
    motion->path.continues = 0;
    if (!continues) return 0;
    double *pivots = motion->path.pivots;       /* copies would wait for them */
    motion->path.pivots = motion->path.before;
    motion->path.before = pivots;
    if (motion->corrections > 1) zd_direct_remember_energy(motion);
    return 1;
}

static inline int zd_is_embedded(const zd_motion *motion) { return motion->path.order && motion->path.embeds; }
/* embed.c: as a formulation's enter(), leave() and settle() are on the general road, from and to the state of a step that begins or ends at
 * the point. */
int zd_embed_enter(zd_motion *motion, double t, const double *y);
int zd_embed_leave(zd_motion *motion, double *y);
int zd_embed_settle(zd_motion *motion);

/* land.c: the projection of p and v at the end t of a step on the direct road, and the point's acceleration there, by one function, where
 * road.lands says so. Both are the point's own, or have to be copied there. */
int zd_direct_land(zd_motion *motion, double t, double *p, double *v);

/* The first iteration of a position correction has to reduce the violation to this share: by Kantorovich's theorem there is then one
 * solution near its start. */
#define ZD_TRUSTED_SHARE 0.25
static inline void zd_count_position_iterations(zd_motion *motion, int iterations)
{
    zd_statistics *statistics = &motion->statistics;
    statistics->position_iterations += iterations;
    if (iterations > statistics->max_position_iterations) statistics->max_position_iterations = iterations;
    if (iterations > motion->tally->iterations) motion->tally->iterations = iterations;
}

/* correct.c: those that are due in this step, in their order; `forced`: all */
int zd_motion_correct(zd_motion *motion, int64_t step, int forced);
/* The same without the one that holds the constraints, after that. */
int zd_motion_correct_rest(zd_motion *motion, int64_t step, int forced);
/* Whether all of them are due in this step. */
int zd_motion_is_corrected(const zd_motion *motion, int64_t step);
/* Whether a step is one of every so many. One of every 1 is not worth a division, the slowest of instructions. */
static inline int zd_is_one_of(int64_t every, int64_t step) { return every == 1 || step % every == 0; }

/* balance.c */
int zd_has_energy(const zd_system *system);
int zd_has_input(const zd_system *system);          /* of energy, besides V: then it is integrated along */
static inline double zd_motion_input(const zd_motion *motion) { return motion->balance.input ? *motion->balance.input : 0; }   /* J */
double zd_motion_power(const zd_motion *motion);    /* W, at the point, whose acceleration is known */
int zd_motion_energy_violation(zd_motion *motion, double *violation, double *kinetic);     /* (28) */
int zd_motion_start_energy(zd_motion *motion);      /* E0 of (28), from the point */

#endif
