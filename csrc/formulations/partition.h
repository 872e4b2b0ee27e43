/* Variable partitioning (16) where a declared structure has many rows: which velocities are independent, and the others from them, at a cost
 * that follows the bodies. */
#ifndef ZD_PARTITION_H
#define ZD_PARTITION_H

#include "../point/bodies.h"
#include "../point/point.h"

typedef struct zd_partition {
    zd_bodies *bodies;      /* C_w^T W C_w: of the dependent velocities w; NULL until there is a point */
    int rows;               /* the first of C, that it is of */
    int independents;
    int is_chosen;
    int *index;             /* (independents,): which velocities these are, increasing */
    unsigned char *left_out;    /* (nv,), in the order of elimination: whether the velocity is independent */
    double share;           /* the smallest pivot of a dependent velocity, of its diagonal entry, where it was factored, */
    double reference;       /* and the largest of these since the choice */
    double *weight;         /* (m,): W, zero for rows that do not count */
    double *rest, *step, *b;    /* (m,), (nv,), (nv,) */
    const double *C;        /* of the point where it was factored */
} zd_partition;

/* Of at most so many rows of C, which leave so many of nv velocities independent. */
zd_partition *zd_partition_take(zd_arena *arena, int nv, int rows, int independents);
/* Of the first `rows` of them, at a point, where it is known which rows count. ZD_NO_MEMORY */
int zd_partition_begin(zd_partition *self, zd_store *store, const zd_point *point, int rows);
/* At the point, with the velocities that were chosen. C is known there. */
int zd_partition_factor(zd_partition *self, zd_point *point);
/* The same, where that has not been done there, and chooses anew where the present choice is badly conditioned. */
int zd_partition_review(zd_partition *self, zd_point *point, int is_factored);
/* The dependent entries of x (nv,), added to by what makes C x = rhs (rows,). ZD_SINGULAR: the factors have too few digits for it. */
int zd_partition_solve(zd_partition *self, const double *rhs, double *x);

#endif
