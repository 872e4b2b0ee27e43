/* Variable partitioning (16) of a declared structure with many constraints: selects independent velocities and solves for the others, at
 * a cost proportional to the number of bodies. */
#pragma once

#include "../../point/point.h"
#include "../../point/sparse/bodies.h"
#include "structured.h"

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

/* Formulations in independent variables, (17), (19) and (22), of a declared structure with many constraints: accelerations from
 * structured.h, and v = D u, p = g(q) without forming D. */

typedef struct zd_partition_sparse {
    zd_structured *structured;
    zd_partition *of_v, *of_p;      /* partition of all constraints, and of the holonomic ones: identical if there are no others */
    int size, k;            /* number of u, and of q */
    double *u;              /* (size,) */
    double *rhs, *x, *p;    /* (m,), (nv,), (nq,) */
    const double *q;        /* (k,): q during the iteration for p */
    double rounding;        /* rounding of Phi, relative to its size */
} zd_partition_sparse;

/* Returns NULL unless the system exceeds ZD_MAX_DENSE_CONSTRAINTS. It has the system's sizes with the independent constraints only. */
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
