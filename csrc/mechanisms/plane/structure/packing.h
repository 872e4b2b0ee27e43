/* Block structure of a planar mechanism in absolute coordinates: rows of revolute joints, of lines, and their products. */
#pragma once

#include "../../common/planned.h"
#include "../plan.h"

/* Revolute joints between free bodies: two rows for the coincidence of a point of one body and a point of another. They are written from
 * the vectors from mass centres to these points alone, so that products with C do not need its stored entries. */

/* The data are split into three arrays: most loops read one or two of them, and large mechanisms are bound by memory bandwidth. */
typedef struct zd_revolute_bodies {
    int first, second;      /* bodies */
    int row;                /* index of the first of its two rows */
} zd_revolute_bodies;

typedef struct zd_points {
    zd_vector first, second;    /* in the axes of each body */
} zd_points;

typedef struct zd_revolute_joint {
    zd_vector zero;         /* vector from the first point to the second at Phi = 0 */
    int C, width;           /* offset of the first row in C, and length of each row */
    int near, far;          /* offsets of the bodies' entries in a row; -1: the body is the ground */
    int near_turns, far_turns;  /* 1 if the body has an angle */
} zd_revolute_joint;

typedef struct zd_revolute_joints {
    int count;
    zd_revolute_bodies *between; /* (count,), as the next two: bodies, points and rows of each joint */
    zd_points *points;
    zd_revolute_joint *joint;
    int *end_at;            /* (bodies + 2,): offsets of each body's joints in `end` */
    int *end;               /* (2 count,): 2 * joint, plus 1 where the body is its second */
    int are_all;            /* 1 if there are no other rows */
    int have_angles;        /* 1 if all bodies have three coordinates */
} zd_revolute_joints;

/* True if `row` and the next are the x and y coincidence of the same two points, without further terms: a revolute joint. */
int zd_is_revolute_joint_at(const zd_plane *mechanism, int row);
/* frame->arm and frame->axis, from the sines and cosines. */
void zd_revolute_joints_turn(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame);
/* Phi, C and xi of all revolute joints, as far as wanted. */
void zd_revolute_joints_write(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame, int want,
                              const double *p,
                               const double *v, const zd_terms *out);

/* x (nv,) with three entries for each body: x itself if all bodies have three coordinates, otherwise a copy in `to`. */
const double *zd_revolute_joints_expand(const zd_revolute_joints *self, const zd_plane_tree *tree, const double *x, double *to);
/* Entries of body i; zeros for the ground. */
static inline const double *zd_of_body(const double *spread, int i)
{
    static const double of_ground[3] = {0, 0, 0};
    return i ? spread + 3 * (i - 1) : of_ground;
}

/* Constraint rows between free bodies, except those of revolute joints and of user functions. Along each of its marker quantities, a row
 * is a force along a line on the second body, the opposite force on the first, and a torque on each; C is written from these four numbers
 * when it is wanted. Products with C use the stored entries, as forming each row anew was measured to take longer. */

typedef struct zd_line {    /* a marker quantity of a row */
    int kind, row;          /* enum zd_plane_quantity_kind; the row of C */
    int is_first;           /* 1 if it is the first line of its row */
    int first, second;      /* bodies */
    int near, far;          /* offsets of the bodies' entries in C; -1: none */
    int near_turns, far_turns;  /* 1 if the body has an angle */
    zd_vector point1, point2;
    zd_vector axis;         /* direction of the line, unit vector in the first body's axes, for kinds with a direction */
    double zero, coefficient;
} zd_line;

typedef struct zd_lines {
    int count;
    zd_line *line;          /* (count,) those of a row together, in the order of rows */
} zd_lines;

/* The line of a term of row `row`. */
zd_line zd_line_of(const zd_plane *mechanism, int row, int term, int C, int near, int far);
/* Writes Phi, C, Phi_t and xi of the lines' rows, as far as wanted, and, if want has ZD_MOVED, the pulls of all lines; C must be zero
 * before. */
void zd_lines_write(const zd_lines *self, const zd_revolute_joints *revolutes, const zd_plane *mechanism, const zd_plane_frame *frame,
                    int want, double t,
                    const double *p, const double *v, const zd_terms *out);

/* Products with C of mechanisms whose constraints are all revolute joints: C is not stored for them. */

extern const zd_operations zd_plane_products;

/* Block structure of a mechanism in absolute coordinates, for which no dense matrix is stored. */

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
