/* In the metric of M^-1, the pivots of S = C M^-1 C^T are the squared residual norms of the rows after those before them are projected
 * out; without the constraints that were redundant at the start, all of them are positive except at a bifurcation. No equations are
 * solved with these factors.
 */
#include "structured.h"

#include "../../point/point.h"

typedef struct plan {
    const zd_point *point;
    int rows;               /* number of rows of S */
} plan;

static void *create(zd_arena *arena, const void *of)
{
    const plan *it = of;
    zd_singularity_monitor self = {
        .W = zd_arena_doubles(arena, zd_size_of_M(it->point->system)),
        .without = zd_arena_bytes(arena, it->rows),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* Marks the constraints that were redundant at the start, in the order of S. */
static void leave_out(zd_singularity_monitor *self, const zd_rank *rank)
{
    const zd_layout *layout = self->weighted->layout;
    for (int g = 0; rank->left_out && g < layout->groups; g++)
        for (int k = layout->row_at[g]; k < layout->row_at[g + 1]; k++)
            self->without[self->weighted->row[g] + k - layout->row_at[g]] = rank->left_out[k];
}

zd_singularity_monitor *zd_singularity_monitor_create(zd_store *store, const zd_point *point)
{
    zd_weighted *weighted = zd_weighted_create(store, point->layout);
    if (!weighted) return NULL;
    zd_singularity_monitor *self = zd_store_create(store, create, &(plan){point, weighted->blocks->rows});
    if (!self) return NULL;
    self->weighted = weighted;
    leave_out(self, point->rank);
    return self;
}

int zd_singularity_monitor_update(zd_singularity_monitor *self, const zd_point *point)
{
    if (zd_mass_factor(point, self->W) < point->system->nv) return 0;
    const zd_pivots pivots = zd_weighted_factor_without(self->weighted, point->terms.C, self->W, self->without);
    self->share = pivots.failed < 0 ? pivots.pivot / pivots.diagonal : 0x1p-52;     /* upper bound: rounding */
    self->smallest = pivots.failed < 0 ? pivots.smallest : pivots.failed;
    return 1;
}
