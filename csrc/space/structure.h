/* Which bodies each row of C touches, and where its entries are stored. */
#ifndef ZD_SPACE_STRUCTURE_H
#define ZD_SPACE_STRUCTURE_H

#include "../workspace.h"
#include "plan.h"

typedef struct zd_packing3 {
    zd_structure structure;
    int size_of_C;          /* entries that are stored */
    int *at;                /* (m,) where each row begins in C */
    int *near, *far;        /* (terms,) where in a row the entries of its first and second body begin; -1: it is the ground */
    int *coordinates, *velocities, *mass, *rows, *first, *block;    /* those of the structure */
} zd_packing3;

/* Memory for the packing of so many bodies, rows and terms of rows. */
void zd_packing3_take(zd_packing3 *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms);
/* Fills it in. Returns -1, or a row that touches the ground alone, of which there must be none. */
int zd_packing3_plan(zd_packing3 *self, const zd_space *space);

#endif
