/* A point of the motion: all quantities at one (t, p, v), each computed once, at its first request. */
#ifndef ZD_POINT_H
#define ZD_POINT_H

#include "layout.h"

/* ---- a system and the table of its terms ---- */

static inline int zd_constraints(const zd_system *system) { return system->mh + system->mn; }
static inline int zd_brings_times_A(const zd_system *system) { return system->operations && system->operations->times_A; }
/* True if pdot = A v with a kinematic matrix A, false if pdot = v. */
static inline int zd_has_A(const zd_system *system) { return (system->provides & ZD_A) || zd_brings_times_A(system); }
/* True if the system's own products replace the entries of C. */
static inline int zd_needs_no_C(const zd_system *system) { return system->operations && system->operations->add_weighted; }

double **zd_term_in(zd_terms *terms, int row);      /* address of the member for an entry of the list of terms */
const char *zd_term_name(int term);                 /* name of the term with this bit */
double *zd_create_inputs(zd_arena *arena, const zd_system *system);   /* (2 inputs + 1,): initial values, or those of zd_reading;
                                                                         * NULL without inputs */
int zd_largest_measure(const zd_measures *measures);    /* number of components of the largest measure; 0 without measures */

/* ---- a point ---- */

#define ZD_BIT_OF_VELOCITY(name, bit, member, shape, depends, text) | ((depends) == ZD_OF_POSITIONS ? 0 : (bit))
enum {                                  /* bits of `known` besides those of the system's terms */
    ZD_FACTORED = 1 << 24,              /* factored leading matrix of the formulation, at this (t, p) */
    ZD_ACCELERATED = 1 << 25,           /* vdot and lambda, at this (t, p, v) */
    ZD_COMPLEMENTED = 1 << 26,          /* the complement D and the matrices computed from it, at this (t, p) */
    ZD_RANKED = 1 << 27,                /* the selection of independent constraints, at this (t, p) */
    ZD_OF_VELOCITY = ZD_ACCELERATED ZD_TERM_LIST(ZD_BIT_OF_VELOCITY)    /* all quantities that depend on v */
};

typedef struct zd_rank zd_rank;         /* constraints/rank.h */

/* Right-hand sides (nv,), (m,) of a solve in formulation.h, and its solution x. */
typedef struct zd_right_side {
    const double *force, *rhs;
    double *x;
} zd_right_side;

typedef struct zd_point {
    const zd_system *system;
    zd_statistics *statistics;
    const zd_layout *layout;    /* storage of A, M and C; NULL if they are dense */
    int known;              /* bits of the quantities that are valid now */
    int constant;           /* ZD_M if M is constant, so that it stays valid when the point moves */
    double t, *p, *v;
    zd_terms terms;
    double *inputs;         /* (2 inputs + 1,): of the system, which are terms.inputs; NULL without inputs */
    double *vdot, *lambda;  /* (nv,), (m,) */
    double *force, *rhs;    /* (nv,), (m,): right-hand sides under construction */
    zd_right_side awaited;  /* right-hand side of the solve after a factorization, which can process it on the way; x NULL: not known */
    zd_rank *rank;          /* NULL if the point only evaluates terms */
    int rows, holonomic;    /* numbers of independent constraints (m without redundant ones), and of the holonomic ones, which come first */
    const double *C;        /* independent rows of C: the system's own as stored, or dense (rows, nv) */
    double *unit, *inverse_unit;    /* (nv,): characteristic scale of each velocity's displacement, see units.c; and 1 / unit */
    double *inverse_unit_p;         /* (nq,): 1 / characteristic scale of each coordinate */
    double *size;           /* (m,): size of each constraint: its largest derivative in these scales */
    double *inverse_size;       /* (m,): 1 / size */
    double *rounding;       /* (m,): length of a row of C below which it is the rounding of terms that cancel; 0: not known */
    int measured;           /* true if scales and sizes are computed */
    int failed_index, failed_column;    /* velocity or constraint of a failed factorization; for an asymmetric M, the column, too */
    double residual_left;   /* residual of a failed iteration */
    int left_domain;        /* true if the last evaluation failed with ZD_NOT_FINITE: at this state only, for all that is known */
} zd_point;

zd_point *zd_point_create(zd_arena *arena, const zd_system *system, zd_statistics *statistics);
void zd_point_move(zd_point *point, double t, const double *p, const double *v);
void zd_point_move_position(zd_point *point, const double *p);
void zd_point_move_velocity(zd_point *point, const double *v);
int zd_point_need_missing(zd_point *point, int missing);
void zd_point_force(const zd_point *point, double *force);          /* f - d */
static inline double zd_point_potential(const zd_point *point) { return point->terms.V ? *point->terms.V : 0; }     /* needs V */
int zd_point_is_finite(const zd_point *point);      /* true if p and v are finite */

/* Evaluates the terms in `want` that the system provides and that are not known yet. */
static inline int zd_point_need(zd_point *point, int want)
{
    int missing = want & point->system->provides & ~point->known;
    return missing ? zd_point_need_missing(point, missing) : ZD_DONE;
}

#endif
