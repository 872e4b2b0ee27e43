/* Elimination for formulations in (p, v) of a declared structure with many constraints: no dense matrices, cost proportional to the
 * number of bodies. */
#ifndef ZD_STRUCTURED_H
#define ZD_STRUCTURED_H

#include "../../constraints/rank.h"
#include "bodywise.h"
#include "schur_blocks.h"
#include "singularity_monitor.h"

typedef struct zd_structured {
    zd_schur_blocks *blocks;
    zd_bodywise *bodywise;      /* used if M is singular or constraints are redundant; NULL until then */
    zd_singularity_monitor *monitor;        /* distance to a bifurcation in that case */
    int is_coupled;             /* 1: blocks were factored; 0: bodywise */
} zd_structured;

/* Returns NULL unless the system exceeds ZD_MAX_DENSE_ROWS. */
zd_structured *zd_structured_create(zd_arena *arena, const zd_system *system);
/* Factors the leading matrix at the point; `inverts_mass`: M must be positive definite. */
int zd_structured_factor(zd_structured *self, zd_point *point, int inverts_mass);
/* solve() of formulation.h. */
void zd_structured_solve(zd_structured *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
