/* The orthogonal complement D of the constraint matrix, C D = 0, with
 *
 *     v = D u + particular(-Phi_t)        (14)
 *     vdot = D udot + gamma               (15)
 *
 * By variable partitioning, (16): u are r = nv - m of the velocities, w the others, C = [U W], D = [I; -W^-1 U]. If the system provides
 * its own D (and gamma), these are used instead, and its D defines u.
 */
#pragma once

#include "../point/point.h"

typedef struct zd_complement {
    int n, m, r;
    int is_provided;        /* 1: the system provides D */
    int own;            /* 1: it is used, as all constraints are independent */
    int chosen;         /* 1: u has been selected */
    int *order;         /* (n,): indices of w in v, then of u */
    int *pivots;        /* (n,) */
    double *memory;     /* (m, n): dense C, if the system's own is packed */
    const double *C;    /* (m, n): independent rows of C */
    double *D;          /* (n, r) */
    double *K;          /* factors of W (m, m), or for the system's own D of [C; D^T] (n, n) */
    double *gram;       /* (r, r): Cholesky factor of D^T D, for the system's own D */
    double *work;       /* (2, n) */
    double *choice;     /* (m, n): work space of the selection of u */
    double largest;     /* largest entry of W^-1 U, characteristic scales: the condition of the partition here */
    double reference;   /* the same when it was selected; 0: just selected */
} zd_complement;

/* `workspace` (m, n): used only while D is not known at the point. */
zd_complement zd_complement_create(zd_arena *arena, const zd_system *system, double *workspace);
/* Computes D and K at the point, once for each (t, p). */
int zd_complement_at(zd_complement *self, zd_point *point);
/* Selects these velocities (r,) as u, until they are badly conditioned. */
void zd_complement_prefer(zd_complement *self, const int *independent);
/* Largest entry of W^-1 U, characteristic scales, for which u is kept; 0: unknown, or u are not entries of v. */
double zd_complement_steepest(const zd_complement *self);
/* Selects u anew if the selection is badly conditioned at the point, and counts that. */
int zd_complement_review(zd_complement *self, zd_point *point);
/* x with C x = rhs */
void zd_complement_particular(const zd_complement *self, const double *rhs, double *x);
/* lambda with C^T lambda = reaction */
void zd_complement_multipliers(const zd_complement *self, const double *reaction, double *lambda);
/* v of u at the point, (14) */
int zd_complement_velocity(zd_complement *self, zd_point *point, const double *u, double *v);
/* u of the point's v */
int zd_complement_speeds(const zd_complement *self, zd_point *point, double *u);
/* Entries of x (n,) at the indices of u. */
void zd_complement_pick(const zd_complement *self, const double *x, double *of_u);
/* udot of the point's vdot, (15) */
int zd_complement_rate(zd_complement *self, zd_point *point, double *udot);
/* b <- D^T b (r,), x <- x + D u */
void zd_complement_project(const zd_complement *self, const double *b, double *projected);
void zd_complement_add(const zd_complement *self, const double *u, double *x);
/* D^T M D (r, r) */
void zd_complement_mass(const zd_complement *self, const double *M, double *Mu);
