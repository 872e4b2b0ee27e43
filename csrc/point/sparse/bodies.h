/* Matrices with one block row per body of a system that declares its structure: M + C^T W C. */
#pragma once

#include "../../linalg/sparse/blocks.h"
#include "../point.h"

typedef struct zd_bodies {
    const zd_layout *layout;
    zd_blocks *blocks;
    int is_triangular;      /* true if it is factored as in triangular.c */
    int *at;                /* (blocks of M,) offset of the velocities of each body in a right-hand side */
    int *pair;              /* offset of the block C_a^T W C_b in S, for each group and each pair b <= a of its bodies */
} zd_bodies;

/* Symbolic factorization, and memory for the factors; NULL without memory. `order`: see ordering.c. */
zd_bodies *zd_bodies_create(zd_store *store, const zd_system *system, const zd_layout *layout, const int *order);
/* Adds blocks that are stored as M is. */
void zd_bodies_add_mass(zd_bodies *self, const double *M);
/* Adds C^T W C; W (m,) */
void zd_bodies_add_rows(zd_bodies *self, const double *C, const double *W);
/* Factors the matrix as in triangular.c, accurate for any ratio of W to M. Returns the first velocity with a pivot that is not positive, or
 * -1. */
int zd_bodies_factor(zd_bodies *self);
/* As zd_blocks_factor(). */
zd_pivots zd_bodies_leave_out(zd_bodies *self, unsigned char *left_out, double least);
/* x (nv,) <- the inverse times b, by these factors */
void zd_bodies_solve(zd_bodies *self, const double *b, double *x);
/* Index of the velocity at this position in the order of elimination. */
int zd_bodies_velocity(const zd_bodies *self, int place);
