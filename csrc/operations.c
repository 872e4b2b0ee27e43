/* Operations of a run for single states: accelerations, projection, states between states. */
#include <stdio.h>
#include <string.h>

#include "contact/phase_system.h"
#include "linalg/small.h"
#include "motion/derivatives.h"
#include "motion/motion.h"
#include "point/point.h"
#include "registry.h"
#include "run/arguments/checks.h"
#include "run/run.h"
#include "state/stepper.h"
#include "systems/held.h"

static int finish(zd_run *run, int status, char *message, int size)
{
    if (status) status = zd_explain(run, status);
    snprintf(message, size, "%s", run->outcome.message);
    zd_run_free(run);
    return status;
}

static int refuse_groups(const zd_system *system, char *message, int size)
{
    if (!system->groups) return ZD_DONE;
    snprintf(message, size, "a single state has no phase: contacts, stops, and joints with dry friction or active=, such as '%s', must "
             "be in a run, at whose samples accelerations and reactions are read", system->group[0].name);
    return ZD_BAD_ARGUMENT;
}

/* A run at a state, with its accelerations; NULL if it could not be created, with *status */
static zd_run *accelerated(const zd_system *system, int formulation, enum zd_on_singular on_singular, double t, const double *p,
                           const double *v, int *status, char *message, int message_size)
{
    zd_settings settings = {.formulation = formulation, .on_singular = on_singular};
    *status = refuse_groups(system, message, message_size);
    if (!*status) *status = zd_check_method(system, &settings, message, message_size);
    if (!*status) *status = zd_check_quaternions(system, p, 0, message, message_size);
    zd_run *run = *status ? NULL : zd_run_open(NULL, system, &settings, t, p, v, status, message, message_size);
    if (!run) return NULL;
    if (!*status) *status = zd_stepper_set_state(&run->stepper, t, p, v);
    if (!*status) *status = zd_motion_accelerate(&run->motion);
    if (!*status && !zd_is_finite(system->nv, run->motion.point->vdot)) *status = ZD_NOT_FINITE;
    return run;
}

int zd_accelerations(const zd_system *system, int formulation, enum zd_on_singular on_singular, int64_t states, const double *t,
                     const double *p, const double *v, double *vdot, double *multipliers, int *is_deficient, double *u, char *message,
                     int message_size)
{
    const int64_t nq = system->nq, nv = system->nv;
    int status = ZD_DONE;
    for (int64_t i = 0; i < states && !status; i++) {
        zd_run *run = accelerated(system, formulation, on_singular, t[i], p + i * nq, v + i * nv, &status, message, message_size);
        if (!run) return status;
        const zd_point *point = run->motion.point;
        const int64_t m = zd_constraints(system);
        zd_rank_find_multipliers(point);
        if (vdot) memcpy(vdot + i * nv, point->vdot, nv * sizeof *vdot);
        if (multipliers) memcpy(multipliers + i * m, point->lambda, m * sizeof *multipliers);
        if (is_deficient) is_deficient[i] = zd_rank_is_deficient(point);
        if (u) zd_copy_all(system->reading->functions, point->inputs, u + i * system->reading->functions);
        status = finish(run, status, message, message_size);
    }
    return status;
}

/* Accelerations of a phase with these multipliers of all rows: those without groups, and their change by the forces of groups. */
static int accelerate_with(zd_run *run, zd_phase_system *of, const double *multipliers, double *vdot)
{
    zd_motion *motion = &run->motion;
    zd_point *point = motion->point;
    const zd_system *full = of->full;
    zd_copy_all(full->nv, point->vdot, vdot);
    zd_clear(full->nv, point->force);
    zd_clear(zd_constraints(point->system), point->rhs);
    const int status = zd_phase_evaluate(of, ZD_C, point->t, point->p, point->v);
    for (int g = 0; !status && g < full->groups; g++)
        for (int k = full->group[g].first; k < full->group[g].first + full->group[g].rows; k++) {
            const zd_row_of_C row = zd_phase_row(of, k);
            const int is_again = g && k == full->group[g - 1].first;     /* two groups may share a row */
            for (int j = 0; !is_again && j < row.count; j++) point->force[zd_column(&row, j)] -= row.x[j] * multipliers[k];
        }
    if (status) return status;
    zd_motion_solve(motion, point->force, point->rhs, point->vdot, point->lambda);
    for (int i = 0; i < full->nv; i++) vdot[i] += point->vdot[i];
    return ZD_DONE;
}

