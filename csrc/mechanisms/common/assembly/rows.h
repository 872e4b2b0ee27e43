/* State of an assembly, and rows of its conditions: constraints and targets in scaled coordinates. */
#ifndef ZD_ASSEMBLY_ROWS_H
#define ZD_ASSEMBLY_ROWS_H

#include "../../../linalg/sparse/minimum_norm.h"
#include "../../../point/layout.h"
#include "given.h"
#include "solver.h"

/* Set of roles of targets, as bits */
enum { ZD_HELD = 1 << ZD_TARGET_HELD, ZD_STAYING = 1 << ZD_TARGET_STAYS, ZD_WISHED = 1 << ZD_TARGET_WISHED,
       ZD_DRAWN = 1 << ZD_TARGET_DRAWN, ZD_ROLE_SETS = 16 };

typedef struct zd_assembly {
    const zd_assembly_given *given;
    const zd_system *system;
    void *block;            /* memory of all arrays */
    const zd_assembly_solver *solver;
    void *solver_data;
    const zd_layout *layout;    /* stored entries of many bodies; NULL: dense matrices */
    int n, m, most, widest; /* velocities; constraints; constraints and targets; components of a measure, at most */
    int status;             /* first failure of the system */
    double work;            /* estimated number of operations since the last check for an interruption */
    zd_terms terms;
    double *at_rest, *measures, *value, *jacobian;  /* (n,) zeros; scratch of measures; (widest,) and (widest, n) of one measure */
    int *which, *at, *column;   /* (targets, 2) both: measures and components of many bodies, and where the velocities of their bodies begin;
                                 * (targets, 2 width): columns of their rows */
    double *target;         /* (targets,): values, of those that stay once they are known */
    double *scale, *weight; /* (n,): coordinates are in rad and parts of the length; square root of their mass metric */
    const double *metric;   /* (n,) weight of Newton steps; NULL: ones, as long chains would bend strongly in few links otherwise */
    double *size[ZD_ROLE_SETS];     /* (most,) of the conditions, by the set of roles, fixed where it is first evaluated */
    int is_known[ZD_ROLE_SETS];
    int rows;
    double *C;              /* (m, n), or as it is stored, for many bodies */
    double *r, *start;      /* (most,) residuals of the chosen conditions; residuals that are shifted away */
    zd_sparse_row *J;       /* (most,) their rows, */
    double *entries;        /* (most, n), or (size_of_C,) and the rows of all targets: all entries of these */
    int size_of_C;
    int *of;                /* (most,): condition of each row, a constraint, or m + a target */
    double *right, *x, *moved, *step;           /* (most,), (n,), (n,), (n,) of a displacement */
    double *tried, *polished, *led, *begun, *found, *as_drawn, *drawn;      /* (nq,): positions used by these steps */
} zd_assembly;

/* Row of a condition, its entries at `entries`; returns these */
static inline double *zd_assembly_begin_row(zd_assembly *self, int of, double *entries, int count, const int *column)
{
    self->of[self->rows] = of;
    self->J[self->rows++] = (zd_sparse_row){entries, count, column};
    return entries;
}

double zd_assembly_row_times(const zd_assembly *self, int row, const double *x);
double zd_assembly_length_of(const zd_assembly *self, int row);
void zd_assembly_divide_row(zd_assembly *self, int row, double by);
/* Factor that preserves the length of a row when it is divided by weights */
double zd_assembly_unit_of(const zd_assembly *self, int row, const double *weight);
int zd_assembly_is_joint(const zd_assembly *self, int row);     /* row: of r and J */
int zd_assembly_has(const zd_assembly *self, enum zd_target_role role, int is_rate);

#endif
