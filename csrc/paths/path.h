/* Evaluation paths: the parts of a step, by the functions that suit its state. Integrators and corrections do not know which path they are
 * on. A new path is a new file and one line in zd_path_of(), choose.h.
 */
#pragma once

#include "../motion/motion.h"
#include "../safeguards/safeguards.h"
#include "../state/stepper.h"

typedef struct zd_evaluation_path {
    const char *name;
    int is_closed_form;     /* true if the matrix path remains for a step that fails */
    int (*integrate)(zd_stepper *self, double h);               /* saves the start, then y from t to t + h */
    /* Moves the point to y at t1 and projects it, (25)-(27), if that is due in this step or `forced` */
    int (*project)(zd_stepper *self, double t1, int64_t step, int forced);
    int (*correct)(zd_stepper *self, int64_t step, int forced); /* other corrections at the point: energy, (29) */
    /* y to match the point, with its dependent entries; `within`: without a new choice of variables, for values within a step. NULL: y does
     * already */
    int (*finish)(zd_stepper *self, int within);
    int (*check)(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts);    /* acceptance of the step */
} zd_evaluation_path;

/* matrix.c: by matrices. closed_form.c: (p, v) by closed form, where the projection ends a step; converted.c: where a step has more parts.
 * embedded_rate.c: independent velocities by closed form. */
extern const zd_evaluation_path zd_matrix_path, zd_converted_path, zd_independent_path, zd_closed_form_path;

/* matrix.c: parts of steps whose state the formulation converts. The second moves the point to the state y at t1. */
int zd_path_integrate(zd_stepper *self, double h);
int zd_path_unpack(zd_stepper *self, double t1);
int zd_path_correct(zd_stepper *self, int64_t step, int forced);
int zd_path_finish(zd_stepper *self, int within);
/* converted.c: the projection by closed-form functions, if it is due in this step or `forced`. */
int zd_project_in_closed_form(zd_motion *motion, int64_t step, int forced);
/* choose.c: zd_evaluation_path.check by full checks of the pivots, of a step from last.t to t. */
int zd_path_check_pivots(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts);

/* True if the system has closed-form functions for the formulation; if one of them projects and computes the acceleration at the end of a
 * step. */
static inline int zd_has_closed_form(const zd_motion *motion) { return motion->path.closed_form != NULL; }
static inline int zd_finishes_in_closed_form(const zd_motion *motion) { return motion->path.finishes; }
/* True if a function of the system failed for good: a closed-form function that fails is replaced by the matrix path, and terms may be
 * finite at other states. */
static inline int zd_callable_failed(const zd_motion *motion, int status)
{
    return status == ZD_CALLBACK && !motion->path.order && !motion->point->left_domain;
}

/* Moves the point to y at t1 and applies the corrections that are due in this step, or all if `forced`, to both. */
static inline int zd_path_end(const zd_evaluation_path *path, zd_stepper *self, double t1, int64_t step, int forced, int within)
{
    int status = path->project(self, t1, step, forced);
    if (!status && self->motion->others_after_step) status = path->correct(self, step, forced);
    return !status && path->finish ? path->finish(self, within) : status;
}

/* Steps on the closed-form path that end with the projection and, optionally, the energy correction: they work on the state alone. */

extern const zd_equations zd_equations_in_closed_form;      /* rates of states (p, v) */

/* vdot and lambda at the point from `evaluate`, with the terms that corrections add to the right side of (6); NULL: none. */
int zd_closed_form_accelerate(zd_motion *motion, int (*evaluate)(zd_motion *motion, const double *added));
/* Projects p and v at the end t of a step, and computes the point's acceleration there, if path.lands. p and v are the point's own, or the
 * caller copies them there. */
int zd_closed_form_finish(zd_motion *motion, double t, double *p, double *v);
/* True if the stepper's state can stay at the end of the step while the point is moved within it. */
static inline int zd_plain_may_stay(const zd_stepper *stepper)
{
    return stepper->motion->path.is_plain && (stepper->motion->point->known & ZD_ACCELERATED);
}
/* Projects a state y within an accepted step and moves the point there; saves and restores accelerations at the end of the step. */
int zd_plain_project_within(zd_stepper *stepper, double t, double *y);
void zd_plain_save_rates(const zd_stepper *stepper, zd_cached_accelerations *rates);
void zd_plain_return_to_end(zd_stepper *stepper, double t, zd_cached_accelerations *rates);

/* Closed-form path of formulations in independent velocities: embed.c */

extern const zd_equations zd_equations_of_independent;      /* embedded_rate.c */

/* Allocates the fields of the path that only these formulations need. */
void zd_embed_create(zd_path *path, zd_arena *arena, const zd_system *system);
/* The elimination order whose dependent velocities are those not in the state, which it saves in the path; NULL: there is none. */
const zd_elimination *zd_embed_find(zd_motion *motion);
/* Sets the tolerance of Phi for a step that begins at the point. */
void zd_embed_begin(zd_motion *motion);
/* True if, at the point, an entry of D exceeds the bound up to which the formulation keeps its independent velocities. */
int zd_embed_is_steep(const zd_motion *motion);
/* The acceleration at the point, with the terms `added` to the right side of (6) */
int zd_embed_accelerate(zd_motion *motion, const double *added);
/* Counterparts of a formulation's unpack(), pack() and update(), for a step that begins or ends at the point. */
int zd_embed_unpack(zd_motion *motion, double t, const double *y);
int zd_embed_pack(zd_motion *motion, double *y);
int zd_embed_update(zd_motion *motion);
/* p and v of the path from the state; entries that the state does not have are estimates. */
void zd_embed_read(zd_motion *motion, double t, const double *y);
/* y <- the independent entries of p and v, or of their rates */
void zd_embed_write(const zd_motion *motion, const double *p, const double *v, double *y);

typedef struct zd_embedded {    /* outputs of an evaluation; D, lambda, power and pivots are NULL if not requested */
    double *D, *pdot, *vdot, *lambda, *power, *pivots;
} zd_embedded;
/* Dependent entries of the path's v and, with finds_p, of its p, from the independent ones; with them the requested outputs. */
int zd_embed_entries(zd_motion *motion, double t, int finds_p, const double *added, const zd_embedded *to);
