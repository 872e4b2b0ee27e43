/* Opening of a run: its memory and its components, at a state. */
#include "run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../motion/motion.h"
#include "../paths/path.h"
#include "../point/point.h"
#include "../registry.h"
#include "../state/stepper.h"
#include "../step/step_loop.h"

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

static void enable_corrections(zd_run *run, zd_arena *arena)
{
    for (int row = 0; row < zd_entry_count(ZD_CORRECTIONS); row++)
        if (run->settings.correction[row].given)
            zd_motion_enable(&run->motion, arena, zd_correction_of(row), run->settings.correction[row].value);
}

/* Address of a run, and the coordinates and velocities of its point, whose addresses the caller has; NULL: in its own memory. */
typedef struct position {
    zd_run *at;
    double *p, *v;
} position;

/* Allocates and initializes a run; `independent` is the system with its independent constraints only. Called twice, see workspace.h: to
 * count bytes, then to assign addresses. */
static zd_run *create_run(zd_arena *arena, const position *where, const zd_system *system, const zd_settings *settings,
                          const zd_system *independent)
{
    zd_run nowhere, *here = where->at ? where->at : zd_arena_bytes(arena, sizeof *here), *run = arena->base ? here : &nowhere;
    memset(run, 0, sizeof *run);
    zd_motion *motion = &run->motion;
    const zd_integrator *integrator = zd_integrator_of(settings->integrator);
    const zd_formulation *formulation = zd_formulation_of(settings->formulation);
    run->settings = *settings, run->goal.step = INT64_MAX;
    zd_motion_create(motion, arena, system, independent, formulation, complete(&run->settings.of_formulation, &formulation->card),
                     settings->on_singular);
    if (where->at && arena->base) motion->point->p = where->p, motion->point->v = where->v;
    zd_reactions_create(motion, arena);
    enable_corrections(run, arena);
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
    run->held = zd_inputs_create(arena, settings->inputs, motion);
    if (settings->is_open) run->goal.good = zd_state_create(arena, motion);
    return arena->base ? here : NULL;
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

static zd_run *lay_out(const position *where, const zd_system *system, const zd_settings *settings, int rows, int holonomic, char *message,
                       int size)
{
    zd_system independent = with_rows(system, settings->on_singular, rows, holonomic);
    zd_arena counting = {0};
    create_run(&counting, where, system, settings, &independent);
    zd_memory *memory = zd_memory_create(counting.used);
    if (!memory) {
        snprintf(message, size, "there is no memory for this: %.3g MiB", (double)counting.used / 0x1p20);
        return NULL;
    }
    zd_arena arena = zd_arena_in(memory);
    zd_run *run = create_run(&arena, where, system, settings, &independent);
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
zd_run *zd_run_open(zd_run *at, const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size)
{
    const position where = {at, at ? at->motion.point->p : NULL, at ? at->motion.point->v : NULL};
    int rows = smaller(zd_constraints(system), system->nv), holonomic = smaller(system->mh, rows);
    for (;;) {
        zd_run *run = lay_out(&where, system, settings, rows, holonomic, message, size);
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
        zd_plan_free(run);
    }
}

void zd_plan_free(zd_run *run)
{
    zd_store_release(&run->motion.store);
    zd_memory_free(run->memory);
}
