/* Evaluation paths: the parts of a step, by the functions that suit its state. Integrators and corrections do not know which path they are
 * on. A new path is a new file and one line in zd_path_of(), choose.h.
 */
#ifndef ZD_PATH_H
#define ZD_PATH_H

#include "../safeguards/safeguards.h"
#include "stepper.h"

typedef struct zd_evaluation_path {
    const char *name;
    int (*integrate)(zd_stepper *self, double h);               /* saves the start, then y from t to t + h */
    /* Moves the point to y at t1 and projects it, (25)-(27), if that is due in this step or `forced` */
    int (*project)(zd_stepper *self, double t1, int64_t step, int forced);
    int (*correct)(zd_stepper *self, int64_t step, int forced); /* other corrections at the point: energy, (29) */
    /* y to match the point, with its dependent entries; `within`: without a new choice of variables, for values within a step. NULL: y does
     * already */
    int (*finish)(zd_stepper *self, int within);
    int (*check)(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts);    /* acceptance of the step */
} zd_evaluation_path;

/* matrix.c: states that the formulation converts, by matrices and by closed form; independent.c: in independent velocities by closed form;
 * closed_form.c: (p, v) by closed form where the projection ends a step. */
extern const zd_evaluation_path zd_matrix_path, zd_converted_path, zd_independent_path, zd_closed_form_path;

/* zd_evaluation_path.check of the closed-form path by full checks, of a step from last.t to t. */
int zd_path_check_pivots(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts);

/* Moves the point to y at t1 and applies the corrections that are due in this step, or all if `forced`, to both. */
static inline int zd_path_end(const zd_evaluation_path *path, zd_stepper *self, double t1, int64_t step, int forced, int within)
{
    int status = path->project(self, t1, step, forced);
    if (!status && self->motion->others_after_step) status = path->correct(self, step, forced);
    return !status && path->finish ? path->finish(self, within) : status;
}

#endif
