/* Constraints and prescribed quantities at a state, with their derivatives with respect to velocities as the rows of one matrix, factored.
 *
 * The order of rows is that of right-hand sides: holonomic constraints, prescribed quantities, nonholonomic constraints. Rows that are
 * redundant, and the last ones, are not solved but compared.
 */
#pragma once

#include "../linalg/dense.h"
#include "../motion/derivatives.h"
#include "../point/point.h"

typedef struct zd_prescribed_rows {
    const zd_prescribed_motion *motion;
    zd_point *point;        /* the state of the rows */
    int positions, rows;    /* numbers of rows without the nonholonomic ones, and of all */
    double *unit;           /* (rows, nv): rows in scaled velocities, times `inverse_length` */
    double *inverse_length; /* (rows,): 1 / their norms, but at most those of a share of the largest */
    double *value, *bias;   /* (quantities,): values, and second derivatives minus row vdot, of prescribed quantities */
    zd_row_space space;     /* factors of the first `positions` rows; its pivot is 0 where they do not determine the positions */
    double *right, *y;      /* (rows,), (nv,): right-hand side, and its solution in scaled velocities */
    zd_measured values, biases;         /* results for all components of measures: values and jacobians; biases, in the memory of values */
    double *scratch;        /* work array of measures */
    zd_residual_state residuals;    /* for second derivatives of coordinates */
    double *rates;          /* (2, nq) temporary */
} zd_prescribed_rows;

zd_prescribed_rows zd_prescribed_rows_create(zd_arena *arena, const zd_prescribed_motion *motion);
/* Moves to (t, p), and evaluates and factors the rows there. */
int zd_prescribed_rows_factor(zd_prescribed_rows *self, double t, const double *p);
/* Evaluates the biases at velocities v. */
int zd_prescribed_rows_move(zd_prescribed_rows *self, const double *v);
/* x (nv,) <- solution of rows x = right, which is scaled as the rows. */
void zd_prescribed_rows_solve(zd_prescribed_rows *self, double *x);
/* The largest residual, in scaled velocities, of the redundant ones among the first `rows` rows, and of nonholonomic constraints. */
double zd_prescribed_rows_residual(const zd_prescribed_rows *self, int rows);
