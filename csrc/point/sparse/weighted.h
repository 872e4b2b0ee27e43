/* S(W) = C W C^T of a system that declares its structure. W is the inverse of a matrix that is stored as M is, by Cholesky's factors of its
 * blocks: those of M for (13) and (27), of I for the identity metric. */
#pragma once

#include "../../linalg/sparse/blocks.h"
#include "row_groups.h"

/* Block of C for a group and a body that it touches; or for a weld, see weighted.c. */
typedef struct zd_piece {
    int C, stride;          /* offset in C, and length of its rows there; for a weld, in `weld` */
    int rows, n;            /* its size */
    int row;                /* its first row of C */
    int W, is_diagonal;     /* offset of the body's block in W; true if that is diagonal */
    int copies;             /* number of parts into which the body is split */
    int is_weld;
} zd_piece;

enum { ZD_SQUARE = 100 };       /* added to a kernel: product of a piece with itself */

typedef struct zd_pair {    /* two pieces of one body, and the block of S to which A W B^T is added */
    int kernel;             /* 0: no kernel for these sizes, `a` and `b` are indices of pieces; otherwise they are offsets in C */
    int a, b;
    int stride_of_a, stride_of_b, W;
    int to;
} zd_pair;

typedef struct zd_weighted {
    const zd_layout *layout;
    zd_blocks *blocks;
    int pieces, pairs;      /* pieces of C, except welds */
    zd_piece *piece;
    int members, squares, others;       /* the `members` pairs of a piece with itself come first */
    zd_pair *pair;
    double *weld;           /* an identity and its negative, of the size of the largest split body */
    int *at;                /* (pairs,) offsets of their blocks in S, for a system's own products: see zd_operations */
    int largest;            /* velocities of the largest split body; 0 without welds */
    int *row;               /* (groups,) offset of the rows of each in a right-hand side of S */
    zd_row_groups row_groups;       /* the same rows, for products */
    double *product;        /* temporary A W */
} zd_weighted;

/* Symbolic factorization, and memory for the factors; NULL without memory. */
zd_weighted *zd_weighted_create(zd_store *store, const zd_layout *layout);
static inline int zd_weighted_has_welds(const zd_weighted *self) { return self->largest > 0; }
/* The system's own products if they apply to all of its bodies; NULL: the entries of C are needed. */
const zd_operations *zd_weighted_products(const zd_weighted *self, const zd_system *system);
/* S(W) and its factors, from C or from these products; y <- forward substitution on the way, as in zd_blocks_factor(). */
zd_pivots zd_weighted_factor(zd_weighted *self, const double *C, const double *W, double *y);
zd_pivots zd_weighted_factor_by(zd_weighted *self, const zd_operations *products, const void *data, const zd_terms *terms, const double *W,
                               double *y);
/* The same without the rows marked in `without` (rows of S,), in the order of S. */
zd_pivots zd_weighted_factor_without(zd_weighted *self, const double *C, const double *W, unsigned char *without);
/* The same, marking redundant constraints in `left_out` (m,): those whose pivot, after elimination of the earlier rows, is less than `least`
 * times its diagonal entry. Returns the number of rows of welds left out instead of constraints, or -1 without memory. */
int zd_weighted_leave_out(zd_weighted *self, const double *C, const double *W, double least, unsigned char *left_out);
/* y <- C x - rhs in the order of S, where welds have no right side; rhs (m,) NULL: zero. */
void zd_weighted_times(const zd_weighted *self, const double *C, const double *x, const double *rhs, double *y);
/* True if the bodies of each constraint contribute similar amounts to its diagonal entry in S, W is diagonal, and no body is split.
 * least, most (m,): memory for the smallest and largest contributions. */
int zd_weighted_is_alike(const zd_weighted *self, const double *C, const double *W, double *least, double *most);
/* Row of C at this position in the order of S; for a weld, 0. */
int zd_weighted_row(const zd_weighted *self, int place);
