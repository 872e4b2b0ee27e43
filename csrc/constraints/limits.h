/* At a bifurcation: rows that are lost there are replaced by their limits along the motion. */
#ifndef ZD_LIMITS_H
#define ZD_LIMITS_H

#include "rank.h"

struct zd_limits {
    double *distance;   /* (lost,): of path, in natural units, from the bifurcation */
    double speed;       /* in natural units, by which rates are taken */
    double t, *p, *v;   /* (nq,), (n,): where that is */
    double *pdot, *moved;       /* (nq,), (nq,) */
    double *Cdot, *xidot;       /* (m, n), (m,) */
    double *T, *K_rate;         /* (m, independent): of C_d and of wdot, what they have along the rows that count */
    double *w, *wdot;           /* (m, n): and what besides, in natural units */
    int is_at_rest;             /* whether the point is */
    double *e, *x, *force;      /* (n,) each: from rest, its acceleration, the next one, f - d */
    double *K, *y;              /* (n + m, n + m), (n + m,) */
    int *order;                 /* (n + m,) */
};

/* Puts limits for the rows that are lost at the point among those that count, if there are such limits. Their memory is taken when they are
 * first wanted. */
int zd_limits_find(zd_point *point);

/* What stands for the lost rows in a right side (m,) for all rows: of xi, of Phi, of Psi, or of -Phi_t. */
enum zd_limit { ZD_LIMIT_XI, ZD_LIMIT_PHI, ZD_LIMIT_PSI, ZD_LIMIT_ENFORCED };
int zd_limits_replace_lost(zd_point *point, enum zd_limit what, double *rhs);
static inline int zd_limits_replace(zd_point *point, enum zd_limit what, double *rhs)
{
    return point->rank->lost ? zd_limits_replace_lost(point, what, rhs) : ZD_DONE;
}

#endif
