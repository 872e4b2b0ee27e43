/* Products with packed C, one group of rows at a time: the contributions of its bodies are summed in registers. */
#pragma once

#include "../point.h"

typedef struct zd_row_group {   /* the rows of a group */
    int kernel;             /* compiled kernel for these sizes; 0: none */
    int C, rows, width;     /* offset of its entries in C; number of rows; stored entries per row */
    int row, y;             /* its first row of C; offset of its rows in a vector in the order of S */
    int x[2], W[2];         /* with a kernel: offsets of its bodies in v, and in a diagonal W */
    int column;             /* offset of the velocities of its entries in `column` of the layout */
} zd_row_group;

typedef struct zd_row_groups {
    int count;
    zd_row_group *group;
    const int *column;      /* `column` of the layout */
    int rows, *place;       /* (rows,) position of each row of C in the order of S */
    int are_pairs;          /* true if each group has two rows */
} zd_row_groups;

/* `y` (groups,): offset of the rows of each in the order of S. */
zd_row_groups zd_row_groups_create(zd_arena *arena, const zd_layout *layout, const int *y);
/* y <- C x - rhs, in the order of S; x or rhs (m,) NULL: zero. */
void zd_row_groups_times(const zd_row_groups *self, const double *C, const double *x, const double *rhs, double *y);
/* x <- x - W C^T y, W diagonal; NULL: the identity */
void zd_row_groups_subtract(const zd_row_groups *self, const double *C, const double *W, const double *y, double *x);
/* y <- a - b, of a, b (m,) in the order of C; a NULL: zero */
void zd_row_groups_gather(const zd_row_groups *self, const double *a, const double *b, double *y);
/* rows (m,) <- y, in the order of C */
void zd_row_groups_scatter(const zd_row_groups *self, const double *y, double *rows);
