/* Evaluation paths: the parts of a step, by matrices or in closed form. Integrators, corrections and outputs do not know which path they are
 * on. A new path is a new file and one line in zd_path_of().
 *
 * On either path the state may be (p, v) or in independent velocities: zd_equations.unpack and finish convert it. In closed form a state
 * (p, v) with pdot = v that the projection alone corrects is integrated, projected and checked in place, with loops of known length:
 * zd_path.is_plain, a branch of each function in closed_form.c. Converted and checked as other states, a step of the four-bar takes 32 %
 * more instructions.
 */
#pragma once

#include "../linalg/iteration.h"
#include "../motion/motion.h"
#include "../safeguards/safeguards.h"
#include "../state/stepper.h"

typedef struct zd_evaluation_path {
    int (*integrate)(zd_stepper *self, double h);               /* saves the start, then y from t to t + h */
    /* Moves the point to y at t1 and projects it, (25)-(27), if that is due in this step or `forced` */
    int (*project)(zd_stepper *self, double t1, int64_t step, int forced);
    int (*correct)(zd_stepper *self, int64_t step, int forced); /* other corrections at the point: energy, (29) */
    /* y to match the point, with its dependent entries; `within`: without a new choice of variables, for values within a step.
     * ZD_NOT_FINITE if they are not */
    int (*finish)(zd_stepper *self, int within);
    /* Finishes the step and accepts it, or not. */
    int (*check)(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts);
} zd_evaluation_path;

extern const zd_evaluation_path zd_matrix_path, zd_closed_form_path;    /* matrix.c, closed_form.c */

/* The path of the current step */
static inline const zd_evaluation_path *zd_path_of(const zd_motion *motion)
{
    return motion->path.order < 0 ? &zd_matrix_path : &zd_closed_form_path;
}

/* Moves the point to y at t and applies all corrections to both: at the end of a step, or `within` one. */
static inline int zd_path_end(zd_stepper *self, double t, int within)
{
    const zd_evaluation_path *path = zd_path_of(self->motion);
    int status = path->project(self, t, 0, 1);
    if (!status && self->motion->others_after_step) status = path->correct(self, 0, 1);
    return status ? status : path->finish(self, within);
}

/* matrix.c: parts of a step on either path, of a state that is converted. */
int zd_path_integrate(zd_stepper *self, double h);
int zd_path_unpack(zd_stepper *self, double t1);    /* moves the point to the state y at t1 */
int zd_path_finish(zd_stepper *self, int within);

/* True if the system has closed-form functions for the formulation; if one of them projects and computes the acceleration at the end of a
 * step. */
static inline int zd_has_closed_form(const zd_motion *motion) { return motion->path.closed_form != NULL; }
static inline int zd_finishes_in_closed_form(const zd_motion *motion) { return motion->path.finishes; }
/* True if a function of the system failed for good: a closed-form function that fails is replaced by the matrix path, and terms may be
 * finite at other states. */
static inline int zd_callable_failed(const zd_motion *motion, int status)
{
    return status == ZD_CALLBACK && motion->path.order < 0 && !motion->point->left_domain;
}

/* ---- choice of the path of a step, and its end compared with its start in closed form: path.c ---- */

/* create.c: closed-form functions for a single trajectory, of the widest vector unit up to this one; NULL: the system has none for this
 * formulation. */
const zd_closed_form *zd_closed_form_of(const zd_system *system, const zd_formulation *formulation, enum zd_unit unit);
/* Initializes the closed-form path, if the system has one for the formulation and this vector unit or a narrower one. */
void zd_closed_form_create(zd_motion *motion, zd_arena *arena, enum zd_unit unit);
/* Chooses the evaluation path of a step that begins at the point; true: the closed-form path. */
int zd_closed_form_choose(zd_motion *motion);

/* Sets the functions and addresses that follow from path and variables, of a state that was restored. */
void zd_path_bind(zd_motion *motion);
/* Change to the matrix path; true: from the closed-form path. For a part of a step; for a step from its start, with the counters of the
 * energy correction restored; for another start with other data, which clears the scales of the pivots. */
int zd_closed_form_leave(zd_motion *motion);
int zd_closed_form_leave_step(zd_motion *motion);
void zd_closed_form_discard(zd_motion *motion);
/* Chooses the path of a step that begins at the point, to which the motion was moved by steps in closed form elsewhere, as in lanes. */
int zd_closed_form_resume(zd_motion *motion);
/* Saves the counters of the energy correction at the start of a step. */
void zd_closed_form_save_energy(zd_motion *motion);
/* Computes the scales of the pivots of all orders. */
void zd_closed_form_find_scales(zd_motion *motion);
/* zd_comparison of the closed-form path: of the pivots. ZD_SINGULAR: the step must be repeated on the matrix path. */
int zd_closed_form_compare(zd_safeguards *safeguards, double h, double moved);

