/* Conditions of an assembly: constraints and targets, their residuals and rows in scaled coordinates, and displacements that meet them. */
#ifndef ZD_ASSEMBLY_CONDITIONS_H
#define ZD_ASSEMBLY_CONDITIONS_H

#include "../../../linalg/row_space.h"
#include "given.h"

#define ZD_SMALLEST_SIZE 1e-3   /* relative to the largest constraint and the length: lower bound of a constraint's size */

/* Set of roles of targets, as bits */
enum { ZD_HELD = 1 << ZD_TARGET_HELD, ZD_STAYING = 1 << ZD_TARGET_STAYS, ZD_WISHED = 1 << ZD_TARGET_WISHED, ZD_ROLE_SETS = 8 };

typedef struct zd_assembly {
    const zd_assembly_given *given;
    const zd_system *system;
    void *block;            /* memory of all arrays */
    int n, m, most, widest; /* velocities; constraints; constraints and targets; components of a measure, at most */
    int status;             /* first failure of the system */
    zd_terms terms;
    double *at_rest, *measures, *value, *jacobian;  /* (n,) zeros; scratch of measures; (widest,) and (widest, n) of one measure */
    double *target;         /* (targets,): values, of those that stay once they are known */
    double *scale, *weight; /* (n,): coordinates are in rad and parts of the length; square root of their mass metric */
    double *size[ZD_ROLE_SETS];     /* (most,) of the conditions, by the set of roles, fixed where it is first evaluated */
    int is_known[ZD_ROLE_SETS];
    int rows;
    double *C;              /* (m, n) */
    double *r, *J, *start;  /* (most,), (most, n) residuals and rows of the chosen conditions; residuals that are shifted away */
    int *of;                /* (most,): condition of each row, a constraint, or m + a target */
    zd_row_space required, wished;
    double *right, *x, *moved, *step;           /* (most,), (n,), (n,), (n,) of a displacement */
    double *tried, *polished, *led, *begun, *found, *as_drawn, *drawn;      /* (nq,): positions used by these steps */
    double *square, *factors;                   /* (k, k), (k, k + 2) with the smaller k of most and n */
} zd_assembly;

enum zd_assembly_choice { ZD_OF_ALL, ZD_OF_DRAWING, ZD_OF_JOINTS };

/* Selection of conditions, and the share of the residuals in `start` that is still allowed */
typedef struct zd_conditions {
    enum zd_assembly_choice choice;
    int roles;
    double left;
} zd_conditions;

/* An assembly with its memory, and with the mass metric at p; returns ZD_NO_MEMORY without it. */
int zd_assembly_open(zd_assembly *self, const zd_assembly_given *given, const double *p);
int zd_assembly_close(zd_assembly *self, int outcome);      /* releases the memory; returns the outcome, or how the system failed */
int zd_assembly_has(const zd_assembly *self, enum zd_target_role role, int is_rate);
/* Values at p of targets of positions that stay */
void zd_assembly_keep(zd_assembly *self, const double *p);
/* r and J of the conditions at p, by their sizes; returns the largest |r|, infinite if the system fails. */
double zd_assembly_find(zd_assembly *self, const zd_conditions *of, const double *p);
/* Largest |Phi| of the constraints that are not left out */
double zd_assembly_gap(zd_assembly *self, const double *p);
/* r and J (not by sizes) of all conditions on velocities */
void zd_assembly_find_rates(zd_assembly *self, int roles, const double *p);
double zd_assembly_length_of(const zd_assembly *self, int row);
void zd_assembly_divide_row(zd_assembly *self, int row, double by);
/* Factor that preserves the length of a row when it is divided by weights */
double zd_assembly_unit_of(const zd_assembly *self, int row, const double *weight);
int zd_assembly_is_joint(const zd_assembly *self, int row);     /* row: of r and J */
/* x (n,) <- minimum-norm solution, in the norm of weight * x, of J x = right for the first `required` rows, least squares where they
 * contradict each other; among these, least squares of the other rows. weight NULL: ones */
void zd_assembly_solve(zd_assembly *self, int required, const double *right, const double *weight, double *x);
/* to <- p + step, with the step shortened so that no scaled coordinate moves by more than `longest` */
void zd_assembly_move(zd_assembly *self, const double *p, double longest, double *step, double *to);

#endif
