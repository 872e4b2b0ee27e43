#include "motion.h"

#include "../constraints/limits.h"
#include "../constraints/rank.h"
#include "../constraints/rank_monitor.h"

/* Memory for the selection of independent constraints, with its monitors. Large structures have none. */
static zd_rank *create_rank(zd_motion *motion, zd_arena *arena, const zd_system *independent, enum zd_on_singular on_singular)
{
    const zd_formulation *formulation = motion->formulation;
    const zd_system *system = &motion->system;
    const int is_large = zd_has_many_constraints(formulation, system), is_dense = !system->structure;
    zd_rank *rank = zd_rank_create(arena, system, is_large);
    double *rhs = formulation->update ? zd_arena_doubles(arena, zd_constraints(system)) : NULL;
    const int is_full = zd_constraints(independent) == zd_constraints(system);
    const int are_few = is_dense && zd_constraints(system) <= ZD_FEW_CONSTRAINTS;
    /* The selection's work space is free while a full check finds whether one is needed. */
    double counted, *Q = &counted, *G = &counted;
    if (rank && rank->selection) Q = rank->selection->Q, G = rank->selection->G;
    zd_rank_monitor *monitor = is_large || are_few ? NULL : zd_rank_monitor_create(arena, system, 0, Q, G);
    zd_rank_monitor *kept = is_large || is_full ? NULL : zd_rank_monitor_create(arena, system, 1, NULL, NULL);
    zd_limits *limits = is_large || on_singular == ZD_STOP ? NULL : zd_limits_create(arena, system);
    if (!rank) return NULL;
    rank->monitor = monitor;
    rank->kept = kept;
    rank->rhs = rhs;
    rank->store = &motion->store;
    if (rank->selection) rank->selection->limits = limits;
    return rank;
}

void zd_motion_create(zd_motion *motion, zd_arena *arena, const zd_system *system, const zd_system *independent,
                    const zd_formulation *formulation, const void *given, enum zd_on_singular on_singular)
{
    const int has_products = system->operations && system->operations->add_weighted;
    const int has_own = has_products && formulation->has_matrices_evaluated && zd_has_many_constraints(formulation, system);
    const int matrices = has_own ? 0 : ZD_M | ZD_C;
    const size_t used = arena->used;
    void *solver = formulation->create(arena, independent, given);
    *motion = (zd_motion){
        .system = *system,
        .formulation = formulation,
        .drifts_from = formulation->drifts_from,
        .corrects = ZD_PHI | ZD_C,
        .matrices = matrices,
        /* A is needed for pdot with every acceleration, so both are evaluated together, unless the system multiplies by A itself. */
        .acceleration_needs = (zd_brings_times_A(system) ? 0 : ZD_A) | matrices | ZD_BIAS | ZD_FORCE | ZD_XI |
                              (zd_has_input(system) ? ZD_POWER | ZD_PHI_T : 0),
        .formulation_size = formulation->state_size(independent),
        .solver = solver,
        .equations = &zd_equations_by_matrices,
        .path = {.order = -1},
        .memory_of_chosen = zd_span_since(arena, used),
    };
    motion->point = zd_point_create(arena, &motion->system, &motion->statistics);
    zd_rank *rank = create_rank(motion, arena, independent, on_singular);
    if (motion->point) {
        motion->point->rank = rank;
        motion->point->C = motion->point->terms.C;      /* all constraints, until some are selected */
    }
    motion->rate = (zd_rate){
        .inputs = motion->point ? motion->point->inputs : NULL,
        .context = motion,
        .known = motion->point ? &motion->point->known : NULL,
        .size = motion->formulation_size + zd_has_input(system),
        .system = &motion->system,
    };
    zd_motion_describe_rate(motion);
}

void zd_motion_describe_rate(zd_motion *motion)
{
    const int are_pairs = !motion->formulation->update && !(motion->system.provides & ZD_A) && !motion->corrections_size;
    motion->rate.pairs = are_pairs ? motion->system.nv : 0;
    motion->rate.evaluate = motion->equations->rate;
    motion->rate.expand = motion->formulation->update ? motion->equations->expand : NULL;
    motion->rate.reduce = motion->formulation->update ? motion->equations->reduce : NULL;
}

void zd_motion_enable(zd_motion *motion, zd_arena *arena, const zd_correction *correction, const void *given)
{
    int every = correction->every ? correction->every(given) : 1;
    int size = correction->extra_size ? correction->extra_size(&motion->system, given) : 0;
    void *self = correction->create ? correction->create(arena, &motion->system, given) : NULL;
    if (correction->target) motion->target = correction->target(given);
    motion->active[motion->corrections++] = (zd_active){correction, self, every, motion->corrections_size, size};
    motion->acceleration_needs |= correction->needs;
    motion->corrections_need |= correction->needs;
    motion->is_stabilized |= correction->stabilize != NULL;
    motion->others_after_step += correction->after_step && !correction->target;
    motion->corrections_size += size;
    motion->rate.size += size;
    zd_motion_describe_rate(motion);
}

void zd_motion_attach(zd_motion *motion, double *state)
{
    motion->state = state;
    motion->balance.input = zd_has_input(&motion->system) ? state + motion->rate.size - 1 : NULL;
}
