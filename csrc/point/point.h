/* A point of the motion: all quantities at one (t, p, v), each computed once, at its first request. */
#pragma once

#include "../linalg/small.h"
#include "../workspace.h"
#include "../zerodrift.h"

/* Layout of the packed A, M and C of a system that declares its structure; in other systems they are dense. */

typedef struct zd_layout {
    int blocks, groups;
    int *coordinate_at, *velocity_at;   /* (blocks + 1,): offsets of each block in p, in v */
    int *A_at, *M_at;       /* (blocks + 1,): offsets of its blocks of A and M */
    int *is_diagonal;       /* (blocks,): true if only the diagonal of its M is stored */
    int *block_of;          /* (nv,): the block of each velocity */
    int *row_at, *C_at;     /* (groups + 1,): first row of each group, and offset of its entries in C */
    int *width;             /* (groups,): number of entries stored per row */
    int *group_of;          /* (m,): the group of each row of C */
    int *touched_at, *touched;  /* (groups + 1,), (touched_at[groups],): the blocks that each group touches, increasing */
    int *toucher_at;        /* (blocks + 1,): offsets of each block in the next two arrays */
    int *toucher, *toucher_offset;      /* the groups that touch a block, increasing, and the offset of its entries in their rows */
    int max_touchers;      /* largest number of groups on a block that S(W) does not split into welded parts: see weighted.c */
    int *column_at, *column;    /* (groups + 1,), (column_at[groups],): the velocities of the entries in the rows of each group */
} zd_layout;

/* Stored entries of a row of C: x (count,), for the velocities `column` (count,), which increase; column NULL: for all velocities. */
typedef struct zd_row_of_C {
    const double *x;
    int count;
    const int *column;
} zd_row_of_C;

static inline int zd_column(const zd_row_of_C *row, int j) { return row->column ? row->column[j] : j; }

/* Row k of a packed C. */
static inline zd_row_of_C zd_packed_row(const zd_layout *layout, const double *C, int k)
{
    const int g = layout->group_of[k], width = layout->width[g];
    return (zd_row_of_C){C + layout->C_at[g] + (k - layout->row_at[g]) * width, width, layout->column + layout->column_at[g]};
}

/* NULL if the system declares no structure, or while the arena only counts. */
const zd_layout *zd_layout_create(zd_arena *arena, const zd_system *system);
/* Number of stored entries of A, M or C of a system that declares its structure. */
int zd_packed_size(const zd_system *system, int term);
/* True if all blocks of M are declared to be of this kind. */
int zd_mass_is(const zd_system *system, enum zd_mass kind);
/* Number of stored entries of M, of C, of any system. */
int zd_size_of_M(const zd_system *system);
int zd_size_of_C(const zd_system *system);
/* Memory for a dense matrix of `count` doubles, if the system's own is packed. */
double *zd_create_dense(zd_arena *arena, const zd_system *system, size_t count);
/* M <- identity, stored as the system's M. */
void zd_set_identity(const zd_system *system, double *M);

/* ---- a system and the table of its terms ---- */

static inline int zd_constraints(const zd_system *system) { return system->mh + system->mn; }

/* Number of constraints outside all groups. */
static inline int zd_own_constraints(const zd_system *system)
{
    int own = 0;
    for (int row = 0; row < zd_constraints(system); row++) {
        int is_own = 1;
        for (const zd_group *it = system->group; it < system->group + system->groups; it++)
            is_own &= row < it->first || row >= it->first + it->rows;
        own += is_own;
    }
    return own;
}
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
    double *vdot, *lambda;  /* (nv,), and (m,) behind it */
    double *force, *rhs;    /* (nv,), (m,): right-hand sides under construction */
    zd_right_side awaited;  /* right-hand side of the solve after a factorization, which can process it on the way; x NULL: not known */
    zd_rank *rank;          /* NULL if the point only evaluates terms */
    struct zd_phase_system *phase;  /* that of its system, if that has groups: contact/phase_system.h; otherwise NULL */
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

/* Checks that the user functions are defined at the point, whose quantities x may be off by atol + rtol |x|. */
static inline int zd_point_check_domain(const zd_point *point, double rtol, double atol)
{
    const zd_system *system = point->system;
    if (!system->check_domain) return ZD_DONE;
    return system->check_domain(system->data, rtol, atol, point->t, point->p, point->v, point->terms.scratch);
}

/* Evaluates the terms in `want` that the system provides and that are not known yet. */
static inline int zd_point_need(zd_point *point, int want)
{
    int missing = want & point->system->provides & ~point->known;
    return missing ? zd_point_need_missing(point, missing) : ZD_DONE;
}

/* Names of constraints in messages. */

enum { ZD_CONSTRAINT_NAME = 64 };      /* size of a name, characters */

/* Index of the constraint, with its name if the system provides one: "3", "3 'B.y'". Returns `to`. */
const char *zd_name_constraint(const zd_system *system, int row, char to[ZD_CONSTRAINT_NAME]);

/* Characteristic scales, which make tolerances independent of the units of a system. */

int zd_point_measure(zd_point *point);              /* computes scales and sizes at the present point */
/* Largest |Phi| relative to the size of its constraint; requires Phi */
static inline double zd_point_violation(const zd_point *point)
{
    return zd_max_scaled(point->system->mh, point->terms.Phi, point->inverse_size);
}

/* Cholesky's factors of M, block by block where its structure is declared. */

