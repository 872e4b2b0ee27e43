/* Choice of the evaluation path of a step, and its end compared with its start on the closed-form path: choose.c */
#pragma once

#include "../state/stepper.h"
#include "path.h"

/* create.c: closed-form functions for a single trajectory, of the widest vector unit up to this one; NULL: the system has none for this
 * formulation. */
const zd_closed_form *zd_closed_form_of(const zd_system *system, const zd_formulation *formulation, enum zd_unit unit);
/* Initializes the closed-form path, if the system has one for the formulation and this vector unit or a narrower one. */
void zd_closed_form_create(zd_motion *motion, zd_arena *arena, enum zd_unit unit);
/* Chooses the evaluation path of a step that begins at the point; true: the closed-form path. */
int zd_closed_form_choose(zd_motion *motion);

/* Takes the path with this elimination order, negative: by matrices, and all that follows from it: functions, rate, ranges of the pivots. */
void zd_path_take(zd_motion *motion, int order);
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
