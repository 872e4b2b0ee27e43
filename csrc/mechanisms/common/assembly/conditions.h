/* Conditions of an assembly: constraints and targets, their residuals and rows in scaled coordinates, and displacements that meet them. */
#ifndef ZD_ASSEMBLY_CONDITIONS_H
#define ZD_ASSEMBLY_CONDITIONS_H

#include "rows.h"

#define ZD_SMALLEST_SIZE 1e-3   /* relative to the largest constraint and the length: lower bound of a constraint's size */

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

#endif
