/* Displacements that meet conditions: with dense matrices, or with sparse ones for mechanisms of many bodies. */
#ifndef ZD_ASSEMBLY_SOLVER_H
#define ZD_ASSEMBLY_SOLVER_H

#include "../../../workspace.h"

struct zd_assembly;

typedef struct zd_assembly_solver {
    void *(*create)(zd_arena *arena, const struct zd_assembly *of);   /* its memory: self->solver_data; may be NULL */
    /* As zd_assembly_solve() */
    void (*solve)(struct zd_assembly *self, int required, const double *right, const double *weight, double *x);
    /* Prepares damped steps; returns the unit of their damping: about the largest eigenvalue of J J^T, at least 1. */
    double (*prepare)(struct zd_assembly *self);
    /* self->step <- -J^T (J J^T + mu)^-1 r = -(J^T J + mu)^-1 J^T r; returns whether that can be computed. */
    int (*damp)(struct zd_assembly *self, double mu);
} zd_assembly_solver;

extern const zd_assembly_solver zd_assembly_dense, zd_assembly_sparse;

#endif
