/* Sparse variable partitioning. C = [C_u C_w] in some order of the velocities, C_w square: x_w follows from C x = rhs by
 *
 *     C_w^T W C_w dx_w = C_w^T W (rhs - C x)
 *
 * repeatedly, until the residual is rounding, with W the inverse squares of the rows' sizes. Its block rows are bodies, without their
 * independent velocities; redundant constraints have no weight. So D is never formed, and the matrix has the pattern of the bodies,
 * whatever is selected.
 *
 * The selection is an elimination, too: of C^T W C, all columns, outermost bodies first, so that velocities depend on those nearer to
 * the ground. A pivot is the squared residual norm of a velocity's column after those eliminated before are projected out: where it is
 * small, the velocity is independent of them, and left out. The threshold is the largest with which no more velocities are left out than
 * are independent.
 */
#include "partition.h"

#include <math.h>

#include "../../constraints/rank.h"
#include "../../linalg/iteration.h"
#include "../../linalg/small.h"
#include "../../point/point.h"

enum { MANY_JOINTS = 12 };      /* joints of a body above which it is eliminated last, as it would couple all its neighbours */
static const double LARGEST_SHARE = 0x1p-2, MIN_SHARE = 0x1p-40, SHRINK = 0x1p-2;    /* pivot thresholds relative to a column's square */
static const double WORSE = 0x1p-4;             /* ratio of the smallest pivot to its reference below which velocities are selected anew */
static const double FEW_DIGITS = 0x1p-20;       /* residual relative to these terms beyond which it is not rounding */

/* ---- symbolic ---- */

/* Appends the bodies that group g touches to those already reached. */
static int reach(const zd_layout *layout, int g, char *is_reached, int *reached, int count)
{
    for (int i = layout->touched_at[g]; i < layout->touched_at[g + 1]; i++) {
        const int b = layout->touched[i];
        if (is_reached[b]) continue;
        is_reached[b] = 1;
        reached[count++] = b;
    }
    return count;
}

static int reach_from(const zd_layout *layout, int next, char *is_met, char *is_reached, int *reached, int count)
{
    for (; next < count; next++)
        for (int i = layout->toucher_at[reached[next]]; i < layout->toucher_at[reached[next] + 1]; i++) {
            const int g = layout->toucher[i];
            if (!is_met[g]) count = reach(layout, g, is_reached, reached, count);
            is_met[g] = 1;
        }
    return count;
}

/* Orders all bodies from the ground outwards, breadth first; bodies not connected to it follow. */
static void find_outwards(const zd_layout *layout, char *is_reached, int *reached)
{
    char *is_met = is_reached + layout->blocks;
    int count = 0;
    for (int g = 0; g < layout->groups; g++)
        if (layout->touched_at[g + 1] - layout->touched_at[g] == 1) count = reach(layout, g, is_reached, reached, count);
    count = reach_from(layout, 0, is_met, is_reached, reached, count);
    for (int b = 0; b < layout->blocks; b++) {
        if (is_reached[b]) continue;
        is_reached[b] = 1;
        reached[count++] = b;
        count = reach_from(layout, count - 1, is_met, is_reached, reached, count);
    }
}

/* order (blocks,): outermost bodies first, those of many joints last */
static void find_order(const zd_layout *layout, const int *reached, int *order)
{
    int next = 0;
    for (int are_last = 0; are_last < 2; are_last++)
        for (int i = layout->blocks - 1; i >= 0; i--) {
            const int b = reached[i], has_many = layout->toucher_at[b + 1] - layout->toucher_at[b] > MANY_JOINTS;
            if (has_many == are_last) order[next++] = b;
        }
}

static zd_bodies *create_bodies(zd_store *store, const zd_point *point)
{
    const zd_layout *layout = point->layout;
    const size_t blocks = layout->blocks;
    int *reached = zd_allocate(2 * blocks * sizeof *reached);
    char *is_reached = zd_allocate(blocks + (size_t)layout->groups);
    zd_bodies *bodies = NULL;
    if (reached && is_reached) {
        find_outwards(layout, is_reached, reached);
        find_order(layout, reached, reached + blocks);
        bodies = zd_bodies_create(store, point->system, layout, reached + blocks);
    }
    zd_release(is_reached);
    zd_release(reached);
    return bodies;
}