int zd_accelerations_with(const zd_system *system, int formulation, int64_t states, const double *t, const double *p, const double *v,
                          const double *multipliers, double *vdot, char *message, int message_size)
{
    const int64_t nq = system->nq, nv = system->nv, m = zd_constraints(system);
    zd_arena arena = {0};
    signed char *none = zd_allocate(system->groups);
    zd_phase_system_create(&arena, system, none);
    int status = none && zd_arena_allocate(&arena) ? ZD_DONE : ZD_NO_MEMORY;
    zd_phase_system *of = status ? NULL : zd_phase_system_create(&arena, system, none);
    for (int64_t i = 0; i < states && !status; i++) {
        zd_run *run = accelerated(&of->system, formulation, ZD_CONTINUE, t[i], p + i * nq, v + i * nv, &status, message, message_size);
        if (!run) break;
        if (!status) status = accelerate_with(run, of, multipliers + i * m, vdot + i * nv);
        status = finish(run, status, message, message_size);
    }
    zd_release(arena.base);
    zd_release(none);
    return status;
}

int zd_read_states(const zd_system *system, int64_t states, const double *t, const double *p, const double *v, const double *vdot,
                  const double *multipliers, const zd_efforts *efforts, double *u)
{
    int64_t nq = system->nq, nv = system->nv, m = zd_constraints(system), k = system->reading->functions;
    int status = ZD_DONE;
    for (int64_t i = 0; i < states && !status; i++)
        status = zd_reactions_at(system, t[i], p + i * nq, v + i * nv, vdot + i * nv, multipliers + i * m, efforts ? efforts + i : NULL,
                                    u + i * k);
    return status;
}

int zd_evaluate_states(const zd_system *system, int want, int64_t states, const double *t, const double *p, const double *v,
                       const zd_terms *first)
{
    zd_terms at = *first;
    int status = ZD_DONE;
    for (int64_t i = 0; i < states && !status; i++) {
        if (system->reading && first->inputs) at.inputs = first->inputs + i * system->reading->functions;
        status = system->evaluate(system->data, want | ZD_MOVED, t[i], p + i * system->nq, v + i * system->nv, &at);
        for (int term = 0; zd_term_at(term); term++)
            if (want & zd_term_at(term)->term) *zd_term_in(&at, term) += zd_term_size(system, term);
    }
    return status;
}

int zd_residuals_along(const zd_system *system, const double *inputs, int parts, double t, const double *p, const double *v,
                       const double *vdot, const double *lambda, int is_rough, int64_t directions, const double *dt, const double *dp,
                       const double *dv, const double *sizes, double *derivatives)
{
    const enum zd_accuracy accuracy = is_rough ? ZD_CENTRAL : ZD_ACCURATE;
    const int64_t nq = system->nq, nv = system->nv;
    zd_statistics statistics = {0};
    zd_arena counting = {0};
    zd_residual_state_create(&counting, system, &statistics, accuracy);
    zd_point_create(&counting, system, &statistics);
    zd_memory *memory = zd_memory_create(counting.used);
    if (!memory) return ZD_NO_MEMORY;
    zd_arena arena = zd_arena_in(memory);
    zd_residual_state state = zd_residual_state_create(&arena, system, &statistics, accuracy);
    zd_point *point = zd_point_create(&arena, system, &statistics);
    if (system->reading && inputs) zd_copy_all(system->reading->functions, inputs, point->inputs);
    zd_point_move(point, t, p, v);
    zd_residual_state_begin(&state, parts, point, vdot, lambda);
    int status = ZD_DONE;
    for (int64_t i = 0; i < directions && !status; i++) {
        const zd_direction direction = {.t = dt[i], .p = dp + i * nq, .v = dv + i * nv};
        if (sizes[i] > 0) status = zd_residual_derivatives(&state, &direction, 1 / sizes[i], accuracy, derivatives + i * state.width);
    }
    zd_memory_free(memory);
    return status;
}

enum { MAX_SCALES = 10 };      /* scales tried by a projection of positions */

/* The tolerance is relative to sizes at the guess. If those at the result are so much smaller that no run may start there, one of the scales
 * left is used up, otherwise all. */
static int check_scales(zd_run *run, int *scales_left)
{
    double violation;
    int is_allowed, status = zd_start_measure(run, &violation, &is_allowed);
    *scales_left = is_allowed ? 0 : *scales_left - 1;
    if (status || is_allowed || *scales_left) return status;
    run->motion.point->residual_left = violation;
    return ZD_NO_CONVERGENCE;
}

