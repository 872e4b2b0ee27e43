/* Evaluation paths: the parts of a step, by the functions that suit its state. Integrators and corrections do not know which path they are
 * on. A new path is a new file and one line in zd_path_of(), choose.h.
 */
#ifndef ZD_PATH_H
#define ZD_PATH_H

#include "../safeguards/safeguards.h"
#include "stepper.h"

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
 * independent.c: independent velocities by closed form. */
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

#endif
