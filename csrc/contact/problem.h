/* Contacts at one instant: which of them are closed, stick or slide, from a small matrix. */
#pragma once

#include "phase_system.h"

enum { ZD_MAX_CANDIDATES = 24 };

/* A row of the problem: its impulse or force z, and its velocity or acceleration w = W z + b. */
typedef struct zd_candidate {
    int normal;             /* -1: a normal row, z >= 0, w >= 0, one of them zero. Otherwise friction: 1 + index of the normal row whose z
                             * bounds it, 0: the bound is fixed */
    double bound[2];        /* static and sliding: coefficients, or fixed bounds */
    signed char slides;     /* ZD_OPEN: any state; otherwise friction slides in this state, and a normal row is open, whatever w is */
    signed char pair;       /* 1, 2: first and second row of friction in two directions; 0: it has one row */
    signed char is_unknown; /* 1: a pair that slides in an unknown direction */
} zd_candidate;

typedef struct zd_contact_problem {
    int rows;
    const zd_candidate *row;    /* (rows,) normal rows before the friction that they bound */
    const double *W, *b;    /* (rows, rows), (rows,) */
    int is_min_norm;        /* true if dependent normal rows are closed, too, with forces of minimum norm */
    int opens;              /* true if a row has just opened: of equal solutions, the one with most rows open is returned */
    signed char *state;     /* (rows,) result, as of groups */
    int *tie;               /* (rows,) result: an earlier row of friction that is parallel; -1: none */
    double *factor;         /* (rows,) result: length of such a row in units of that one, negative if it is opposite */
    double *z, *w;          /* (rows,) result */
    double *direction;      /* (rows,) of pairs, unit vectors of slip: given ones or first estimates, 0 0: none; and the result */
    int free_forces;        /* result: number of unknowns of contacts that stick that are not determined */
    int free_normals;       /* result: number of normal forces that are not determined */
    double *scratch;        /* (zd_problem_scratch(rows),) */
} zd_contact_problem;

size_t zd_problem_scratch(int rows);
/* Number of solutions that differ in w, at most 2. The first is returned: the one with most contacts closed and sticking, unless `opens`.
 * Where static friction exceeds sliding friction, sticking is preferred. -1: too many cases; -2: forces that bound friction are not
 * determined. */
int zd_problem_solve(zd_contact_problem *self);
