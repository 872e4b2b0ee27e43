/* C M^-1 C^T of (13), where M is block-diagonal and each row of C touches few of its blocks. */
#ifndef ZD_SCHUR_BLOCKS_H
#define ZD_SCHUR_BLOCKS_H

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/weighted.h"

typedef struct zd_schur_blocks {
    int n, m;
    zd_weighted *weighted;  /* S(M^-1); NULL until it is first wanted */
    double *W;              /* stored as M is: M^-1, by its factors */
    int is_diagonal;        /* whether all of M is */
    int is_constant;        /* whether M is, by what the system declares, and so W once it is known: */
    int is_known;
    double share;           /* of its diagonal entry: the smallest pivot where it was factored */
    int smallest;           /* where that is in the order of S */
    int is_accurate;        /* whether neither pivots nor masses there are such that the solution has to be looked at */
    int is_compared;        /* whether solutions are, as it was factored last */
    int wait, pause;        /* factorizations until they are again; that were, from the time before to the last */
    double compared_share;  /* the smallest pivot at the last */
    double *force;          /* (n,): of the constraints, too */
    double *lambda;         /* (m,) */
    double *rest, *step;    /* (m,), (n,): what is left of C x = rhs, and what removes it */
    double *least;          /* (m,), in the order of S: what is more on its diagonal belongs to a row that is long; NULL: not asked */
    int is_least_known;
    const zd_operations *products;      /* of the system, in place of those with C; NULL: there are none */
    const void *data;           /* what these are called with, and the terms at the point */
    zd_terms terms;
    zd_right_side begun;        /* what was awaited where it was factored, until it is solved for; x NULL: nothing */
    const zd_layout *layout;    /* of the point where it was factored, as its C */
    const double *C;
    int has_redundant;          /* whether not all rows are to count */
    unsigned char *without;     /* (rows of S,), in its order: those left out */
    const zd_selection *chosen; /* those that count, where it was factored; NULL: all do */
    double *rhs_of_all, *lambda_of_all;     /* (m,) */
} zd_schur_blocks;

/* NULL where the system declares no structure, or not all of its many rows are to count. */
zd_schur_blocks *zd_schur_blocks_take(zd_arena *arena, const zd_system *system);
/* All rows count at the point, or it is known which do, without limits. ZD_DEPENDENT_ROWS: to the precision of C M^-1 C^T, as it is here. */
int zd_schur_blocks_factor(zd_schur_blocks *self, zd_point *point);
/* zd_rows_are_long() where it was factored, from the diagonal of S if that tells, else from C. */
int zd_schur_blocks_find_long_rows(zd_schur_blocks *self, zd_point *point);
static inline int zd_schur_blocks_has_long_rows(zd_schur_blocks *self, zd_point *point)
{
    const int is_told = self->is_least_known && point->rank->is_started;
    return (is_told && zd_all_exceed(self->m, self->weighted->blocks->diagonal, self->least)) || zd_schur_blocks_find_long_rows(self, point);
}
/* As the solve of formulation.h, of the rows that count. */
void zd_schur_blocks_solve(zd_schur_blocks *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
