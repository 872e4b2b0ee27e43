/* Small systems of equations whose unknowns may not all be determined. */
#pragma once

/* Solves A x = x, (n, n), by complete pivoting, with zero for unknowns that are not determined; 0 if the equations are inconsistent. Entry k
 * of the solution belongs to `column` k; *rank: number of independent equations. A is overwritten by its factors. */
int zd_equations_eliminate(int n, double *A, double *x, int *column, int *rank);
/* Null vectors (n - rank, n) of A, which is overwritten; returns their number. */
int zd_equations_null_space(int n, double *A, double *null);
/* x <- solution of A x = x, (n, n), n at most ZD_MAX_CANDIDATES, with zero for unknowns that are not determined; 0 if the equations are
 * inconsistent. A is overwritten. */
int zd_equations_solve(int n, double *A, double *x);
