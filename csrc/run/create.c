/* Creation of a run: its memory, its components, and the checks of its start. */
#include "run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "../constraints/rank.h"
#include "../motion/motion.h"
#include "../paths/path.h"
#include "../point/point.h"
#include "../registry.h"
#include "../state/stepper.h"
#include "../step/step_loop.h"
#include "arguments/checks.h"

/* Parameters as given, or the default ones. */
static const void *complete(zd_parameter_values *given, const zd_card *card)
{
    if (!given->given) *given = zd_initial(card);
    return given->value;
}

/* Methods stable at any step size are implicit and reuse their matrix from step to step: it must come from one evaluation path. */
int zd_takes_closed_form(const zd_settings *settings)
{
    const zd_integrator *integrator = zd_integrator_of(settings->integrator);
    return settings->closed_form && !integrator->step_of_motion && integrator->card.stability > 0;
}

int zd_takes_embeddings(const zd_settings *settings)
{
    return zd_formulation_of(settings->formulation)->update != NULL;
}

int zd_takes_series(const zd_settings *settings)
{
    return zd_integrator_of(settings->integrator)->takes_series;
}

int zd_takes_jacobian(const zd_settings *settings)
{
    return zd_integrator_of(settings->integrator)->takes_jacobian;
}

int zd_may_have_closed_form(const zd_system *system, const zd_settings *settings)
{
    const zd_formulation *formulation = zd_formulation_of(settings->formulation);
    return !formulation->update || formulation->may_have_entries(system);
}

int zd_closed_form_unit(const zd_system *system, const zd_settings *settings)
{
    const zd_formulation *formulation = zd_formulation_of(settings->formulation);
    const zd_closed_form *closed_form = zd_takes_closed_form(settings) ? zd_closed_form_of(system, formulation, settings->vector) : NULL;
    return closed_form ? (int)closed_form->unit : -1;
}

static void create_sizes(zd_step_loop *loop, zd_arena *arena, double t0)
{
    if (zd_is_adaptive(loop)) {
        loop->control = zd_adaptive_create(arena, loop->stepper, t0);
        loop->switching = zd_switching_create(arena, loop->motion);
    } else loop->undivided = zd_state_create(arena, loop->motion);
}

/* Allocates and initializes a run; `independent` is the system with its independent constraints only. Called twice, see workspace.h: to
 * count bytes, then to assign addresses. */
