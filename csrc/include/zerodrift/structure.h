/* Structure of a system of many bodies, and its own products with matrices: part of system.h. */
#ifndef ZERODRIFT_STRUCTURE_H
#define ZERODRIFT_STRUCTURE_H

#include "terms.h"

/* Bodies of a system (blocks), and the constraints that join them (groups). With a declared structure, matrices are packed:
 *
 *     A   block after block, (coordinates[b], velocities[b]) each
 *     M   block after block, (velocities[b], velocities[b]) each, or its diagonal (velocities[b],) with ZD_DIAGONAL
 *     C   group after group, (rows[g], width) each: its columns are the velocities of the blocks that the group touches, in their order
 *
 * all row-major, so that the entries of a row of C are contiguous. Vectors are not packed. A system with a structure must not provide D. */
enum zd_mass { ZD_CONSTANT = 1, ZD_DIAGONAL = 2 };

typedef struct zd_structure {
    int blocks;
    const int *coordinates;     /* (blocks,) number of entries of p per block, in order, at least 1; sum: nq without followers */
    const int *velocities;      /* (blocks,) number of entries of v per block, in order, at least 1; sum: nv */
    const int *mass;            /* (blocks,) bits of zd_mass; NULL: all 0 */
    int groups;
    const int *rows;            /* (groups,) number of rows of C per group, in order, at least 1; sum: m; all holonomic, or all
                                 * nonholonomic */
    const int *first;           /* (groups + 1,) offset of the blocks of each group in `block` */
    const int *block;           /* (first[groups],) the blocks that each group touches, at least 1, increasing */
} zd_structure;

/* Products with matrices, for systems that compute them faster than from stored entries; NULL: from stored entries. They are called after
 * evaluate() with ZD_MOVED at the same (t, p), and may read its scratch. If both of the last two are provided, and all of M is diagonal by
 * structure, accelerations and corrections need no entries of C, which are then evaluated in rare cases only: so these and times_C must
 * not read C. */
typedef struct zd_operations {
    void (*times_A)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = A x, (nq,): if A is provided */
    void (*times_C)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = C x, (m,) */
    void (*times_M)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = M x, (nv,) */
    /* x <- x - W C^T y, W (nv,) diagonal; entry place[k] of y belongs to row k of C, and rows of a group are contiguous in y, too */
    void (*subtract_weighted)(const void *data, const zd_terms *terms, const double *W, const double *y, const int *place, double *x);
    /* S <- S + C W C^T: for each block in order, the products of its columns in the groups that touch it, of each group g and all h <= g,
     * increasing both. The block (rows[g], rows[h]) of the next of them begins in S at half of the next entry of `at`; it is stored
     * transposed where that entry is odd. Of those with g = h, nothing but the lower triangle is read. */
    void (*add_weighted)(const void *data, const zd_terms *terms, const double *W, const int *at, double *S);
} zd_operations;

#endif
