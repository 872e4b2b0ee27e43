/* Sparse block factorization S = L D L^T of symmetric positive definite matrices. */
#pragma once

#include "../../workspace.h"
#include "../small.h"

/* An order in which a symmetric matrix of blocks is eliminated with little fill. */

/* Nonzero blocks of the matrix. Two block rows that share a clique have one. */
typedef struct zd_pattern {
    int count;              /* block rows */
    const int *size;        /* (count,) rows of each, at least one */
    int cliques;
    const int *begin, *member;  /* (cliques + 1,), (begin[cliques],): the block rows of each, each at most once */
} zd_pattern;

/* The order, and what is below the diagonal once fill is added. */
typedef struct zd_ordering {
    int count;
    int *place;             /* (count,) position of each block row in the order */
    int *size;              /* (count,) rows of each, in the order */
    int *begin;             /* (count + 1,) in the order: where the block rows begin that are below the diagonal in each column */
    int *row;               /* (begin[count],) their places, increasing in each column */
} zd_ordering;

/* Takes memory of its own, which zd_ordering_free() releases. Returns 0 where there is none. `given` (count,): the block rows in the order in
 * which they are to be eliminated; NULL: in one of little fill. */
int zd_ordering_find(const zd_pattern *pattern, const int *given, zd_ordering *ordering);
void zd_ordering_free(zd_ordering *ordering);

typedef struct zd_blocks {
    int count, rows;        /* block rows; scalar rows */
    int *place;             /* (count,) position of each block row in the order of elimination, which all arrays below follow */
    int *at;                /* (count + 1,) offset of each block row in a right-hand side */
    int *pivot_at;          /* (count + 1,) offset of its diagonal block in S */
    int *begin, *row;       /* (count + 1,), (entries,): block rows below the diagonal block of each column */
    int *entry_at;          /* (entries + 1,) offsets of their blocks in S */
    int *target_begin;      /* (count + 1,) offset of each column in `target` */
    int *target;            /* offset of the block in S to which the product of each pair of them is added */
    int *kernel;            /* (count,) size of all blocks of a column, if they are equal and have a compiled kernel; else 0 */
    int uniform;            /* the same for all columns; 0: they differ */
    int size;               /* number of entries of S */
    double *S;              /* diagonal blocks, then those below the diagonal, column after column; once factored, D^-1 and L D */
    double *diagonal;       /* (rows,): diagonal of S before the factorization */
    double *product;        /* temporary block */
    double *x;              /* (rows,) temporary */
} zd_blocks;

/* Rows of the k-th block row in the order of elimination. */
static inline int zd_block_size(const zd_blocks *self, int k) { return self->at[k + 1] - self->at[k]; }

/* Pivots of a factorization. */
typedef struct zd_pivots {
    int failed;             /* first row, in the order of elimination, whose pivot is not positive; -1: none */
    int smallest;           /* row of the smallest relative pivot, */
    double pivot, diagonal; /* that pivot, and its diagonal entry before the elimination */
} zd_pivots;

/* The matrix with memory for its factors; NULL while the arena only counts. */
zd_blocks *zd_blocks_create(zd_arena *arena, const zd_ordering *ordering);
/* Offset in S of block (i, j) of the pattern: in the row of the later, and the column of the earlier, in the order of elimination. */
int zd_blocks_find(const zd_blocks *self, int i, int j);
void zd_blocks_clear(zd_blocks *self);
/* S <- its factors. With `left_out` (rows,), rows whose relative pivot is at most `least` are marked there and omitted, with their columns;
 * with a negative `least`, the rows already marked are omitted. With x (rows,), zd_blocks_forward(x) is computed on the way. */
zd_pivots zd_blocks_factor(zd_blocks *self, unsigned char *left_out, double least, double *x);
/* x (rows,), in the order of elimination, <- S^-1 x, in two halves; omitted rows get zero. */
void zd_blocks_forward(const zd_blocks *self, double *x);
void zd_blocks_backward(const zd_blocks *self, double *x);
/* Z (size,) <- the blocks of S^-1 in the pattern of the factors, stored alike; no row may be omitted. */
void zd_blocks_invert(const zd_blocks *self, double *Z);
static inline void zd_blocks_solve(const zd_blocks *self, double *x)
{
    zd_blocks_forward(self, x);
    zd_blocks_backward(self, x);
}

/* Block factors as in blocks.h, but with triangular factors of diagonal blocks: for ill-conditioned matrices, whose blocks must not be
 * inverted. */

/* S <- its factors. Returns the first row, in the order of elimination, whose pivot is not positive, or -1. */
int zd_triangular_factor(zd_blocks *self);
/* x (rows,), in the order of elimination, <- S^-1 x */
void zd_triangular_solve(const zd_blocks *self, double *x);

/* Checks of pivots, and the inverse of a block of two rows. */

/* True if this pivot is positive; updates the smallest relative pivot. Ratios are compared by products, to avoid divisions. */
ZD_INLINE int zd_judge_pivot(zd_pivots *pivots, int row, double pivot, double diagonal, double rounding)
{
    if (!(pivot > rounding * diagonal) || !(pivot < INFINITY)) {
        if (pivots->failed < 0) pivots->failed = row;
        return 0;
    }
    if (pivot * pivots->diagonal < pivots->pivot * diagonal) pivots->smallest = row, pivots->pivot = pivot, pivots->diagonal = diagonal;
    return 1;
}

typedef struct zd_inverse_of_two {  /* symmetric inverse, in registers: these entries times the scale; scale 0: singular */
    double aa, ab, bb, scale;
} zd_inverse_of_two;

/* Inverse of a block given by its lower triangle, with one division instead of two that depend on each other. Each relative pivot is at
 * least the product of both; only if that product is below the smallest relative pivot so far, the pivots are compared individually, and
 * checked if one is smaller. `row` is the first row of the block. */
ZD_INLINE zd_inverse_of_two zd_invert_two(const double *diagonal, int row, const double *P, zd_pivots *pivots)
{
    const double a = P[0], b = P[2], c = P[3], determinant = a * c - b * b, rounding = 2 * 0x1p-52;
    int are_pivots = 1;
    const double second = determinant * pivots->diagonal, least = pivots->pivot * diagonal[1];
    const int is_product_less = !(second >= diagonal[0] * least);
    const int is_less = is_product_less && (!(a * pivots->diagonal >= pivots->pivot * diagonal[0]) || !(second >= a * least));
    if (!(a > 0) || is_less || !(determinant < INFINITY))
        are_pivots = zd_judge_pivot(pivots, row, a, diagonal[0], rounding)
                   & zd_judge_pivot(pivots, row + 1, determinant, a * diagonal[1], rounding);
    return (zd_inverse_of_two){c, -b, a, are_pivots ? 1 / determinant : 0};
}
