/* Schur complement C M^-1 C^T of (13) in sparse blocks, for block-diagonal M and rows of C that touch few blocks. */
#ifndef ZD_SCHUR_BLOCKS_H
#define ZD_SCHUR_BLOCKS_H

#include "../../constraints/rank.h"
#include "../../linalg/small.h"
#include "../../point/sparse/weighted.h"

typedef struct zd_schur_blocks {
    int n, m;
    zd_weighted *weighted;  /* S(M^-1); NULL until first needed */
    double *W;              /* stored as M: factors of M^-1 */
    int is_diagonal;        /* 1: M is diagonal */
    int is_constant;        /* 1: M is declared constant, so W is computed once; is_known: it has been */
    int is_known;
    double share;           /* smallest pivot of S relative to its diagonal entry, at the last factorization */
    int smallest;           /* index of that pivot in the order of S */
    int is_accurate;        /* 1: neither pivots nor mass ratios require solutions to be verified */
    int is_compared;        /* 1: solutions with the present factors are verified */
    int wait, pause;        /* number of factorizations until the next verification, and between the last two */
    double compared_share;  /* smallest pivot at the last verification */
    double *force;          /* (n,): force - C^T lambda */
    double *lambda;         /* (m,) */
    double *residual, *step;    /* (m,), (n,): residual rhs - C x, and its correction */
    double *least;          /* (m,), in the order of S: diagonal entries above it prove that the row is not small; NULL: unused */
    int is_least_known;
    const zd_operations *products;      /* the system's own products with C; NULL: none */
    const void *data;           /* their data and the terms at the point */
    zd_terms terms;
    zd_right_side begun;        /* right-hand side eliminated during factorization, until it is solved for; x NULL: none */
    const zd_layout *layout;    /* layout and C of the point at the factorization */
    const double *C;
    int has_redundant;          /* 1: some constraints are redundant */
    unsigned char *without;     /* (rows of S,): 1 for constraints left out */
    const zd_selection *chosen; /* selected constraints at the factorization; NULL: all */
    double *rhs_of_all, *lambda_of_all;     /* (m,) */
} zd_schur_blocks;

/* Returns NULL if the system declares no structure, or has redundant constraints and exceeds ZD_MAX_DENSE_ROWS. */
zd_schur_blocks *zd_schur_blocks_create(zd_arena *arena, const zd_system *system);
/* Factors S; all constraints are independent at the point, or their selection is known, without limits. ZD_DEPENDENT_ROWS: S is singular
 * to rounding. */
int zd_schur_blocks_factor(zd_schur_blocks *self, zd_point *point);
/* zd_rows_are_long() at the factorization, from the diagonal of S if that is conclusive, else from C. */
int zd_schur_blocks_find_long_rows(zd_schur_blocks *self, zd_point *point);
static inline int zd_schur_blocks_has_long_rows(zd_schur_blocks *self, zd_point *point)
{
    const int is_known = self->is_least_known && point->rank->is_started;
    return (is_known && zd_all_exceed(self->m, self->weighted->blocks->diagonal, self->least)) || zd_schur_blocks_find_long_rows(self, point);
}
/* solve() of formulation.h, for the selected constraints. */
void zd_schur_blocks_solve(zd_schur_blocks *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
