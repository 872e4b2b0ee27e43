/* The orthogonal complement D of the constraint matrix, C D = 0, and what goes with it:
 *
 *     v = D u + particular(-Phi_t)        (14)
 *     vdot = D udot + gamma               (15)
 *
 * By variable partitioning, (16): u are r = nv - m of the velocities, w the others, C = [U W], D = [I; -W^-1 U]. A system that
 * brings its own D (and gamma) is asked for them instead; then u is what its D makes of it.
 */
#ifndef ZD_COMPLEMENT_H
#define ZD_COMPLEMENT_H

#include "../point/point.h"

typedef struct zd_complement {
    int n, m, r;
    int brought;        /* whether the system brings D */
    int own;            /* whether it is used: where all rows of C count as they are */
    int chosen;         /* whether u has been */
    int *order;         /* (n,): indices of w in v, then of u */
    int *pivots;        /* (n,) */
    int room;           /* columns of D that there is memory for: as many as where all rows count, until fewer do */
    double *memory;     /* (m, n): of C, where the system's own is packed */
    const double *C;    /* (m, n): the rows that count */
    double *D;          /* (n, r) */
    double *K;          /* factored: W (m, m), or for an own D: [C; D^T] (n, n) */
    double *gram;       /* (r, r): Cholesky factor of D^T D, for an own D */
    double *work;       /* (2, n) */
    double *choice;     /* (m, n): where u is chosen */
    double largest;     /* entry of W^-1 U in natural units: how well the partition is conditioned here */
    double reference;   /* the same where it was chosen; 0: just chosen */
} zd_complement;

/* `workspace` (m, n) serves while D is not known at the point, and anything else at other times. */
zd_complement zd_complement_take(zd_arena *arena, const zd_system *system, double *workspace);
/* Memory (m, n) and (m, m) that is free as long as it is not known which rows count. */
void zd_complement_lend(const zd_complement *self, double **Q, double **G);
/* D and K at the point, once for each (t, p). */
int zd_complement_at(zd_complement *self, zd_point *point);
/* Takes these velocities (r,) for u, until they are badly conditioned. */
void zd_complement_prefer(zd_complement *self, const int *independent);
/* The largest entry of W^-1 U, in natural units, that u is kept up to; 0: it is not known, or u is no part of v. */
double zd_complement_steepest(const zd_complement *self);
/* Chooses u anew where the present choice is badly conditioned at the point, and counts that. */
int zd_complement_review(zd_complement *self, zd_point *point);
/* x with C x = rhs */
void zd_complement_particular(const zd_complement *self, const double *rhs, double *x);
/* lambda with C^T lambda = reaction */
void zd_complement_multipliers(const zd_complement *self, const double *reaction, double *lambda);
/* v of u at the point, (14) */
int zd_complement_velocity(zd_complement *self, zd_point *point, const double *u, double *v);
/* u of the point's v */
int zd_complement_speeds(const zd_complement *self, zd_point *point, double *u);
/* The entries of x (n,) that u are of v */
void zd_complement_pick(const zd_complement *self, const double *x, double *of_u);
/* udot of the point's vdot, (15) */
int zd_complement_rate(zd_complement *self, zd_point *point, double *udot);
/* b <- D^T b (r,), x <- x + D u */
void zd_complement_project(const zd_complement *self, const double *b, double *projected);
void zd_complement_add(const zd_complement *self, const double *u, double *x);
/* D^T M D (r, r) */
void zd_complement_mass(const zd_complement *self, const double *M, double *Mu);

#endif
