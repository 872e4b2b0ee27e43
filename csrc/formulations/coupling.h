/* C M^-1 C^T of (13), where M is block-diagonal and each row of C touches few of its blocks. */
#ifndef ZD_COUPLING_H
#define ZD_COUPLING_H

#include "../point/point.h"

typedef struct zd_coupling {
    int n, m;
    double *L;              /* stored as M is: its Cholesky factors */
    double *D;              /* (n,): their diagonal, in reciprocals */
    double *Y;              /* stored as C is: C L^-T */
    double *S;              /* (m, m): factored */
    double *y, *z;          /* (n,), (n,) */
    double *lambda;         /* (m,) */
    double *rest, *step;    /* (m,), (m,): what is left of C x = rhs, and the multipliers that remove it */
    const zd_layout *layout;    /* of the point where it was factored, as its C */
    const double *C;
} zd_coupling;

/* NULL where the system declares no structure, or not all of its rows are to count. */
zd_coupling *zd_coupling_take(zd_arena *arena, const zd_system *system);
/* All rows count at the point. ZD_DEPENDENT_ROWS: to the precision of C M^-1 C^T, as it is here. */
int zd_coupling_factor(zd_coupling *self, zd_point *point);
/* As the solve of formulation.h. */
void zd_coupling_solve(zd_coupling *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
