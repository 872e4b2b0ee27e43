/* Variable partitioning (16) of a declared structure with many constraints: selects independent velocities and solves for the others, at
 * a cost proportional to the number of bodies. */
#ifndef ZD_PARTITION_H
#define ZD_PARTITION_H

#include "../../point/point.h"
#include "../../point/sparse/bodies.h"

typedef struct zd_partition {
    zd_bodies *bodies;      /* C_w^T W C_w of the dependent velocities w; NULL before the first point */
    int rows;               /* number of rows of C, the first ones, that are partitioned */
    int independents;
    int is_chosen;
    int *index;             /* (independents,): indices of the independent velocities, increasing */
    unsigned char *left_out;    /* (nv,), in the order of elimination: 1 if the velocity is independent */
    double share;           /* smallest pivot of a dependent velocity relative to its diagonal entry, at the last factorization, */
    double reference;       /* and the largest of these since the selection */
    double *weight;         /* (m,): W, zero for redundant constraints */
    double *residual, *step, *b;    /* (m,), (nv,), (nv,) */
    const double *C;        /* C of the point at the factorization */
} zd_partition;

/* Allocates a partition of at most `rows` rows of C, which leave `independents` of nv velocities independent. */
zd_partition *zd_partition_create(zd_arena *arena, int nv, int rows, int independents);
/* Begins with the first `rows` rows of C, at a point whose independent constraints are known. ZD_NO_MEMORY */
int zd_partition_begin(zd_partition *self, zd_store *store, const zd_point *point, int rows);
/* Factors at the point, with the velocities selected. C is known there. */
int zd_partition_factor(zd_partition *self, zd_point *point);
/* Factors unless that is done, and selects anew if the selection is badly conditioned. */
int zd_partition_review(zd_partition *self, zd_point *point, int is_factored);
/* Adds to the dependent entries of x (nv,) so that C x = rhs (rows,). ZD_SINGULAR: the factors have too few digits. */
int zd_partition_solve(zd_partition *self, const double *rhs, double *x);

#endif
