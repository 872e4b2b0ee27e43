/* Newton's iteration, and iterative refinement. */
#pragma once

#include <math.h>

#include "../zerodrift.h"
#include "small.h"

/* Newton iteration, for the position correction and for implicit steps. */

typedef struct zd_newton {
    int (*residual)(void *context, double *size);   /* *size <- norm of the residual at the present iterate */
    int (*improve)(void *context);                  /* adds a Newton correction to the iterate */
    double tolerance;       /* tolerance of the residual norm */
    int max_iterations;
    double contraction;     /* the first iteration must reduce the residual to this fraction; 0: not checked */
    int (*retreat)(void *context);  /* takes back half of the last correction; NULL: corrections are not shortened */
    double nearly;          /* a residual up to this is accepted once an iteration does not halve it, as it is rounding; 0: never */
} zd_newton;

/* Returns 0 with the number of iterations and the last residual; ZD_NO_CONVERGENCE; ZD_NOT_FINITE; or the status of a function. */
int zd_newton_solve(const zd_newton *newton, void *context, int *iterations, double *residual);

/* The decision after so many iterations that have left this residual: ZD_DONE for another one, ZD_NO_CONVERGENCE or ZD_NOT_FINITE.
 * *first: the residual before the first. */
ZD_INLINE int zd_newton_goes_on(int iterations, int max_iterations, double contraction, double residual, double *first)
{
    if (!isfinite(residual)) return ZD_NOT_FINITE;
    if (iterations == max_iterations) return ZD_NO_CONVERGENCE;
    if (iterations == 0) *first = residual;
    return iterations == 1 && contraction > 0 && !(residual <= contraction * *first) ? ZD_NO_CONVERGENCE : ZD_DONE;
}

/* Limits of iterative refinement, x <- x + solve(rhs - C x). */

#define ZD_RESIDUAL_ROUNDING (8 * 0x1p-52)  /* residual relative to the terms of C x that needs no refinement */
#define ZD_GOOD_PIVOT 0x1p-10               /* pivot relative to the diagonal of C M^-1 C^T above which few digits are lost */
#define ZD_UNEQUAL_SHARES 0x1p6             /* largest ratio of the contributions of two bodies to one entry of that diagonal */
enum { ZD_MAX_REFINEMENTS = 40 };
