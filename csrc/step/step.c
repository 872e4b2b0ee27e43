/* One step of a run. Numbers of equations are the paper's, notebooks/theory/computation.md; C is the Jacobian of the constraints, and y the
 * integrated state: (p, v), or fewer variables from which these follow. In order:
 *
 *  1. zd_step(): choose the integrated variables and the evaluation path, by matrices or in closed form (paths/path.c), once for the step;
 *     attempt_sizes(): choose the size h, anew for each attempt (fixed.c, adaptive.c)
 *  2. attempt(), by functions of the path (paths/path.h): integrate, which saves the start of the step and advances y from t to t + h
 *  3. adaptive steps: estimate the error; the attempt ends here if it is too large
 *  4. project positions, then velocities, onto the constraints: (25)-(27)
 *  5. correct the energy, if the settings request it: (29)
 *  6. finish: write y from the corrected point
 *  7. check, by comparison with the start (safeguards/): assembly branch; a bifurcation within the step, by the pivots or the orientation
 *     of C; stability; whether fixed steps resolve the motion; whether the terms of the system agree with each other
 *  8. accept the step; or return to its start and repeat it, in this order: through a bifurcation; by matrices; in (p, v), if the
 *     integrated variables lost digits; with a shorter step, fixed steps in equal parts
 *
 * Progress of the run and control of its next step: step_loop.h; integrated state y, and its return to a start: state/stepper.h;
 * redundant constraints, and those at a bifurcation: constraints/rank.h.
 *
 * zd_substep(): a step to a sample or an event within the last one is the same without 3 and 7, with all corrections, due or not.
 */
#include "step_loop.h"

#include <math.h>

#include "../paths/path.h"

enum { MAX_HALVINGS = 8 };     /* largest number of halvings of a substep that fails */

/* A step by matrices after steps in closed form: their ends were not saved as starts for its checks, so that its start is saved here. */
static int choose_path(zd_step_loop *loop)
{
    int is_left;
    int status = zd_path_choose(loop->stepper, &is_left);
    return !status && is_left ? zd_safeguards_begin(loop->safeguards, loop->step) : status;
}

/* Makes one attempt on the present path, 2 to 7. `kind` is a->kind, as a constant for new steps, whose branches are then resolved at
 * compile time. ZD_DONE with control.norm > 1 or control.move > 1: rejected by its error estimate. */
ZD_INLINE int attempt(zd_step_loop *loop, const zd_attempt *a, const int kind)
{
    zd_stepper *stepper = loop->stepper;
    const zd_motion *motion = loop->motion;
    const zd_step_sizes *sizes = loop->sizes;
    const int is_new = kind == ZD_NEW_STEP, is_checked = is_new || kind == ZD_THROUGH_BIFURCATION;
    const zd_evaluation_path *path = zd_path_of(motion);
    if (sizes->set_scale && (is_new || kind == ZD_REPEATED_STEP)) sizes->set_scale(loop);
    int status = path->integrate(stepper, a->h);
    if (!status && sizes->estimate && is_new) {
        status = sizes->estimate(loop, a);
        if (status || !zd_control_accepts(&loop->control)) return status;
    }
    if (!status) status = path->project(stepper, a->t1, a->step, a->forced);                                /* (25)-(27) */
    if (!status && motion->others_after_step) status = path->correct(stepper, a->step, a->forced);          /* (29) */
    if (status) return status;
    return is_checked ? path->check(stepper, loop->safeguards, a->step + 1, loop->parts) : path->finish(stepper, 0);
}

int zd_step_attempt(zd_step_loop *loop, const zd_attempt *a)
{
    return attempt(loop, a, a->kind);
}

/* ---- returns to the start of the step ---- */

/* Leaves the closed form; true if the step was made so. */
static int leave_closed_form(zd_step_loop *loop, const zd_attempt *a)
{
    return a->kind == ZD_SUBSTEP ? zd_closed_form_leave(loop->motion) : zd_closed_form_leave_step(loop->motion);
}

static int return_for_matrices(zd_step_loop *loop, const zd_attempt *a)
{
    int status = zd_stepper_return(loop->stepper);
    return status || a->kind == ZD_SUBSTEP ? status : zd_safeguards_begin(loop->safeguards, loop->step);
}

/* Returns to the start of the step with (p, v) as the integrated variables; the safeguards may have saved the end of the step already. */
static int return_for_dependent(zd_step_loop *loop, const zd_attempt *a)
{
    int status = zd_variables_use_dependent(loop->stepper);
    if (status || a->kind == ZD_SUBSTEP || !loop->safeguards->guard.has_begun) return status;
    return zd_safeguards_begin(loop->safeguards, loop->step + 1);
}

static int make_from_start(zd_step_loop *loop, double t)
{
    int status = zd_stepper_return(loop->stepper);
    return status ? status : zd_substep(loop, t);
}

