/* The one Newton loop: of the position correction and of implicit steps. */
#ifndef ZD_NEWTON_H
#define ZD_NEWTON_H

typedef struct zd_newton {
    int (*residual)(void *context, double *size);   /* how far the unknown is from the solution, now */
    int (*improve)(void *context);                  /* moves the unknown closer */
    double tolerance;
    int max_iterations;
    double contraction;     /* the first improvement has to leave no more than this part; 0: any */
    int (*retreat)(void *context);  /* goes back half of the last improvement; NULL: improvements are believed */
    double nearly;                  /* a residual up to this is solved once an improvement no longer halves it: rounding is left; 0: never */
} zd_newton;

/* Returns 0 with the number of iterations and the last residual; ZD_NO_CONVERGENCE; ZD_NOT_FINITE; or what a function
 * returned. */
int zd_newton_solve(const zd_newton *newton, void *context, int *iterations, double *residual);

#endif
