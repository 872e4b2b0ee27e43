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

/* The path for any step or a part of one, whose state may differ from the point. */
static inline const zd_evaluation_path *zd_path_of_state(const zd_motion *motion)
{
    if (!motion->path.order) return &zd_matrix_path;
    return motion->path.embeds ? &zd_independent_path : &zd_converted_path;
}

/* The path of a step of the run. */
static inline const zd_evaluation_path *zd_path_of(const zd_motion *motion)
{
    return motion->path.is_plain ? &zd_closed_form_path : zd_path_of_state(motion);
}

/* Change to the matrix path: for a part of a step; for a step from its start, with the counters of the energy correction restored; for
 * another start with other data, which clears the scales of the pivots. */
void zd_closed_form_leave(zd_motion *motion);
void zd_closed_form_leave_step(zd_motion *motion);
void zd_closed_form_discard(zd_motion *motion);
/* Saves the counters of the energy correction at the start of a step. */
void zd_closed_form_save_energy(zd_motion *motion);
/* Computes the scales of the pivots of all orders. */
void zd_closed_form_find_scales(zd_motion *motion);
/* zd_comparison of the closed-form path: of the pivots. ZD_SINGULAR: the step must be repeated on the matrix path. */
int zd_closed_form_compare(zd_safeguards *safeguards, double h, double moved);

/* True if the quick check at the end of the previous step passed: this step then reuses its elimination order. */
static inline int zd_closed_form_continues(zd_motion *motion)
{
    int continues = motion->path.continues && (motion->point->known & ZD_ACCELERATED);
    motion->path.continues = 0;
    if (!continues) return 0;
    double *pivots = motion->path.pivots;       /* exchanged, as a copy would wait for the pivots */
    motion->path.pivots = motion->path.before;
    motion->path.before = pivots;
    if (motion->corrections > 1) zd_closed_form_save_energy(motion);
    return 1;
}

/* Chooses the integrated variables, then the path of a step that begins at the point. *is_left: true if it is the matrix path after steps in
 * closed form, which do not save their starts for its checks. */
static inline int zd_path_choose(zd_stepper *stepper, int *is_left)
{
    zd_motion *motion = stepper->motion;
    int status = motion->formulation == stepper->chosen.formulation ? ZD_DONE : zd_variables_use_chosen(stepper);
    *is_left = 0;
    if (status || !motion->path.closed_form || zd_closed_form_continues(motion)) return status;
    *is_left = !zd_closed_form_choose(motion) && motion->path.was_taken;
    if (*is_left) motion->path.was_taken = 0;
    return ZD_DONE;
}

static inline void zd_path_count(zd_motion *motion)      /* counts a step that was accepted */
{
    motion->statistics.steps++;
    if (motion->path.order) motion->statistics.closed_form_steps++;
}
