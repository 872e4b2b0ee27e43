/* What formulations in independent variables, (17), (19) and (22), are made of where a declared structure has many rows: accelerations of the
 * elimination that all share, and v = D u, p = g(q) without D. */
#ifndef ZD_PARTITION_SPARSE_H
#define ZD_PARTITION_SPARSE_H

#include "partition.h"
#include "structured.h"

typedef struct zd_partition_sparse {
    zd_structured *structured;
    zd_partition *of_v, *of_p;      /* of all rows, and of the holonomic ones: the same where there are no others */
    int size, k;            /* how many u and q there are */
    double *u;              /* (size,) */
    double *rhs, *x, *p;    /* (m,), (nv,), (nq,) */
    const double *q;        /* (k,), while p is being found */
    double rounding;        /* of Phi, in units of its size */
} zd_partition_sparse;

/* NULL where the system is not of this kind: see ZD_MAX_DENSE_ROWS. It has the system's sizes with as many constraints as count. */
zd_partition_sparse *zd_partition_sparse_take(zd_arena *arena, const zd_system *system);
/* Gives the point the v with the u that is remembered. */
int zd_partition_sparse_settle(zd_partition_sparse *self, zd_point *point);
/* The point's u, of velocities that are reviewed first. */
int zd_partition_sparse_speeds(zd_partition_sparse *self, zd_point *point, double *u);
/* With the choice as it is */
void zd_partition_sparse_express_speeds(zd_partition_sparse *self, const zd_point *point, double *u);
/* The point's q, of coordinates that are reviewed first; and where they are in p, after that. */
int zd_partition_sparse_coordinates(zd_partition_sparse *self, zd_point *point, double *q);
/* Moves the point to p = g(q) at time t, starting from where its velocity leads. (18) */
int zd_partition_sparse_place(zd_partition_sparse *self, zd_point *point, double t, const double *q);
/* Entries of x (nv,) that belong to u, to q. */
void zd_partition_sparse_pick_speeds(const zd_partition_sparse *self, const double *x, double *of_u);
void zd_partition_sparse_pick_coordinates(const zd_partition_sparse *self, const double *x, double *of_q);

#endif
