/* Where the entries of A, M and C are stored, of a system that declares its structure; of others all of these are dense. */
#ifndef ZD_LAYOUT_H
#define ZD_LAYOUT_H

#include "../workspace.h"
#include "../zerodrift.h"

typedef struct zd_layout {
    int blocks, groups;
    int *coordinate_at, *velocity_at;   /* (blocks + 1,): where the entries of each block begin in p, in v */
    int *A_at, *M_at;       /* (blocks + 1,): where its matrices begin */
    int *is_diagonal;       /* (blocks,): whether of M only the diagonal is stored */
    int *block_of;          /* (nv,): the block of each velocity */
    int *row_at, *C_at;     /* (groups + 1,): where the rows of each group begin, and its matrix */
    int *width;             /* (groups,): how many entries are stored of each of its rows */
    int *group_of;          /* (m,): the group of each row */
    int *touched_at, *touched;  /* (groups + 1,), (touched_at[groups],): the blocks that each group touches, increasing */
    int *toucher_at;        /* (blocks + 1,): where in the next two the groups that touch a block begin */
    int *toucher, *toucher_offset;      /* these groups, increasing, and where in their rows the entries for that block begin */
    int most_touchers;      /* of a block that S(W) takes as one: see weighted.c */
    int *column_at, *column;    /* (groups + 1,), (column_at[groups],): the velocities that the entries of its rows belong to */
} zd_layout;

/* What is stored of a row of C: `count` entries x, of the velocities `column`, which increase, or of all where that is NULL. */
typedef struct zd_row_of_C {
    const double *x;
    int count;
    const int *column;
} zd_row_of_C;

static inline int zd_column(const zd_row_of_C *row, int j) { return row->column ? row->column[j] : j; }

/* Row k of entries C that are stored as the layout says. */
static inline zd_row_of_C zd_packed_row(const zd_layout *layout, const double *C, int k)
{
    const int g = layout->group_of[k], width = layout->width[g];
    return (zd_row_of_C){C + layout->C_at[g] + (k - layout->row_at[g]) * width, width, layout->column + layout->column_at[g]};
}

/* NULL where the system declares no structure, and while counting. */
const zd_layout *zd_layout_take(zd_arena *arena, const zd_system *system);
/* How many entries are stored, packed, of A, M or C of a system that declares its structure. */
int zd_packed_size(const zd_system *system, int term);
/* Whether all of M is declared so. */
int zd_mass_is(const zd_system *system, enum zd_mass kind);
/* How many are stored of M, of C, of any system. */
int zd_size_of_M(const zd_system *system);
int zd_size_of_C(const zd_system *system);
/* Memory for as many doubles of a dense matrix, where the system's own is packed. */
double *zd_take_dense(zd_arena *arena, const zd_system *system, size_t count);
/* Makes M, stored as the system's is, the identity. */
void zd_set_identity(const zd_system *system, double *M);

#endif
