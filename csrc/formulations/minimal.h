/* What the formulations in independent velocities, (17), (19) and (22), share: the matrix D^T M D, and v = D u. */
#ifndef ZD_MINIMAL_H
#define ZD_MINIMAL_H

#include "complement.h"
#include "formulation.h"
#include "partition_sparse.h"

typedef struct zd_minimal {
    zd_partition_sparse *many;       /* in place of all that follows, where a declared structure has many rows */
    zd_complement complement;
    double *memory;     /* (n, n): of M, where the system's own is packed */
    const double *M;    /* (n, n): the point's */
    double *Mu;         /* (r, r): Cholesky factor of D^T M D */
    int room;           /* rows of it that there is memory for */
    int size;           /* of the u in the state */
    double *u;          /* (size,): that */
    double *b;          /* (n,) */
    double *du;         /* (n,) */
    double lead_time;   /* s: from where the point's acceleration was computed to where it is wanted; 0: it is not known */
} zd_minimal;

/* `workspace` (m, n) as the complement's. */
zd_minimal zd_minimal_take(zd_arena *arena, const zd_system *system, double *workspace);
/* Where a declared structure has many rows. */
zd_minimal zd_minimal_take_many(zd_arena *arena, const zd_system *system);
void zd_minimal_lend(void *self, double **Q, double **G);
int zd_minimal_factor(void *self, zd_point *point);
void zd_minimal_solve(void *self, const double *force, const double *rhs, double *x, double *lambda);
/* Notes, before the point moves to time t, how far ahead of its acceleration that is: this serves where u alone does not determine v. */
void zd_minimal_note_lead_time(zd_minimal *self, const zd_point *point, double t);
/* Remembers u, and gives the point the v that belongs to it. */
int zd_minimal_enter(zd_minimal *self, zd_point *point, const double *u);
/* The point's u, once the choice of independent velocities has been reviewed; and with the choice as it is. */
int zd_minimal_leave(zd_minimal *self, zd_point *point, double *u);
int zd_minimal_express(zd_minimal *self, zd_point *point, double *u);
/* udot of the point's vdot, (15) */
int zd_minimal_rate(zd_minimal *self, zd_point *point, double *udot);
int zd_minimal_settle(void *self, zd_point *point);
/* T (positions + size, nq + nv), whose first rows have the dp of each coordinate of the state: their dv, and the rows of u. Psi_p as
 * tangents() has it. */
int zd_minimal_tangents(zd_minimal *self, zd_point *point, const double *Psi_p, int positions, double *T);
/* Whether a system's velocities u are entries of v, and, where they have been chosen, which. */
int zd_minimal_may_have_entries(const zd_system *system);
int zd_minimal_entries(const void *self, zd_entries *entries);

#endif
