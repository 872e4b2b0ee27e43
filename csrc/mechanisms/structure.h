/* Which bodies each row of C touches: the structure of a mechanism in absolute coordinates, where nothing dense is stored. */
#ifndef ZD_MECHANISM_STRUCTURE_H
#define ZD_MECHANISM_STRUCTURE_H

#include "../workspace.h"
#include "pins.h"

typedef struct zd_packing {
    zd_structure structure;
    int size_of_C;          /* entries that are stored */
    double *weight;         /* (nv,) f of (2), where nothing else acts */
    int *row;               /* (m,) where each row begins in C */
    int *near, *far;        /* (terms,) where in a row the entries of its first and second body begin; -1: it is the ground */
    zd_pins pins;
    int *is_of_pin;         /* (m,) whether a row is of one of these */
    int *coordinates, *mass, *rows, *first, *block;     /* those of the structure */
} zd_packing;

/* Memory for the packing of so many bodies, rows and terms of rows. */
void zd_packing_take(zd_packing *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms);
/* Fills it in for a mechanism without tree. Returns whether there is one: not where a row touches the ground alone. */
int zd_packing_plan(zd_packing *self, const zd_mechanism *mechanism);

#endif
