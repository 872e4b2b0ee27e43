/* S(W) = C W C^T of a system that declares its structure. W is the inverse of a matrix that is stored as M is, by Cholesky's factors of its
 * blocks: those of M for (13) and (27), of I for the identity metric. */
#ifndef ZD_WEIGHTED_H
#define ZD_WEIGHTED_H

#include "../linalg/blocks.h"
#include "row_groups.h"

/* The block of C of a group and a body that it touches; or of a weld, see weighted.c. */
typedef struct zd_piece {
    int C, stride;          /* where it begins in C, and how long the rows there are; of a weld, in its own blocks */
    int rows, n;            /* its size */
    int row;                /* the first, of C */
    int W, is_diagonal;     /* the body's part of W */
    int copies;             /* of the body */
    int is_weld;
} zd_piece;

enum { ZD_SQUARE = 100 };       /* more of a kernel: for a piece with itself */

typedef struct zd_pair {    /* two pieces of one body, and the block of S that takes A W B^T */
    int kernel;             /* 0: there is none for these sizes, and `a` and `b` are the pieces; else where these begin in C */
    int a, b;
    int stride_of_a, stride_of_b, W;
    int to;
} zd_pair;

typedef struct zd_weighted {
    const zd_layout *layout;
    zd_blocks *blocks;
    int pieces, pairs;      /* pieces of C, welds not counted */
    zd_piece *piece;
    int members, squares, others;       /* the pairs of one piece with itself, `members`, come first */
    zd_pair *pair;
    double *weld;           /* an identity and its opposite, as large as the largest body */
    int *at;                /* (pairs,) where the blocks of each are, for a system's own products: see zd_operations */
    int largest;            /* velocities of that; 0 where there are no welds */
    int *row;               /* (groups,) where the rows of each stand in a right side of S */
    zd_row_groups row_groups;       /* the same rows, for products */
    double *product;        /* room for A W */
} zd_weighted;

/* All that is symbolic, and memory for the factors; NULL where there is none. */
zd_weighted *zd_weighted_create(zd_store *store, const zd_layout *layout);
static inline int zd_weighted_has_welds(const zd_weighted *self) { return self->largest > 0; }
/* Those of the system, where they serve for all of its bodies; NULL: C is needed. */
const zd_operations *zd_weighted_products(const zd_weighted *self, const zd_system *system);
/* S(W) and its factors, from C or from these products; y is carried along as zd_blocks_factor() does. */
zd_pivots zd_weighted_factor(zd_weighted *self, const double *C, const double *W, double *y);
zd_pivots zd_weighted_factor_by(zd_weighted *self, const zd_operations *products, const void *data, const zd_terms *terms, const double *W,
                               double *y);
/* The same without the rows that are noted in `without`, in the order of S. */
zd_pivots zd_weighted_factor_without(zd_weighted *self, const double *C, const double *W, unsigned char *without);
/* The same, with the rows of C noted in `left_out` (m,) that follow from others: of which less than the share `least` is left, in the
 * metric W, once those eliminated before are taken out. Returns how many rows of welds are left out in the place of such, or -1 where
 * there is no memory. */
int zd_weighted_leave_out(zd_weighted *self, const double *C, const double *W, double least, unsigned char *left_out);
/* y <- C x - rhs, y <- S^-1 y and x <- x - C^T y: y in the order of S, where welds have no right side; rhs (m,) NULL: zero. */
void zd_weighted_times(const zd_weighted *self, const double *C, const double *x, const double *rhs, double *y);
static inline void zd_weighted_solve(const zd_weighted *self, double *y) { zd_blocks_solve(self->blocks, y); }
static inline void zd_weighted_subtract_transposed(const zd_weighted *self, const double *C, const double *y, double *x)
{
    zd_row_groups_subtract_transposed(&self->row_groups, C, y, x);
}
/* rows (m,) <- y, in the order of C. */
static inline void zd_weighted_scatter(const zd_weighted *self, const double *y, double *rows)
{
    zd_row_groups_scatter(&self->row_groups, y, rows);
}
/* Whether bodies contribute alike to each row, W is all in its diagonal, and no body is taken as several; least, most (m,): room. */
int zd_weighted_is_alike(const zd_weighted *self, const double *C, const double *W, double *least, double *most);
/* Which row of C has this place in the order of S; of a weld, the first. */
int zd_weighted_row(const zd_weighted *self, int place);

#endif
