/* Limits of constraints at a bifurcation, along the motion. */
#pragma once

#include "rank.h"

struct zd_limits {
    double *distance;   /* (lost,): path length to the bifurcation, characteristic scales */
    double speed;       /* 1/s: path length per time, the unit of the rates below */
    double t, *p, *v;   /* time, position (nq,) and velocity (n,) at which the rates were taken */
    double *pdot, *moved;       /* (nq,), (nq,) */
    double *Cdot, *xidot;       /* (m, n), (m,) */
    double *T, *K_rate;         /* (m, independent): components of C_d and wdot along the independent constraints */
    double *w, *wdot;           /* (m, n): their remainders, in characteristic scales */
    int is_at_rest;             /* 1: the point is at rest */
    double *e, *x, *force;      /* (n,) each: acceleration from rest, its next iterate, f - d */
    double *K, *y;              /* (n + m, n + m), (n + m,) */
    int *order;                 /* (n + m,) */
};

zd_limits *zd_limits_create(zd_arena *arena, const zd_system *system);
/* Replaces the constraints lost at the point by their limits, if these exist. */
int zd_limits_find(zd_point *point);

/* Sum of the entries of y of the independent constraints, with these shares. */
static inline double zd_limits_along_others(const zd_selection *self, const double *share, const double *y, int stride)
{
    double sum = 0;
    for (int a = 0; a < self->independent; a++) sum += share[a] * y[self->row[a] * stride];
    return sum;
}

/* y_d - T y_r, for an array y with one entry per constraint. */
static inline double zd_limits_own_part(const zd_selection *self, int row, const double *y, int stride)
{
    return y[row * stride] - zd_limits_along_others(self, self->limits->T + row * self->m, y, stride);
}

/* limits_sides.c: right-hand side (m,) of all constraints, in which lost ones get the entry of their limit: xi, Phi, Psi or -Phi_t. */
enum zd_limit { ZD_LIMIT_XI, ZD_LIMIT_PHI, ZD_LIMIT_PSI, ZD_LIMIT_ENFORCED };
int zd_limits_replace_lost(zd_point *point, enum zd_limit what, double *rhs);
static inline int zd_limits_replace(zd_point *point, enum zd_limit what, double *rhs)
{
    return point->rank->lost ? zd_limits_replace_lost(point, what, rhs) : ZD_DONE;
}
