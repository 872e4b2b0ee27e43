/* Formulations in independent variables, (17), (19) and (22), of a declared structure with many constraints: accelerations from
 * structured.h, and v = D u, p = g(q) without forming D. */
#ifndef ZD_PARTITION_SPARSE_H
#define ZD_PARTITION_SPARSE_H

#include "partition.h"
#include "structured.h"

typedef struct zd_partition_sparse {
    zd_structured *structured;
    zd_partition *of_v, *of_p;      /* partition of all constraints, and of the holonomic ones: identical if there are no others */
    int size, k;            /* number of u, and of q */
    double *u;              /* (size,) */
    double *rhs, *x, *p;    /* (m,), (nv,), (nq,) */
    const double *q;        /* (k,): q during the iteration for p */
    double rounding;        /* rounding of Phi, relative to its size */
} zd_partition_sparse;

/* Returns NULL unless the system exceeds ZD_MAX_DENSE_ROWS. It has the system's sizes with the independent constraints only. */
zd_partition_sparse *zd_partition_sparse_create(zd_arena *arena, const zd_system *system);
/* Sets v of the point from the stored u. */
int zd_partition_sparse_update(zd_partition_sparse *self, zd_point *point);
/* u of the point, after a review of the independent velocities. */
int zd_partition_sparse_speeds(zd_partition_sparse *self, zd_point *point, double *u);
/* u of the point, without a review. */
void zd_partition_sparse_express_speeds(zd_partition_sparse *self, const zd_point *point, double *u);
/* q of the point, after a review of the independent coordinates. */
int zd_partition_sparse_coordinates(zd_partition_sparse *self, zd_point *point, double *q);
/* Moves the point to p = g(q) at time t, starting from the prediction by its velocity. (18) */
int zd_partition_sparse_place(zd_partition_sparse *self, zd_point *point, double t, const double *q);
/* Entries of x (nv,) at the indices of u, of q. */
void zd_partition_sparse_pick_speeds(const zd_partition_sparse *self, const double *x, double *of_u);
void zd_partition_sparse_pick_coordinates(const zd_partition_sparse *self, const double *x, double *of_q);

#endif
