/* Sparse block factorization S = L D L^T of symmetric positive definite matrices. */
#ifndef ZD_LINALG_SPARSE_BLOCKS_H
#define ZD_LINALG_SPARSE_BLOCKS_H

#include "../../workspace.h"
#include "ordering.h"

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

#endif
