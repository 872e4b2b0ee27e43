/* Acceptance of steps: detection only; the reaction is in step/step.c. */
#pragma once

#include "../linalg/small.h"
#include "../motion/motion.h"
#include "../step_limits.h"

/* Error of a step in the rotation of a unit quaternion. */

typedef struct zd_turning {
    zd_motion *motion;
    const zd_last *last;        /* the step */
    const double *vdot0, *pdot0, *pdot1;    /* (nv,), (nq,), (nq,): rates at its start; at its end */
    double *A0, *scratch;       /* stored as the point's: A at the start; scratch memory of the system for it */
    double *before, *after;     /* (nq,): A vdot at both ends */
} zd_turning;

zd_turning zd_turning_create(zd_arena *arena, zd_motion *motion, const zd_last *last, const double *vdot0, const double *pdot0,
                           const double *pdot1);
/* A at both ends of the step, for all quaternions; the point's vdot is known. */
int zd_turning_evaluate(zd_turning *self);
/* Defect of quaternion k in the step, and its angle of rotation, both in rad. */
void zd_turning_compare(const zd_turning *self, int k, double h, double *missed, double *turned);

/* Resolution of the motion by fixed steps, coordinate by coordinate. */

typedef struct zd_resolution {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *vdot0;    /* (nv,): acceleration at the start of the step */
    int by_velocity;        /* true if velocities are checked instead of coordinates, since pdot = A v with a kinematic matrix */
    int order;              /* order of the method */
    double weight;          /* ratio of the error of a step to its defect */
    double *error, *path;   /* (nv + quaternions,) in characteristic scales: decaying sums of errors, and of distances covered */
    double *place, *lowest, *highest;   /* (nv,): present value; the range in which it has moved */
    zd_turning turning;     /* defects of the quaternions */
    int64_t step;              /* the last checked step */
    int is_ample;           /* true if all errors were far below their bounds then */
} zd_resolution;

/* vdot0 and pdot0 are the rates at the start of a step, pdot1 those at its end. */
zd_resolution zd_resolution_create(zd_arena *arena, zd_motion *motion, int order, const zd_last *last, const double *vdot0,
                                 const double *pdot0, const double *pdot1);
int zd_resolution_check(zd_resolution *self, double h, int64_t step);      /* requires the acceleration at both ends of the step */
/* The same for rotations only, from the first of several equal parts of a step. */
int zd_resolution_check_turns(zd_resolution *self, double h, int64_t step, int parts);

/* Consistency of a system during a run: symmetry of M, and Jacobians against differences of Phi. */

typedef struct zd_consistency {
    zd_motion *motion;
    int compares;           /* true if C and Phi_t are hand-written and checked; otherwise no memory is allocated */
    double slowest;         /* 1/s: lower bound of the rates, one characteristic scale over the whole run */
    double of_time;         /* s: characteristic scale of time, from zd_consistency_jacobian() */
    double *direction;      /* (nv + 1,): w, s */
    double *pdot, *p;       /* (nq,): A w; displaced coordinates */
    double *scratch;        /* scratch memory of the system for these */
    double *Phi, *quotient, *central;   /* (mh,): displaced Phi; difference quotients; the central one */
    int row, column;        /* the wrong entry of C; column nv is Phi_t */
    double given, found;    /* its given value, and its value by differences */
} zd_consistency;

zd_consistency zd_consistency_create(zd_arena *arena, zd_motion *motion, const zd_settings *settings);
int zd_consistency_mass(zd_point *point);           /* checks that M, already evaluated, is symmetric; else ZD_NOT_SYMMETRIC */
/* Checks hand-written C and Phi_t against differences of Phi, in a direction that depends on the step; else ZD_NOT_JACOBIAN. */
int zd_consistency_jacobian(zd_consistency *self, int64_t step);
int zd_consistency_check(zd_consistency *self, int64_t step);   /* both checks, the second at its intervals */

/* Detection of bifurcations inside a step. */

/* Memory for comparing C along a step. */
typedef struct zd_crossing_memory {
    double *C;              /* C at the start of the step, stored as the point's C, times the squares of the characteristic scales */
    double *previous;       /* likewise, at the previous intermediate point */
    double *p, *p1, *v1;    /* (nq,), (nq,), (nv,): intermediate point; end of the step */
    double *turn;           /* (m, m): C1 W C0^T, factored */
    int *order;             /* (m,) pivots of its factors */
} zd_crossing_memory;

typedef struct zd_crossing {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *rate0, *rate1;    /* (nq,): pdot at its ends */
    int has_begun;          /* true if a start is saved for comparison: false at a bifurcation */
    int may_pass;           /* true if the step may pass a bifurcation */
    int constraints_hold;   /* true if (3) is satisfied at the end of every step */
    int has_rows;           /* true if memory->C belongs to the start of the step */
    int keeps_rows;         /* true if each step saves its rows, as with few constraints, or once a step has needed them */
    zd_crossing_memory *memory;
} zd_crossing;

zd_crossing zd_crossing_create(zd_arena *arena, zd_motion *motion, const zd_last *last);
int zd_crossing_begin(zd_crossing *self);       /* saves the present point as the start of a step */
/* Checks a step of size h and saves its end as the start of the next; ZD_BIFURCATION_PASSED if a bifurcation lies inside. `moved` is its
 * squared displacement in characteristic scales. */
int zd_crossing_step(zd_crossing *self, double h, double moved);
/* Evaluates memory->C without changing the point; ZD_NO_MEMORY if memory is lacking. */
int zd_crossing_need_rows(zd_crossing *self);
/* True if the point is at a bifurcation. */
int zd_crossing_is_at_one(const zd_point *point);
/* det(C1 W C0^T), of the independent constraints at the point (C1) and at the start of the step (C0). Its sign changes where a bifurcation
 * is passed. */
