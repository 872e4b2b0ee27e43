/* Rows of bodies that are free, but for those of pins and of laws: along each of its gauges a row is a force along a line on the second
 * body, the opposite on the first, and a torque on each, from which C is written where it is wanted. Products with C by these four numbers
 * take longer than with what is stored of it, as each row has to be put together again: they were measured, and are not here. */
#ifndef ZD_PLANE_LINES_H
#define ZD_PLANE_LINES_H

#include "revolute_joints.h"

typedef struct zd_line {    /* a gauge of a row */
    int kind, row;          /* enum zd_plane_gauge_kind; the row of C */
    int is_first;           /* of its row */
    int first, second;      /* bodies */
    int near, far;          /* where the entries of each begin in C; -1: there are none */
    int near_turns, far_turns;  /* whether the body has an angle */
    zd_vector point1, point2;
    zd_vector axis;         /* of length 1, in the first body's axes: the line's direction, where that turns */
    double zero, coefficient;
} zd_line;

typedef struct zd_lines {
    int count;
    zd_line *line;          /* (count,) those of a row together, in the order of rows */
} zd_lines;

/* The line of a term of row `row`. */
zd_line zd_line_of(const zd_plane *mechanism, int row, int term, int C, int near, int far);
/* Where want has ZD_MOVED the pulls of all lines, and Phi, C, Phi_t and xi of their rows, as far as they are wanted; C is zero before. */
void zd_lines_write(const zd_lines *self, const zd_revolute_joints *revolutes, const zd_plane *mechanism, const zd_plane_frame *frame, int want, double t,
                    const double *p, const double *v, const zd_terms *out);

#endif