/* Repeats the step through the bifurcation in it, if the settings allow that and the motion is continuous there. */
static int return_for_bifurcation(zd_step_loop *loop, const zd_attempt *a)
{
    zd_attempt through = *a;
    int found, status;
    if (loop->settings->on_singular == ZD_STOP) return ZD_BIFURCATION_PASSED;
    through.kind = ZD_THROUGH_BIFURCATION;
    status = zd_passage_find(loop, a->t1, make_from_start, &found);
    if (status || !found) return status == ZD_CALLBACK || status == ZD_NO_MEMORY ? status : ZD_BRANCH;
    loop->safeguards->crossing.may_pass = 1;
    status = zd_stepper_return(loop->stepper);
    if (!status) status = zd_step_attempt(loop, &through);
    if (zd_variables_lose_digits(loop->stepper, status)) {
        status = return_for_dependent(loop, a);
        if (!status) status = zd_step_attempt(loop, &through);
    }
    loop->safeguards->crossing.may_pass = 0;
    return status;
}

ZD_INLINE int attempt_or_pass(zd_step_loop *loop, const zd_attempt *a, const int kind)
{
    int status = attempt(loop, a, kind);
    return status == ZD_BIFURCATION_PASSED && kind == ZD_NEW_STEP ? return_for_bifurcation(loop, a) : status;
}

/* Repeats an attempt that ended with `status`: by matrices, if it failed in closed form; then in (p, v), if the integrated variables lost
 * digits, of which attempts that succeed report it, too. Returns `status` if neither applies. */
static int attempt_again(zd_step_loop *loop, const zd_attempt *a, int status, const zd_stiffness *before, int64_t stiff)
{
    if (status && leave_closed_form(loop, a)) {
        loop->control.stiffness = *before;      /* the step is counted once */
        loop->motion->statistics.stiff = stiff;
        status = return_for_matrices(loop, a);
        if (!status) status = attempt_or_pass(loop, a, a->kind);
    }
    if (!zd_variables_lose_digits(loop->stepper, status)) return status;
    status = return_for_dependent(loop, a);
    return status ? status : attempt_or_pass(loop, a, a->kind);
}

/* Attempts on the chosen path, by matrices, and in (p, v), until one succeeds. */
ZD_INLINE int attempt_on_each_path(zd_step_loop *loop, const zd_attempt *a, const int kind, const zd_rank *rank)
{
    const zd_stiffness before = loop->control.stiffness;
    const int64_t stiff = loop->motion->statistics.stiff;
    int status = attempt_or_pass(loop, a, kind);
    return !status && !rank->was_ill_conditioned ? ZD_DONE : attempt_again(loop, a, status, &before, stiff);
}

/* ---- steps ---- */

/* Attempts, with the sizes of the settings, until one is the step, or none can be. */
ZD_INLINE int attempt_sizes(zd_step_loop *loop, const zd_rank *rank)
{
    zd_attempt next = {.kind = ZD_NEW_STEP, .step = loop->step};
    for (;;) {
        int status = loop->sizes->next(loop, &next);
        if (status) return status;
        status = attempt_on_each_path(loop, &next, ZD_NEW_STEP, rank);
        if (!status && !loop->sizes->estimate && !loop->parts) return ZD_DONE;      /* a fixed step that is not divided */
        int found = status;
        if (!loop->sizes->repeats(loop, &found)) return found;
    }
}

int zd_step(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    zd_rank *rank = motion->point->rank;
    loop->step++;
    int status = choose_path(loop);
    if (status) return status;
    if (loop->sizes->begin) status = loop->sizes->begin(loop);
    if (!status) status = attempt_sizes(loop, rank);
    if (rank->was_deficient) motion->statistics.rank_drops++;
    rank->was_deficient = rank->was_doubtful = 0;
    if (!status) zd_path_count(motion);
    return status;
}

static int is_too_long(int status)
{
    return status == ZD_NO_STEP || status == ZD_NO_EMBEDDING || status == ZD_NO_CONVERGENCE;
}

static int attempt_to(zd_step_loop *loop, double t)
{
    const zd_attempt substep = {.kind = ZD_SUBSTEP, .h = t - loop->stepper->t, .t1 = t, .forced = 1};
    return attempt_on_each_path(loop, &substep, ZD_SUBSTEP, loop->motion->point->rank);
}

/* Divided into parts if a single step fails: the run's own step may have converged only because its iteration started from the polynomial of
 * the step before, or was made in other variables. */
int zd_substep(zd_step_loop *loop, double t)
{
    zd_stepper *stepper = loop->stepper;
    double part = t - stepper->t;
    int status = attempt_to(loop, t), halvings = 0;
    while (status ? is_too_long(status) && halvings < MAX_HALVINGS : stepper->t != t) {
        if (status) {
            halvings++;
            part /= 2;
            status = zd_stepper_return(stepper);
            if (status) break;
        }
        const double h = fmin(part, t - stepper->t);
        status = attempt_to(loop, h == part ? stepper->t + h : t);
    }
    loop->motion->statistics.output_steps++;
    return status;
}
