/* (8), (9) and (13) are the same equations, solved by the same eliminations: of the constraints, (13), if M is definite and no
 * constraint is redundant; else of the bodies. Where matrices are not formed, these formulations differ only in the systems they accept. */
#include "structured.h"

#include "../../constraints/rank.h"

zd_structured *zd_structured_create(zd_arena *arena, const zd_system *system)
{
    if (!zd_rank_is_of_many(system)) return NULL;
    zd_structured self = {.blocks = zd_schur_blocks_create(arena, system)};
    return zd_arena_copy(arena, &self, sizeof self);
}

/* Records the smallest pivot for the statistics. It has no further consequence: in a long chain some pivot is small whenever the motion
 * comes near a bifurcation. */
static void note_pivot(const zd_weighted *weighted, double share, int smallest, const zd_point *point)
{
    zd_statistics *statistics = point->statistics;
    if (!statistics || (statistics->smallest_pivot > 0 && !(share < statistics->smallest_pivot))) return;
    statistics->smallest_pivot = share;
    statistics->smallest_pivot_time = point->t;
    statistics->smallest_pivot_row = zd_weighted_row(weighted, smallest);
}

static int factor_bodywise(zd_structured *self, zd_point *point)
{
    zd_store *store = point->rank->store;
    int status = zd_point_need(point, ZD_M | ZD_C);     /* not evaluated yet if the system provides its own products */
    if (status) return status;
    if (!self->bodywise) self->bodywise = zd_bodywise_create(store, point);
    if (!self->monitor && point->rank->left_out) self->monitor = zd_singularity_monitor_create(store, point);
    if (!self->bodywise || (point->rank->left_out && !self->monitor)) return ZD_NO_MEMORY;
    if (self->monitor && zd_singularity_monitor_update(self->monitor, point))
        note_pivot(self->monitor->weighted, self->monitor->share, self->monitor->smallest, point);
    return zd_bodywise_factor(self->bodywise, point);
}

int zd_structured_factor(zd_structured *self, zd_point *point, int inverts_mass)
{
    const zd_rank *rank = point->rank;
    int status = ZD_DEPENDENT_ROWS;
    zd_use_all_constraints(point);
    self->is_coupled = rank->max_rank == rank->m && rank->m <= rank->n;
    if (self->is_coupled) status = zd_schur_blocks_factor(self->blocks, point);
    if (self->is_coupled && (!status || status == ZD_DEPENDENT_ROWS))
        note_pivot(self->blocks->weighted, self->blocks->share, self->blocks->smallest, point);
    if (!status || (status == ZD_NOT_DEFINITE && inverts_mass) || (status != ZD_NOT_DEFINITE && status != ZD_DEPENDENT_ROWS)) return status;
    self->is_coupled = 0;
    return factor_bodywise(self, point);
}

void zd_structured_solve(zd_structured *self, const double *force, const double *rhs, double *x, double *lambda)
{
    if (self->is_coupled) zd_schur_blocks_solve(self->blocks, force, rhs, x, lambda);
    else zd_bodywise_solve(self->bodywise, force, rhs, x, lambda);
}
