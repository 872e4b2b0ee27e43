/* Formulations in independent velocities, (17), (19) and (22): the matrix D^T M D, and v = D u. */
#pragma once

#include "complement.h"
#include "formulation.h"
#include "sparse/partition.h"

typedef struct zd_minimal {
    zd_partition_sparse *many;       /* replaces all that follows for a declared structure with many constraints */
    zd_complement complement;
    double *memory;     /* (n, n): dense M, if the system's own is packed */
    const double *M;    /* (n, n): the point's */
    double *Mu;         /* (r, r): Cholesky factor of D^T M D */
    int size;           /* number of u in the state */
    double *u;          /* (size,): u of the state */
    double *b;          /* (n,) */
    double *du;         /* (n,) */
    double lead_time;   /* s: time from the point's last acceleration to the present; 0: unknown */
} zd_minimal;

/* `workspace` (m, n): see zd_complement_create(). */
zd_minimal zd_minimal_create(zd_arena *arena, const zd_system *system, double *workspace);
/* For a declared structure with many constraints. */
zd_minimal zd_minimal_create_many(zd_arena *arena, const zd_system *system);
int zd_minimal_factor(void *self, zd_point *point);
void zd_minimal_solve(void *self, const double *force, const double *rhs, double *x, double *lambda);
/* Records, before the point moves to time t, the time since its acceleration: used where u alone does not determine v. */
void zd_minimal_note_lead_time(zd_minimal *self, const zd_point *point, double t);
/* Stores u, and sets v of the point from it. */
int zd_minimal_unpack(zd_minimal *self, zd_point *point, const double *u);
/* u of the point, after a review of the independent velocities; and without. */
int zd_minimal_pack(zd_minimal *self, zd_point *point, double *u);
int zd_minimal_express(zd_minimal *self, zd_point *point, double *u);
/* udot of the point's vdot, (15) */
int zd_minimal_rate(zd_minimal *self, zd_point *point, double *udot);
int zd_minimal_update(void *self, zd_point *point);
/* T (positions + size, nq + nv): its first rows hold the dp of each coordinate of the state and get their dv; the rows of u follow.
 * Psi_along: see tangents_of_v(). */
int zd_minimal_tangents(zd_minimal *self, zd_point *point, const double *Psi_along, int positions, double *T);
/* True if a system's u are entries of v; and, once they have been selected, their indices. */
int zd_minimal_may_have_entries(const zd_system *system);
int zd_minimal_entries(const void *self, zd_entries *entries);