zd_partition *zd_partition_create(zd_arena *arena, int nv, int rows, int independents)
{
    const size_t n = nv, m = rows;
    zd_partition self = {
        .independents = independents,
        .index = zd_arena_ints(arena, independents),
        .left_out = zd_arena_bytes(arena, n),
        .weight = zd_arena_doubles(arena, m),
        .residual = zd_arena_doubles(arena, m),
        .step = zd_arena_doubles(arena, n),
        .b = zd_arena_doubles(arena, n),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

int zd_partition_begin(zd_partition *self, zd_store *store, const zd_point *point, int rows)
{
    const unsigned char *follows = point->rank->left_out;
    self->bodies = create_bodies(store, point);
    self->rows = rows;
    for (int k = 0; k < rows; k++) self->weight[k] = follows && follows[k] ? 0 : point->inverse_size[k] * point->inverse_size[k];
    return self->bodies ? ZD_DONE : ZD_NO_MEMORY;
}

/* ---- factors ---- */

/* Eliminates. share >= 0: velocities with a smaller relative pivot are marked independent; share < 0: the marks are kept. */
static zd_pivots eliminate(zd_partition *self, double share)
{
    zd_blocks_clear(self->bodies->blocks);
    zd_bodies_add_rows(self->bodies, self->C, self->weight);
    return zd_bodies_leave_out(self->bodies, self->left_out, share);
}

static int count_independents(const zd_partition *self)
{
    int count = 0;
    for (int i = 0; i < self->bodies->blocks->rows; i++) count += self->left_out[i];
    return count;
}

static void note_independents(zd_partition *self)
{
    const zd_layout *layout = self->bodies->layout;
    int next = 0;
    for (int b = 0; b < layout->blocks; b++)
        for (int i = layout->velocity_at[b], place = self->bodies->at[b]; i < layout->velocity_at[b + 1]; i++, place++)
            if (self->left_out[place]) self->index[next++] = i;
}

static int choose(zd_partition *self, zd_point *point)
{
    self->C = point->terms.C;
    self->is_chosen = 0;
    for (double share = LARGEST_SHARE; share >= MIN_SHARE; share *= SHRINK) {
        const zd_pivots pivots = eliminate(self, share);
        const int count = count_independents(self);
        point->failed_index = pivots.failed < 0 ? 0 : zd_bodies_velocity(self->bodies, pivots.failed);
        if (count < self->independents) return ZD_SINGULAR;
        if (count > self->independents) continue;
        self->share = self->reference = pivots.pivot / pivots.diagonal;
        self->is_chosen = 1;
        note_independents(self);
        return ZD_DONE;
    }
    return ZD_SINGULAR;
}

int zd_partition_factor(zd_partition *self, zd_point *point)
{
    if (!self->is_chosen) return choose(self, point);
    self->C = point->terms.C;
    const zd_pivots pivots = eliminate(self, -1);
    self->share = pivots.failed < 0 ? pivots.pivot / pivots.diagonal : 0;
    self->reference = fmax(self->reference, self->share);
    if (pivots.failed < 0) return ZD_DONE;
    point->failed_index = zd_bodies_velocity(self->bodies, pivots.failed);
    return ZD_SINGULAR;
}

int zd_partition_review(zd_partition *self, zd_point *point, int is_factored)
{
    const int was_chosen = self->is_chosen, status = is_factored ? ZD_DONE : zd_partition_factor(self, point);
    if (!was_chosen || (!status && self->share > WORSE * self->reference)) return status;
    point->statistics->repartitions++;
    return choose(self, point);
}

/* ---- solution ---- */

static double find_residual(zd_partition *self, const double *rhs, const double *x)
{
    double square;
    return zd_packed_residual(self->bodies->layout, self->C, self->rows, rhs, x, self->weight, self->residual, &square);
}

int zd_partition_solve(zd_partition *self, const double *rhs, double *x)
{
    const int n = self->bodies->blocks->rows;
    double before = INFINITY, left = find_residual(self, rhs, x);
    for (int i = 0; i < ZD_MAX_REFINEMENTS && left > ZD_RESIDUAL_ROUNDING && left < 0.5 * before; i++) {
        zd_clear(n, self->b);
        for (int k = 0; k < self->rows; k++) {
            const zd_row_of_C row = zd_packed_row(self->bodies->layout, self->C, k);
            for (int j = 0; j < row.count; j++) self->b[row.column[j]] += row.x[j] * (self->weight[k] * self->residual[k]);
        }
        zd_bodies_solve(self->bodies, self->b, self->step);
        for (int j = 0; j < n; j++) x[j] += self->step[j];
        before = left;
        left = find_residual(self, rhs, x);
    }
    return left <= FEW_DIGITS ? ZD_DONE : ZD_SINGULAR;
}
