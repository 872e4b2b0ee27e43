/* Block structure and storage of C: each body is a block with a constant diagonal mass; the rows of a joint are a row group, and so is
 * each relation. */
#ifndef ZD_COMMON_PACKED_H
#define ZD_COMMON_PACKED_H

#include "planned.h"

typedef struct zd_packed {
    zd_structure structure;
    int size_of_C;          /* number of stored entries */
    int *at;                /* (m,) offset of each row in C */
    int *near, *far;        /* (terms,) offsets in the row of the entries of the first and second body; -1: the ground */
    int *coordinates, *velocities, *mass, *rows, *first, *block;    /* arrays of `structure` */
} zd_packed;

/* body <- the first and the second body of a marker quantity; 0 is the ground. */
typedef void zd_bodies_of(const void *quantities, int quantity, int body[2]);

/* Memory for so many bodies, rows and terms of rows. */
void zd_packed_create(zd_packed *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms);
/* Fills in the structure; `coordinates` and `velocities` must be set. Returns -1, or the first row that has no entries, which is an error. */
int zd_packed_plan(zd_packed *self, const zd_planned_elements *elements, int bodies, zd_bodies_of *bodies_of, const void *quantities);

#endif