/* True if the quick check at the end of the previous step passed: this step then reuses its elimination order. */
static inline int zd_closed_form_continues(zd_motion *motion)
{
    if (!motion->path.continues) return 0;
    motion->path.continues = 0;
    if (!(motion->point->known & ZD_ACCELERATED)) return 0;
    ZD_SIZED(zd_copy, motion->system.nv, motion->path.pivots, motion->path.before);
    if (motion->corrections > 1) zd_closed_form_save_energy(motion);
    return 1;
}

/* Chooses the integrated variables, then the path of a step that begins at the point. *is_left: true if it is the matrix path after steps in
 * closed form, which do not save their starts for its checks. */
static inline int zd_path_choose(zd_stepper *stepper, int *is_left)
{
    zd_motion *motion = stepper->motion;
    *is_left = 0;
    if (zd_closed_form_continues(motion)) return ZD_DONE;
    int status = motion->formulation == stepper->chosen.formulation ? ZD_DONE : zd_variables_use_chosen(stepper);
    if (status || !motion->path.closed_form) return status;
    *is_left = !zd_closed_form_choose(motion) && motion->path.was_taken;
    if (*is_left) motion->path.was_taken = 0;
    return ZD_DONE;
}

static inline void zd_path_count(zd_motion *motion)      /* counts a step that was accepted */
{
    motion->statistics.steps++;
    if (motion->path.order >= 0) motion->statistics.closed_form_steps++;
}

/* ---- closed form ---- */

static inline const zd_elimination *zd_path_order(const zd_motion *motion) { return motion->path.first + motion->path.order; }

extern const zd_equations zd_equations_in_closed_form;  /* states (p, v) */
extern const zd_equations zd_equations_of_independent;  /* states in independent velocities: embedded_rate.c */

/* vdot and lambda at the point from `evaluate`, with the terms that corrections add to the right side of (6); NULL: none. */
int zd_closed_form_accelerate(zd_motion *motion, int (*evaluate)(zd_motion *motion, const double *added));

/* Newton's iteration in closed form: each call of a system's function has the residual Phi and the correction dp. */

typedef struct zd_iterate {     /* the arguments of such a function, or the first of them */
    zd_motion *motion;
    const double *t;
    double *p, *v;
} zd_iterate;

/* p <- p - dp until call() returns ZD_DONE, not ZD_NO_CONVERGENCE. Phi (mh,): what it writes; *residual: in units of the sizes of Phi, if it
 * fails. */
ZD_INLINE int zd_iterate_in_closed_form(const zd_iterate *it, int (*call)(const zd_iterate *it), int max_iterations, const double *Phi,
                                        int *iterations, double *residual)
{
    zd_motion *motion = it->motion;
    const zd_point *point = motion->point;
    double first = INFINITY, left;
    for (*iterations = 0;; ++*iterations) {
        int status = call(it);
        motion->statistics.evaluations++;
        if (status != ZD_NO_CONVERGENCE) return status ? ZD_CALLBACK : ZD_DONE;
        left = ZD_SIZED(zd_largest_scaled, point->system->mh, Phi, point->inverse_size);
        status = zd_newton_goes_on(*iterations, max_iterations, ZD_TRUSTED_SHARE, left, &first);
        if (status) {
            *residual = left;
            return status;
        }
        zd_correct_position(&motion->system, it->p, motion->path.dp, it->p);    /* (25a), (26a), (27a); (18) in independent velocities */
    }
}

/* Independent velocities: embed.c */

/* Allocates the fields of the path that only these formulations need. */
void zd_embed_create(zd_motion *motion, zd_arena *arena);
/* Index of the elimination order whose dependent velocities are those not in the state, which it saves in the path; -1: there is none. */
int zd_embed_find(zd_motion *motion);
/* Sets the tolerance of Phi for a step that begins at the point. */
void zd_embed_begin(zd_motion *motion);
/* True if, at the point, an entry of D exceeds the bound up to which the formulation keeps its independent velocities. */
int zd_embed_is_steep(const zd_motion *motion);
/* The acceleration at the point, with the terms `added` to the right side of (6) */
int zd_embed_accelerate(zd_motion *motion, const double *added);
/* zd_equations.unpack and pack */
int zd_embed_unpack(zd_motion *motion, double t, double *y);
int zd_embed_pack(zd_motion *motion, double *y);
/* Dependent velocities of the point, and its acceleration */
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