/* L, stored as M is, with the factors of zd_cholesky(). Returns nv, or the velocity at which M is found not positive definite. */
int zd_mass_factor(const zd_point *point, double *L);

/* x <- M^-1 y, from the factors of all blocks; x may be y */
void zd_mass_solve(const zd_layout *layout, const double *L, const double *y, double *x);

/* Conversion of packed matrices to dense ones. */

/* dense <- A (nq, nv), M (nv, nv) or C (m, nv), from the packed term of a system that declares its structure. */
void zd_expand(const zd_system *system, int term, const double *packed, double *dense);

/* Entries of A, M and C at a point, and products with them, for dense and packed storage. All code except factorizations uses these. */

/* Row k of a matrix stored as the point's C. */
zd_row_of_C zd_row_in(const zd_point *point, const double *C, int k);
static inline zd_row_of_C zd_point_row(const zd_point *point, int k) { return zd_row_in(point, point->terms.C, k); }
/* Row of the k-th independent constraint, k < point->rows. */
zd_row_of_C zd_counted_row(const zd_point *point, int k);
double zd_row_times(const zd_row_of_C *row, const double *x);       /* x (nv,) */
double zd_row_product(const zd_row_of_C *a, const zd_row_of_C *b);
/* Entry k of rhs - C x of a packed C; *size: the sum of the magnitudes of its terms. */
double zd_packed_row_residual(const zd_layout *layout, const double *C, int k, const double *rhs, const double *x, double *size);
/* residual (rows,) <- rhs - C x. Returns its largest entry relative to the largest of its terms, both in the metric of the weights (rows,);
 * *square: the square of the latter. */
double zd_packed_residual(const zd_layout *layout, const double *C, int rows, const double *rhs, const double *x, const double *weight,
                          double *residual, double *square);
void zd_row_expand(const zd_row_of_C *row, int n, double *x);       /* x (n,) <- the row with its zeros */
/* to (nv,) <- row k of C times scale (nv,), zero where it is the rounding error of terms that cancel. Returns its norm. */
double zd_point_scaled_row(const zd_point *point, int k, const double *scale, double *to);
void zd_add_C(const zd_point *point, double weight, double *C);     /* C (m, nv) <- C + weight times the point's */

int zd_point_need_times_C(zd_point *point);         /* evaluates the entries of C, or prepares the system's own products with C */
void zd_point_velocity_violation(const zd_point *point, double *Psi);       /* (5); requires zd_point_need_times_C() and Phi_t */
/* Evaluates the terms in `want`, and the entries of A, or prepares the system's own products with A. */
int zd_point_need_times_A(zd_point *point, int want);
void zd_point_rate(const zd_point *point, const double *v, double *pdot);   /* (1); requires zd_point_need_times_A() */
double zd_point_kinetic(const zd_point *point);     /* J: kinetic energy; requires M */
/* y (nv,) <- M x; M stored as the point's. */
void zd_times_M(const zd_point *point, const double *M, const double *x, double *y);
double zd_packed_entry_of_M(const zd_layout *layout, const double *M, int i, int j);
static inline double zd_entry_of_M(const zd_point *point, int i, int j)
{
    const double *M = point->terms.M;
    return point->layout ? zd_packed_entry_of_M(point->layout, M, i, j) : M[i * point->system->nv + j];
}
/* The first velocity for which row i of M has an entry. */
static inline int zd_first_in_M(const zd_point *point, int i)
{
    const zd_layout *layout = point->layout;
    return !layout ? 0 : layout->is_diagonal[layout->block_of[i]] ? i : layout->velocity_at[layout->block_of[i]];
}
double zd_packed_entry_of_A(const zd_layout *layout, const double *A, int i, int j);
/* Entry of A, the identity if the system has none. */
static inline double zd_entry_of_A(const zd_point *point, int i, int j)
{
    const double *A = point->terms.A;
    return !A ? i == j : point->layout ? zd_packed_entry_of_A(point->layout, A, i, j) : A[i * point->system->nv + j];
}

/* Dense M (nv, nv), and dense independent rows of C (rows, nv): the point's own, or expanded into `memory` if packed. */
const double *zd_dense_M(const zd_point *point, double *memory);
const double *zd_dense_C(const zd_point *point, double *memory);

/* Normalization and checks of unit quaternions among the coordinates. */

/* Normalizes the quaternions in p (nq,) whose length differs from one by more than rounding; returns true if p has changed. */
int zd_quaternions_bring_back(const zd_system *system, double *p);
static inline int zd_quaternions_normalise(const zd_system *system, double *p)
{
    return system->quaternions ? zd_quaternions_bring_back(system, p) : 0;
}

/* Updates the coordinates of the point that are functions of others; known quantities stay valid. */
static inline void zd_point_follow(zd_point *point)
{
    if (point->system->followers) point->system->follow(point->system->data, point->p);
}

/* Normalizes the point's quaternions, and updates its dependent coordinates. */
static inline void zd_point_normalise(zd_point *point)
{
    if (zd_quaternions_normalise(point->system, point->p)) point->known = 0;
    zd_point_follow(point);
}

/* Index of the first quaternion in p that is not a rotation, and its length; -1: none. With `any_length` only zero length is refused,
 * otherwise all lengths that differ from one by more than 1e-6. */
int zd_quaternions_wrong_length(const zd_system *system, const double *p, int any_length, double *length);
/* Index of the first quaternion whose length pdot = A v changes, and the velocity that changes it; -1: none. Requires A. */
int zd_quaternion_off_unit(const zd_point *point, int *velocity);
