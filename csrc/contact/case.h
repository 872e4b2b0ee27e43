/* One case of a problem of contacts: the state of each row, and the forces that follow. */
#pragma once

#include "problem.h"

static const double ZD_SIGN_SHARE = 1e-9;   /* share of the largest value below which a sign is rounding */

typedef struct zd_case {
    zd_contact_problem *of;
    signed char *state;     /* (rows,) */
    int *active, *column;
    int count, rank;               /* numbers of active rows, and of those that are independent */
    double *A, *x, *z, *w;
    double *e;              /* (rows,) directions of slip */
    double size;            /* largest |b| */
    int found;
    int free_forces;        /* number of unknowns of contacts that stick that are not determined */
    int free_normals;       /* number of normal forces that are not determined, which have the minimum norm */
    int slip_sign;          /* 1: sliding friction must move; -1: it may be at rest, if no other solution exists */
    int normals_depend;     /* true if normal rows depend on each other */
    double norm;            /* sum W_kk z_k^2 of the normal forces of the solution that has been found */
    int is_undetermined;    /* true if a case would be a solution, if the normal forces that bound its friction were determined */
} zd_case;

/* Estimates of unknown directions of slip, in the problem. */
void zd_case_estimate_directions(zd_case *self);
/* True if normal rows depend on each other. */
int zd_case_normals_depend(const zd_case *self);
/* z and w of the case, with its directions; 0: it has no solution. */
int zd_case_solve(zd_case *self);
/* True if sticking friction in two directions is within its bounds in some distribution of the indeterminate forces, including normal forces
 * unless sliding depends on them. z <- such a distribution. */
int zd_case_pairs_stick(zd_case *self);
int zd_case_has_pairs(const zd_case *self);
int zd_case_has_sliding_pairs(const zd_case *self);
/* True if pair i slides in an unknown direction. */
int zd_case_has_unknown_direction(const zd_case *self, int i);
int zd_case_sticks_with_another(const zd_case *self, int i);
/* Bound of static friction of a row, with those of the rows that stick with it. */
double zd_case_total_bound(const zd_case *self, int i);
