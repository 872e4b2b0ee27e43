/* Constraint rows between free bodies, except those of revolute joints and of user functions. Along each of its marker quantities, a row
 * is a force along a line on the second body, the opposite force on the first, and a torque on each; C is written from these four numbers
 * when it is wanted. Products with C use the stored entries, as forming each row anew was measured to take longer. */
#ifndef ZD_PLANE_LINES_H
#define ZD_PLANE_LINES_H

#include "revolute_joints.h"

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

#endif
