/* Choice of the evaluation path of a step, and its end compared with its start on the closed-form path: choose.c */
#ifndef ZD_CHOOSE_H
#define ZD_CHOOSE_H

#include "path.h"

/* Closed-form functions for a single trajectory, of the widest vector unit up to this one; NULL: the system has none for this formulation. */
const zd_closed_form *zd_direct_of(const zd_system *system, const zd_formulation *formulation, enum zd_unit unit);
/* Initializes the closed-form path, if the system has one for the formulation and this vector unit or a narrower one. */
void zd_direct_take(zd_motion *motion, zd_arena *arena, enum zd_unit unit);
/* Chooses the evaluation path of a step that begins at the point; true: the closed-form path. */
int zd_direct_choose(zd_motion *motion);

/* The path for any step or a part of one, whose state may differ from the point. */
static inline const zd_evaluation_path *zd_path_of_state(const zd_motion *motion)
{
    if (!zd_is_direct(motion)) return &zd_matrix_path;
    return motion->path.embeds ? &zd_independent_path : &zd_converted_path;
}

/* The path of a step of the run. */
static inline const zd_evaluation_path *zd_path_of(const zd_motion *motion)
{
    return motion->path.is_short ? &zd_closed_form_path : zd_path_of_state(motion);
}

/* Changes to the matrix path. */
void zd_direct_leave(zd_motion *motion);
/* Save and restore the counters of the energy correction at the start of a step. */
void zd_direct_remember_energy(zd_motion *motion);
void zd_direct_forget_energy(zd_motion *motion);
/* Computes the scales of the pivots of all orders. */
void zd_direct_measure(zd_motion *motion);
/* zd_comparison of the closed-form path: of the pivots. ZD_SINGULAR: the step must be repeated on the matrix path. */
int zd_direct_compare(zd_safeguards *safeguards, double h, double moved);

/* True if the quick check at the end of the previous step passed: this step then reuses its elimination order. */
static inline int zd_direct_continues(zd_motion *motion)
{
    int continues = motion->path.continues && (motion->point->known & ZD_ACCELERATED);
    motion->path.continues = 0;
    if (!continues) return 0;
    double *pivots = motion->path.pivots;       /* exchanged, as a copy would wait for the pivots */
    motion->path.pivots = motion->path.before;
    motion->path.before = pivots;
    if (motion->corrections > 1) zd_direct_remember_energy(motion);
    return 1;
}

#endif
