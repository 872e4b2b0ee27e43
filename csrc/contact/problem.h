/* Contacts at one instant: which of them press, stick or slide, from a small matrix. */
#pragma once

#include "phase_system.h"

enum { ZD_MAX_CANDIDATES = 24 };

/* A row of the problem: its impulse or force z, and its velocity or acceleration w = W z + b. */
typedef struct zd_candidate {
    int normal;             /* -1: a normal row, z >= 0, w >= 0, one of them zero. Otherwise friction: 1 + index of the normal row whose z
                             * bounds it, 0: the bound is fixed */
    double bound[2];        /* static and sliding: coefficients, or fixed bounds */
    signed char slides;     /* ZD_OPEN: all is possible; otherwise friction slides in this state, and a normal row is open, whatever w is */
} zd_candidate;

typedef struct zd_contact_problem {
    int rows;
    const zd_candidate *row;    /* (rows,) normal rows before the friction that they bound */
    const double *W, *b;    /* (rows, rows), (rows,) */
    int opens;              /* true if a row has just let go: of equal solutions, that in which most are open */
    signed char *state;     /* (rows,) result, as of groups */
    int *tie;               /* (rows,) result: an earlier row of friction that is parallel; -1: none */
    double *factor;         /* (rows,) result: length of such a row in units of that one */
    double *z, *w;          /* (rows,) result */
    double *scratch;        /* (zd_problem_scratch(rows),) */
} zd_contact_problem;

size_t zd_problem_scratch(int rows);
/* Number of solutions that differ in w, at most 2, of which the first is returned: that in which most press and stick, unless `opens`. Where
 * static friction
 * exceeds sliding, what can stick sticks. -1: there are too many cases. */
int zd_problem_solve(zd_contact_problem *self);
/* x <- solution of A x = x, (n, n), n at most ZD_MAX_CANDIDATES, with zero for what is not determined; 0 if the equations contradict each
 * other. A is overwritten. */
int zd_problem_equations(int n, double *A, double *x);
