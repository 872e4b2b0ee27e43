/* Symmetric positive definite matrices of few blocks, S = L D L^T, at a cost that follows the blocks that there are. */
#ifndef ZD_BLOCKS_H
#define ZD_BLOCKS_H

#include "../workspace.h"
#include "ordering.h"

typedef struct zd_blocks {
    int count, rows;        /* block rows; rows in all */
    int *place;             /* (count,) where each block row stands in the order of elimination; all that follows is in this order */
    int *at;                /* (count + 1,) where the rows of each begin in a right side */
    int *pivot_at;          /* (count + 1,) where its diagonal block begins in S */
    int *begin, *row;       /* (count + 1,), (entries,): of each column, the block rows below its diagonal block */
    int *entry_at;          /* (entries + 1,) where their blocks begin in S */
    int *target_begin;      /* (count + 1,) */
    int *target;            /* for each pair of them, the block in S that takes their product */
    int *kernel;            /* (count,) the size of all blocks of a column that has one for which there is a kernel; else 0 */
    int uniform;            /* the same of all columns; 0: they differ */
    int size;               /* of S */
    double *S;              /* diagonal blocks, then those below it, column after column; once factored, D^-1 and L D */
    double *diagonal;       /* (rows,): of S before that */
    double *product;        /* room for one block */
    double *x;              /* (rows,) */
} zd_blocks;

/* How far from singular the matrix was found. */
typedef struct zd_pivots {
    int failed;             /* the first row, in the order of elimination, whose pivot is not positive; -1: there is none */
    int smallest;           /* the row whose pivot is the smallest part of its diagonal entry, */
    double pivot, diagonal; /* and these two */
} zd_pivots;

/* The matrix with room for its factors; only counts while the arena does. */
zd_blocks *zd_blocks_take(zd_arena *arena, const zd_ordering *ordering);
/* Where block (i, j) of the pattern is in S: that of the later row of the two, in the order of elimination, and the earlier column. */
int zd_blocks_find(const zd_blocks *self, int i, int j);
void zd_blocks_clear(zd_blocks *self);
/* S, whose blocks have been filled, into its factors. Where `left_out` (rows,) is not NULL, rows whose pivots are not more than `least` of
 * their diagonal entries are noted there, and are as if they were not there, with their columns; with `least` below zero, those noted
 * there already. Where x (rows,) is not NULL, zd_blocks_forward() is made of it on the way. */
zd_pivots zd_blocks_factor(zd_blocks *self, unsigned char *left_out, double least, double *x);
/* x (rows,), in the order of elimination, <- S^-1 x, in two halves; those left out become zero. */
void zd_blocks_forward(const zd_blocks *self, double *x);
void zd_blocks_backward(const zd_blocks *self, double *x);
/* Z (size,) <- blocks of S^-1 where the factors have some, stored as these are; no row was left out. */
void zd_blocks_invert(const zd_blocks *self, double *Z);
static inline void zd_blocks_solve(const zd_blocks *self, double *x)
{
    zd_blocks_forward(self, x);
    zd_blocks_backward(self, x);
}

#endif