double zd_crossing_orientation(const zd_crossing *self);

/* Acceptance of a step: its displacement must agree with its velocities, and its size must be within the method's stability. */

/* The start of a step, with which its end is compared, and the schedule of checks. */
typedef struct zd_guard {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    zd_crossing *crossing;  /* provides C at the start of the step */
    int has_begun;          /* true if a start is saved for comparison */
    int checks_branch, checks_stability;    /* true for each of the two comparisons that is made */
    int watches_step;       /* true if this step gets the full checks */
    double astray, nearby, limit;   /* bounds: ASTRAY^2 / 2, NEARBY^2, (largest omega h)^4 of guard.c */
    double *pdot, *vdot;    /* (nq,), (nv,): at the start of the step; p and v are those of `last` */
    double *rate;           /* (nq,): pdot at the end */
    double fastest;         /* largest |pdot|^2 at the end of a checked step, in characteristic scales */
    double reach;           /* largest |p1 - p0|^2 for which the quick check suffices, likewise; 0 until the first full check */
    int64_t pause, next_check;   /* steps between full checks; the step of the next one */
    int is_ample;           /* true if the last checked step was far below the stability limit */
    int streak;             /* consecutive steps longer than the method is stable for */
    double largest_fourth;  /* largest (omega h)^4 of all checked steps */
    double kinetic;         /* J: largest kinetic energy of all checked steps */
} zd_guard;

typedef struct zd_detour {  /* sums of squares, in characteristic scales */
    double moved, detour;   /* displacement p1 - p0; detour p1 - p0 - h (pdot0 + pdot1) / 2 */
    double speed0, speed;   /* pdot at the start; at the end */
} zd_detour;

/* `stability`: largest omega h at which the method is stable; 0: unbounded. */
zd_guard zd_guard_create(zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability, const zd_last *last,
                       zd_crossing *crossing);
/* Saves the present point as the start of the step with this number. */
int zd_guard_begin(zd_guard *guard, int64_t step);
/* Compares displacement and velocities of a step of size h; ZD_BRANCH if they disagree. */
int zd_guard_compare(zd_guard *guard, double h, int64_t next_step, zd_detour *found);
/* Updates omega h, the count of too long steps, the largest speed and energy, from a step that gets the full checks. */
int zd_guard_watch(zd_guard *guard, const zd_detour *found, double h);
/* Schedules the next full check; `is_ample`: all other checked quantities were far from their limits. */
void zd_guard_pause(zd_guard *guard, int64_t step, int is_ample);
/* Saves the end of the step as the start of the next, */
void zd_guard_save(zd_guard *guard, int64_t next_step);
/* or only the acceleration, if the next step gets the full checks. */
void zd_guard_watch_next(zd_guard *guard);
double zd_guard_omega_h(const zd_guard *guard);     /* largest omega h of all checked steps */
double zd_guard_speed(const zd_guard *guard);       /* |pdot| at the start of the step, in characteristic scales */

/* ---- detour of a step ---- */

ZD_INLINE zd_detour zd_guard_find(const int n, const zd_guard *guard, const double *p0, const double *p, double h, const double *inverse_unit)
{
    zd_detour sum = {0, 0, 0, 0};
    for (int i = 0; i < n; i++) {
        double moved = (p[i] - p0[i]) * inverse_unit[i], rate0 = guard->pdot[i] * inverse_unit[i], rate = guard->rate[i] * inverse_unit[i];
        double detour = moved - 0.5 * h * (rate0 + rate);
        sum.moved += moved * moved;
        sum.detour += detour * detour;
        sum.speed0 += rate0 * rate0;
        sum.speed += rate * rate;
    }
    return sum;
}

/* Bound of the squared detour. */
ZD_INLINE double zd_guard_allows(const zd_guard *guard, double h, const zd_detour *found)
{
    return guard->astray * h * h * (found->speed0 + found->speed) + guard->nearby;
}

/* True if detour and speed give reason to keep the interval to the next full check. */
ZD_INLINE int zd_guard_is_calm(const zd_guard *guard, const zd_detour *found)
{
    return ZD_CALM_DETOUR * ZD_CALM_DETOUR * found->detour <= found->moved + guard->nearby &&
           found->speed <= ZD_FASTER_SPEED * guard->fastest + guard->nearby;
}

typedef struct zd_safeguards {
    zd_guard guard;
    zd_crossing crossing;
    zd_resolution resolution;   /* fixed steps only */
    zd_consistency consistency;
} zd_safeguards;

void zd_safeguards_create(zd_safeguards *self, zd_arena *arena, zd_motion *motion, const zd_settings *settings, const zd_card *method,
                        const zd_last *last);
/* Saves the present point as the start of the step with this number. */
int zd_safeguards_begin(zd_safeguards *self, int64_t step);
/* Comparison of the end of a step of size h with its start; `moved`: squared displacement in characteristic scales. */
typedef int zd_comparison(zd_safeguards *self, double h, double moved);
/* That of the matrix path: of C, as crossing.c computes it. */
int zd_safeguards_compare(zd_safeguards *self, double h, double moved);
/* Checks a step of size h and saves its end as the start of the next. `parts`: 0 for a whole step; otherwise it is one of that many parts,
 * of which only rotations are checked for resolution, as the step may still be abandoned. */
int zd_safeguards_judge(zd_safeguards *self, zd_comparison *compare, double h, int64_t next_step, int parts);
