/* What formulations in (p, v) share where a declared structure has many rows: nothing dense, and cost that follows the bodies. */
#ifndef ZD_STRUCTURED_H
#define ZD_STRUCTURED_H

#include "../constraints/rank.h"
#include "bodywise.h"
#include "schur_blocks.h"
#include "singularity_monitor.h"

typedef struct zd_structured {
    zd_schur_blocks *blocks;
    zd_bodywise *bodywise;      /* where M is singular or rows follow from others; NULL until then */
    zd_singularity_monitor *monitor;        /* beside that */
    int is_coupled;             /* which of the two was factored */
} zd_structured;

/* NULL where the system is not of this kind: see ZD_MAX_DENSE_ROWS. */
zd_structured *zd_structured_take(zd_arena *arena, const zd_system *system);
/* The leading matrix at the point; `inverts_mass`: M has to be definite. */
int zd_structured_factor(zd_structured *self, zd_point *point, int inverts_mass);
/* As the solve of formulation.h. */
void zd_structured_solve(zd_structured *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
