/* Which bodies each row of C touches, and where its entries are stored: bodies are the blocks, with a constant diagonal mass; the rows of a
 * joint, and each relation, are a group. */
#ifndef ZD_COMMON_PACKED_H
#define ZD_COMMON_PACKED_H

#include "planned.h"

typedef struct zd_packed {
    zd_structure structure;
    int size_of_C;          /* entries that are stored */
    int *at;                /* (m,) where each row begins in C */
    int *near, *far;        /* (terms,) where in a row the entries of its first and second body begin; -1: it is the ground */
    int *coordinates, *velocities, *mass, *rows, *first, *block;    /* those of the structure */
} zd_packed;

/* body[0] and body[1] <- those that a gauge is read off; 0 is the ground. */
typedef void zd_bodies_of(const void *gauges, int gauge, int body[2]);

/* Memory for so many bodies, rows and terms of rows. */
void zd_packed_take(zd_packed *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms);
/* Fills it in, where `coordinates` and `velocities` are there. Returns -1, or a row that touches the ground alone,
 * of which there must be none. */
int zd_packed_plan(zd_packed *self, const zd_planned_elements *elements, int bodies, zd_bodies_of *bodies_of, const void *gauges);

#endif
