/* Matrices whose block rows are the bodies of a system that declares its structure: C^T W C, and what has blocks where M has. */
#ifndef ZD_BODIES_H
#define ZD_BODIES_H

#include "../linalg/blocks.h"
#include "layout.h"

typedef struct zd_bodies {
    const zd_layout *layout;
    zd_blocks *blocks;
    int is_triangular;      /* whether its factors are those of triangular.h */
    int *at;                /* (blocks of M,) where the velocities of each body stand in a right side */
    int *pair;              /* for each group, its bodies and those of these before it or it itself: the block that takes their product */
} zd_bodies;

/* All that is symbolic, and memory for the factors; NULL where there is none. `order`: see ordering.h. */
zd_bodies *zd_bodies_create(zd_store *store, const zd_system *system, const zd_layout *layout, const int *order);
/* Adds blocks that are stored as M is. */
void zd_bodies_add_mass(zd_bodies *self, const double *M);
/* Adds C^T W C; W (m,) */
void zd_bodies_add_rows(zd_bodies *self, const double *C, const double *W);
/* Into factors that keep their digits however far apart W and M are. Returns the first velocity whose pivot is not positive, or -1. */
int zd_bodies_factor(zd_bodies *self);
/* As zd_blocks_factor(). */
zd_pivots zd_bodies_leave_out(zd_bodies *self, unsigned char *left_out, double least);
/* x (nv,) <- that inverse, by its factors, times b */
void zd_bodies_solve(zd_bodies *self, const double *b, double *x);
/* Which velocity has this place in the order of elimination. */
int zd_bodies_velocity(const zd_bodies *self, int place);

#endif