/* One stage of a projection, positions or velocities; held coordinates or velocities are additional constraints. */
static int project_stage(const zd_system *system, const zd_settings *settings, int corrects, double t, double *p, double *v,
                         int *iterations, int *scales_left, char *message, int message_size)
{
    int status;
    zd_system still = *system;
    still.provides &= ~ZD_XI;       /* accelerations are not evaluated */
    zd_run *run = zd_run_open(NULL, &still, settings, t, p, v, &status, message, message_size);
    if (!run) return status;
    run->motion.drifts_from = ZD_PHI | ZD_C;
    run->motion.corrects = corrects;
    if (!status) status = zd_motion_correct(&run->motion);
    if (!status && scales_left) status = check_scales(run, scales_left);
    zd_point_follow(run->motion.point);
    zd_copy_all(system->nq, run->motion.point->p, p);
    zd_copy_all(system->nv, run->motion.point->v, v);
    if (iterations) *iterations += (int)run->motion.statistics.position_iterations;
    return finish(run, status, message, message_size);
}

/* Repeated from the result of the one before, until the tolerance holds in the sizes there. */
static int project_positions(const zd_system *system, const zd_settings *settings, double t, double *p, double *v, int *iterations,
                             char *message, int message_size)
{
    int status = ZD_DONE, scales_left = MAX_SCALES;
    while (!status && scales_left)
        status = project_stage(system, settings, ZD_PHI, t, p, v, iterations, &scales_left, message, message_size);
    return status;
}

/* Constraints that the corrections in the settings enforce, with tolerances. */
static zd_constraint_target target_of(const zd_settings *settings)
{
    zd_constraint_target target = {0};
    for (int entry = 0; entry < zd_entry_count(ZD_CORRECTIONS); entry++) {
        const zd_correction *correction = zd_correction_of(entry);
        if (settings->correction[entry].given && correction->target) target = correction->target(settings->correction[entry].value);
    }
    return target;
}

static int project(zd_store *store, const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
                   const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size)
{
    const zd_constraint_target target = target_of(settings);
    int status = ZD_DONE;
    if (target.positions) {
        /* (25a) is computed with all rows of C */
        const zd_system *holding = hold_p ? zd_hold_positions(store, system, hold_p, p) : system;
        status = holding ? project_positions(holding, settings, t, p, v, iterations, message, message_size) : ZD_NO_MEMORY;
    }
    if (!status && target.velocities) {
        const zd_system *holding = zd_hold_velocities(store, system, hold_v, v);
        status = holding ? project_stage(holding, settings, ZD_C, t, p, v, NULL, NULL, message, message_size) : ZD_NO_MEMORY;
    }
    return status;
}

int zd_project(const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
               const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size)
{
    zd_settings stage = *settings;
    zd_store store = {NULL};
    if (iterations) *iterations = 0;
    stage.on_singular = ZD_CONTINUE;    /* the smallest correction exists at a bifurcation, too */
    int status = refuse_groups(system, message, message_size);
    if (!status) status = zd_check_method(system, settings, message, message_size);
    if (!status) status = zd_check_quaternions(system, p, 1, message, message_size);
    if (!status) status = project(&store, system, &stage, t, p, v, hold_p, hold_v, iterations, message, message_size);
    zd_store_release(&store);
    if (status == ZD_NO_MEMORY && !*message) snprintf(message, message_size, "%s", zd_sentence(status));
    return status;
}

static void copy_state(const zd_system *system, const double *p, const double *v, double *to_p, double *to_v)
{
    zd_copy_all(system->nq, p, to_p);
    zd_copy_all(system->nv, v, to_v);
}

int zd_states_between(const zd_system *system, const zd_settings *settings, const zd_saved *saved, int64_t count, const double *t, double *p,
                      double *v, char *message, int message_size)
{
    int status;
    zd_run *run = zd_run_create(system, settings, saved->p, saved->v, &status, message, message_size);
    if (!run) return status;
    zd_resample resample = {.run = run, .saved = saved, .sample = -1};
    status = zd_dense_output_create(&run->stepper);
    for (int64_t i = 0; i < count && !status; i++) {
        status = zd_resample_move(&resample, t[i]);
        copy_state(system, run->motion.point->p, run->motion.point->v, p + i * system->nq, v + i * system->nv);
    }
    return finish(run, status, message, message_size);
}
