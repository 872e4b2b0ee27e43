/* Products with packed C, a group of rows at a time: what all of its bodies contribute is added up while it is in registers. */
#ifndef ZD_ROW_GROUPS_H
#define ZD_ROW_GROUPS_H

#include "layout.h"

typedef struct zd_row_group {   /* the rows of a group */
    int kernel;             /* 0: there is none for these sizes */
    int C, rows, width;     /* where they begin in C, how many, and how many entries each has */
    int row, y;             /* the first, of C; and where they begin in a vector in the order of S */
    int x[2], W[2];         /* with a kernel: where the velocities of its bodies begin, and their parts of a diagonal W */
    int column;             /* where the velocities of its entries begin in those of the layout */
} zd_row_group;

typedef struct zd_row_groups {
    int count;
    zd_row_group *group;
    const int *column;      /* those of the layout */
    int rows, *place;       /* (rows,) where each row of C is in the order of S */
    int are_pairs;          /* whether each group has two */
} zd_row_groups;

/* `y` (groups,): where the rows of each begin in the order of S. */
zd_row_groups zd_row_groups_take(zd_arena *arena, const zd_layout *layout, const int *y);
/* y <- C x - rhs, in the order of S; x or rhs (m,) NULL: zero. */
void zd_row_groups_times(const zd_row_groups *self, const double *C, const double *x, const double *rhs, double *y);
/* x <- x - C^T y */
void zd_row_groups_subtract_transposed(const zd_row_groups *self, const double *C, const double *y, double *x);
/* x <- x - W C^T y, W all in its diagonal */
void zd_row_groups_subtract_weighted(const zd_row_groups *self, const double *C, const double *W, const double *y, double *x);
/* y <- a - b, of a, b (m,) in the order of C; a NULL: zero */
void zd_row_groups_gather(const zd_row_groups *self, const double *a, const double *b, double *y);
/* rows (m,) <- y, in the order of C */
void zd_row_groups_scatter(const zd_row_groups *self, const double *y, double *rows);

#endif
