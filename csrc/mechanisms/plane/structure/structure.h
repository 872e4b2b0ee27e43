/* Block structure of a mechanism in absolute coordinates, for which no dense matrix is stored. */
#ifndef ZD_PLANE_STRUCTURE_H
#define ZD_PLANE_STRUCTURE_H

#include "../../common/packed.h"
#include "lines.h"
#include "revolute_joints.h"

typedef struct zd_packing {
    zd_packed packed;
    double *weight;         /* (nv,) f of (2) due to gravity */
    zd_revolute_joints revolutes;
    zd_lines lines;
    int is_complete;           /* 1 if all rows are lines or revolute joints */
    int *is_known;          /* (m,) 1 if the row is a line's or a revolute joint's */
} zd_packing;

/* Memory for the packing of so many bodies, rows, terms of rows, and of lines at most. */
void zd_packing_create(zd_packing *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms, size_t lines);
/* Fills it in for a mechanism without tree. Returns whether there is one: not where a row touches the ground alone. */
int zd_packing_plan(zd_packing *self, const zd_plane *mechanism);

#endif
