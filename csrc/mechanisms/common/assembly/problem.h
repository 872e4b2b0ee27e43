/* Assembly as a numerical problem: residuals and their rows, conditions, solvers, iterations. */
#pragma once

#include "../../../linalg/sparse/equations.h"
#include "../../../point/point.h"
#include "../../../workspace.h"
#include "given.h"

/* Displacements that meet conditions: with dense matrices, or with sparse ones for mechanisms of many bodies. */

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

/* State of an assembly, and rows of its conditions: constraints and targets in scaled coordinates. */

/* Set of roles of targets, as bits */
enum { ZD_HELD = 1 << ZD_TARGET_HELD, ZD_STAYING = 1 << ZD_TARGET_STAYS, ZD_WISHED = 1 << ZD_TARGET_WISHED,
       ZD_DRAWN = 1 << ZD_TARGET_DRAWN, ZD_ROLE_SETS = 16 };

typedef struct zd_assembly {
    const zd_assembly_problem *given;
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

/* Conditions of an assembly: constraints and targets, their residuals and rows in scaled coordinates, and displacements that meet them. */

#define ZD_SMALLEST_SIZE 1e-3   /* relative to the largest constraint and the length: lower bound of a constraint's size */

enum zd_assembly_choice { ZD_OF_ALL, ZD_OF_DRAWING, ZD_OF_JOINTS };

/* Selection of conditions, and the share of the residuals in `start` that is still allowed */
typedef struct zd_conditions {
    enum zd_assembly_choice choice;
    int roles;
    double left;
} zd_conditions;

/* An assembly with its memory, and with the mass metric at p; returns ZD_NO_MEMORY without it. */
int zd_assembly_open(zd_assembly *self, const zd_assembly_problem *given, const double *p);
int zd_assembly_close(zd_assembly *self, int outcome);      /* releases the memory; returns the outcome, or how the system failed */
/* r and J of the conditions at p, by their sizes; returns the largest |r|, infinite if the system fails. */
double zd_assembly_find(zd_assembly *self, const zd_conditions *of, const double *p);
/* Largest |Phi| of the constraints that are not left out */
double zd_assembly_gap(zd_assembly *self, const double *p);
/* r and J (not by sizes) of all conditions on velocities */
void zd_assembly_find_rates(zd_assembly *self, int roles, const double *p);
/* x (n,) <- minimum-norm solution, in the norm of weight * x, of J x = right for the first `required` rows, least squares where they
 * contradict each other; among these, least squares of the other rows. weight NULL: ones */
static inline void zd_assembly_solve(zd_assembly *self, int required, const double *right, const double *weight, double *x)
{
    self->solver->solve(self, required, right, weight, x);
}
/* to <- p + step, with the step shortened so that no scaled coordinate moves by more than `longest` */
void zd_assembly_move(zd_assembly *self, const double *p, double longest, double *step, double *to);

/* Rows of targets: measures of the start. */

/* Residuals and rows (not scaled) of the targets of these roles at p, of positions or of velocities, after those that there are */
void zd_assembly_add_targets(zd_assembly *self, int roles, int is_rate, const double *p);
/* Values at p of targets of positions that stay */
void zd_assembly_save(zd_assembly *self, const double *p);

/* Iterations of an assembly: Newton's method, least squares, continuation, and the nearest positions. Each changes p (nq,). */

#define ZD_CLOSED 1e-12         /* relative to the size of a constraint: largest residual of a closed joint */

/* Minimum-norm Newton steps until the residual stops decreasing; returns whether the conditions are met. */
int zd_assembly_newton(zd_assembly *self, const zd_conditions *of, double *p);
/* The Levenberg-Marquardt method, completed by Newton steps; returns the largest residual that remains. */
double zd_assembly_least_squares(zd_assembly *self, const zd_conditions *of, double *p);
/* Positions nearest to self->drawn on the branch of p, which meets the conditions, by the Gauss-Newton method */
void zd_assembly_approach_drawing(zd_assembly *self, const zd_conditions *of, double *p);
/* Leads drives, couplings and targets from where they are to where they must be in small steps on one branch; returns whether they arrive.
 * Otherwise p is where they were led. */
int zd_assembly_track(zd_assembly *self, int roles, double *p);
/* Approaches the targets of the roles `wished` as nearly as all constraints and the targets of the roles `required` allow. */
void zd_assembly_approach(zd_assembly *self, int required, int wished, double *p);
/* Perturbs p slightly, with closed joints if possible. */
void zd_assembly_perturb(zd_assembly *self, double *p);
