/* Contacts that touch at an instant, with their friction, as candidates of one small problem: contact/problem.h. */
#pragma once

#include "../contact/equations.h"
#include "../contact/problem.h"
#include "phases.h"

enum { ZD_MAX_TOUCHING = 256 };     /* candidates at one instant, of which ZD_MAX_CANDIDATES may be coupled */

typedef struct zd_contacts {
    zd_run *run;
    zd_phases *phases;
    int count, normals;     /* candidates: normal rows, then friction */
    int group[ZD_MAX_TOUCHING];
    int component[ZD_MAX_TOUCHING];   /* row of the group */
    double sign[ZD_MAX_TOUCHING];
    zd_candidate row[ZD_MAX_TOUCHING];
    signed char state[ZD_MAX_TOUCHING];
    int tie[ZD_MAX_TOUCHING];
    double factor[ZD_MAX_TOUCHING];
    double direction[ZD_MAX_TOUCHING];    /* component of the unit vector of slip of a pair */
    double slip_error[ZD_MAX_TOUCHING];   /* m/s: slip that counts as zero where it has just reversed */
    int has_reversed;       /* true if a slip in two directions has */
    int free_forces, free_normals;      /* numbers of forces that are not determined: of contacts that stick, and normal ones */
    int part[ZD_MAX_TOUCHING], parts;       /* number of the part of coupled candidates, and of all parts; -1: blocked */
    double gap[ZD_MAX_TOUCHING];
    double w[ZD_MAX_TOUCHING], b[ZD_MAX_TOUCHING], z[ZD_MAX_TOUCHING], after[ZD_MAX_TOUCHING];
    double omitted[ZD_MAX_TOUCHING];      /* m/s: speed that a bounce would have after an impact slower than the rest speed */
    double *g, *x;          /* (count, nv) */
    double *W, *scratch, *zero, *net;       /* (count, count); of the problem; (m,); (2 nv,) */
    int is_blocked[ZD_MAX_TOUCHING];        /* true if constraints prevent all motion along the candidate's direction */
    signed char *next;      /* (groups,) */
    int is_changed;         /* true if an impulse has changed velocities */
    signed char ends[ZD_MAX_TOUCHING];    /* state that a row must enter whose margin became zero at this instant; ZD_OPEN: any */
    void *memory;
} zd_contacts;

/* Lists the contacts that touch, and their friction; `next` is without them. */
int zd_contacts_find(zd_contacts *self, int is_start);
/* Bounds of friction by loads, as they are now. */
int zd_contacts_find_loads(zd_contacts *self);
int zd_contacts_allocate(zd_contacts *self);
/* g at the state phases->at. */
int zd_contacts_find_rows(zd_contacts *self);
/* g, x and W in the phase without the candidates, which is the present one. */
int zd_contacts_find_answers(zd_contacts *self);
void zd_contacts_find_velocities(zd_contacts *self);
/* v <- v + x z */
void zd_contacts_apply(zd_contacts *self, const double *z);
/* Parts of the candidates, by W. */
void zd_contacts_find_parts(zd_contacts *self);
/* Solves the problems of the first rows with b; `what` is their name in messages. */
int zd_contacts_solve(zd_contacts *self, int rows, const char *what);
/* z (count,) <- impulses of the closed and sticking contacts for changes -w (count,) of their velocities. */
int zd_contacts_find_correction(const zd_contacts *self, const double *w, double *z);
/* Enters the phase `next`. */
int zd_contacts_enter(zd_contacts *self);
/* Row of the constraints of the full system that a candidate is. */
static inline int zd_candidate_row(const zd_contacts *self, int k)
{
    return self->phases->full->group[self->group[k]].first + self->component[k];
}
static inline const zd_group *zd_candidate_group(const zd_contacts *self, int k) { return self->phases->full->group + self->group[k]; }
/* Normal velocity, m/s or rad/s, below which a contact that is pressed together stays closed */
static inline double zd_rest_speed(const zd_contacts *self, int k)
{
    return 1e-6 * zd_group_scale(self->phases, zd_candidate_group(self, k));
}

/* Velocity that is rounding, relative to the rest speed */
static const double ZD_STILL = 1e-3;

/* Gap of a start or of a joint, relative to the characteristic length, beyond which it is an error */
static const double ZD_PENETRATION = 1e-9;
