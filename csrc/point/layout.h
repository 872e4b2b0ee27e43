/* Layout of the packed A, M and C of a system that declares its structure; in other systems they are dense. */
#ifndef ZD_LAYOUT_H
#define ZD_LAYOUT_H

#include "../workspace.h"
#include "../zerodrift.h"

typedef struct zd_layout {
    int blocks, groups;
    int *coordinate_at, *velocity_at;   /* (blocks + 1,): offsets of each block in p, in v */
    int *A_at, *M_at;       /* (blocks + 1,): offsets of its blocks of A and M */
    int *is_diagonal;       /* (blocks,): true if only the diagonal of its M is stored */
    int *block_of;          /* (nv,): the block of each velocity */
    int *row_at, *C_at;     /* (groups + 1,): first row of each group, and offset of its entries in C */
    int *width;             /* (groups,): number of entries stored per row */
    int *group_of;          /* (m,): the group of each row of C */
    int *touched_at, *touched;  /* (groups + 1,), (touched_at[groups],): the blocks that each group touches, increasing */
    int *toucher_at;        /* (blocks + 1,): offsets of each block in the next two arrays */
    int *toucher, *toucher_offset;      /* the groups that touch a block, increasing, and the offset of its entries in their rows */
    int max_touchers;      /* largest number of groups on a block that S(W) does not split into welded parts: see weighted.c */
    int *column_at, *column;    /* (groups + 1,), (column_at[groups],): the velocities of the entries in the rows of each group */
} zd_layout;

/* Stored entries of a row of C: x (count,), for the velocities `column` (count,), which increase; column NULL: for all velocities. */
typedef struct zd_row_of_C {
    const double *x;
    int count;
    const int *column;
} zd_row_of_C;

static inline int zd_column(const zd_row_of_C *row, int j) { return row->column ? row->column[j] : j; }

/* Row k of a packed C. */
static inline zd_row_of_C zd_packed_row(const zd_layout *layout, const double *C, int k)
{
    const int g = layout->group_of[k], width = layout->width[g];
    return (zd_row_of_C){C + layout->C_at[g] + (k - layout->row_at[g]) * width, width, layout->column + layout->column_at[g]};
}

/* NULL if the system declares no structure, or while the arena only counts. */
const zd_layout *zd_layout_create(zd_arena *arena, const zd_system *system);
/* Number of stored entries of A, M or C of a system that declares its structure. */
int zd_packed_size(const zd_system *system, int term);
/* True if all blocks of M are declared to be of this kind. */
int zd_mass_is(const zd_system *system, enum zd_mass kind);
/* Number of stored entries of M, of C, of any system. */
int zd_size_of_M(const zd_system *system);
int zd_size_of_C(const zd_system *system);
/* Memory for a dense matrix of `count` doubles, if the system's own is packed. */
double *zd_create_dense(zd_arena *arena, const zd_system *system, size_t count);
/* M <- identity, stored as the system's M. */
void zd_set_identity(const zd_system *system, double *M);

#endif