static zd_run *create_run(zd_arena *arena, const zd_system *system, const zd_settings *settings, const zd_system *independent)
{
    zd_run nowhere, *here = zd_arena_bytes(arena, sizeof *here), *run = here ? here : &nowhere;
    zd_motion *motion = &run->motion;
    const zd_integrator *integrator = zd_integrator_of(settings->integrator);
    const zd_formulation *formulation = zd_formulation_of(settings->formulation);
    run->settings = *settings;
    zd_motion_create(motion, arena, system, independent, formulation, complete(&run->settings.of_formulation, &formulation->card),
                     settings->on_singular);
    zd_reactions_create(motion, arena);
    for (int row = 0; row < zd_entry_count(ZD_CORRECTIONS); row++)
        if (settings->correction[row].given) zd_motion_enable(motion, arena, zd_correction_of(row), run->settings.correction[row].value);
    if (integrator->takes_jacobian) zd_motion_create_jacobian(motion, arena);
    if (zd_takes_closed_form(settings)) zd_closed_form_create(motion, arena, settings->vector);
    motion->tally = &run->tally;
    zd_variables dependent = zd_variables_of(motion, integrator, independent);
    zd_stepper_create(&run->stepper, arena, motion, integrator, complete(&run->settings.of_integrator, &integrator->card), dependent,
                    independent);
    /* Also for a repeated step of given size in resampling, whose run had adaptive steps. */
    if (run->stepper.memory && integrator->set_tolerance && settings->atol > 0)
        integrator->set_tolerance(run->stepper.memory, settings->rtol, settings->atol);
    zd_safeguards_create(&run->safeguards, arena, motion, settings, &integrator->card, &run->stepper.last);
    run->loop = (zd_step_loop){
        .settings = &run->settings,
        .motion = motion,
        .stepper = &run->stepper,
        .safeguards = &run->safeguards,
        .sizes = settings->steps == ZD_FIXED_STEPS ? &zd_fixed_sizes : &zd_adaptive_sizes,
        .end = settings->t1, .limit = INFINITY, .before_break = INFINITY, .t_begin = settings->t0,
    };
    create_sizes(&run->loop, arena, settings->t0);
    run->recorder = zd_recorder_create(arena, settings, motion);
    run->output = zd_output_create(arena, settings, &run->loop, &run->recorder);
    run->watch = zd_watch_create(arena, settings->events, &run->output);
    run->goal.step = INT64_MAX;
    run->held = zd_inputs_create(arena, settings->inputs, motion);
    if (settings->is_open) run->goal.good = zd_state_create(arena, motion);
    return here;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* The system with `rows` constraints, of which `holonomic` are holonomic. Its own complement D and embedding g are left out: they are for
 * all constraints, and right only if all of them are independent. */
static zd_system with_rows(const zd_system *system, enum zd_on_singular on_singular, int rows, int holonomic)
{
    if (rows == zd_constraints(system) && on_singular == ZD_STOP) return *system;
    zd_system independent = *system;
    independent.mh = holonomic;
    independent.mn = rows - holonomic;
    independent.provides &= ~ZD_COMPLEMENT;
    independent.embed = NULL;
    return independent;
}

static zd_run *lay_out(const zd_system *system, const zd_settings *settings, int rows, int holonomic, char *message, int size)
{
    zd_system independent = with_rows(system, settings->on_singular, rows, holonomic);
    zd_arena counting = {0};
    create_run(&counting, system, settings, &independent);
    zd_memory *memory = zd_memory_create(counting.used);
    if (!memory) {
        snprintf(message, size, "there is no memory for this: %.3g MiB", (double)counting.used / 0x1p20);
        return NULL;
    }
    zd_arena arena = zd_arena_in(memory);
    zd_run *run = create_run(&arena, system, settings, &independent);
    assert(arena.used == counting.used);
    run->memory = memory;
    return run;
}

static int find_rank(zd_motion *motion, enum zd_on_singular on_singular)
{
    if (!zd_constraints(&motion->system)) return ZD_DONE;
    int status = zd_redundancy_prepare(motion->point);
    if (!status && !motion->point->rank->is_large) status = zd_motion_find_independent(motion);
    return status == ZD_CALLBACK ? status : zd_redundancy_find(motion->point, on_singular);
}

/* Created for all constraints; and again for the independent ones, if some are found redundant. */
zd_run *zd_run_open(const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size)
{
    int rows = smaller(zd_constraints(system), system->nv), holonomic = smaller(system->mh, rows);
    for (;;) {
        zd_run *run = lay_out(system, settings, rows, holonomic, message, size);
        *status = run ? ZD_DONE : ZD_NO_MEMORY;
        if (!run) return NULL;
        run->stepper.t = t;
        zd_point_move(run->motion.point, t, p, v);
        zd_point_normalise(run->motion.point);
        *status = zd_point_measure(run->motion.point);
        if (!*status) *status = find_rank(&run->motion, settings->on_singular);
        const zd_rank *rank = run->motion.point->rank;
        int laid = rows, laid_holonomic = holonomic;
        run->motion.statistics.rank = rows = smaller(rank->max_rank, system->nv);
        holonomic = smaller(rank->max_rank_holonomic, rows);
        if (*status || (rows == laid && holonomic == laid_holonomic)) return run;
        zd_run_free(run);
    }
}

void zd_run_free(zd_run *run)
{
    if (!run) return;
    zd_store_release(&run->motion.store);
    zd_memory_free(run->start);
    zd_memory_free(run->memory);
}

static zd_run *refuse(zd_run *run, int why, int *status, char *message, int size)
{
    *status = zd_explain(run, why);
    snprintf(message, size, "%s", run->outcome.message);
    zd_run_free(run);
    return NULL;
}

zd_run *zd_run_create(const zd_system *system, const zd_settings *settings, const double *p0, const double *v0,
                      int *status, char *message, int message_size)
{
    *status = zd_check_run(system, settings, message, message_size);
    if (!*status) *status = zd_check_quaternions(system, p0, 0, message, message_size);
    if (*status) return NULL;
    zd_run *run = zd_run_open(system, settings, settings->t0, p0, v0, status, message, message_size);
    if (!run) return NULL;
    if (settings->steps == ZD_FIXED_STEPS) run->loop.steps = (int64_t)zd_count_steps(settings->t0, settings->t1, settings->step);
    int why = zd_run_start(run, *status, p0, v0);
    if (!why && zd_output_interpolates(&run->output)) why = zd_dense_output_create(&run->stepper);
    *status = why;
    if (settings->is_open) zd_run_remove_end(run);
    return why ? refuse(run, why, status, message, message_size) : run;
}
