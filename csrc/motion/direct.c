/* Which road a step takes: that of the system's direct functions, in which the constraints are eliminated in closed form, or the general one.
 *
 * Direct functions know no rank, no bifurcation and no pivoting: they divide by what they were written to divide by. All of these show in the
 * pivots. A step takes the direct road where those of one order of elimination are large enough at its beginning, and it is believed
 * where they have kept their signs and, but for a factor, their sizes until its end. Otherwise it is made on the general road, where
 * matrices are ranked and factored, and where orientations are compared.
 *
 * The pivots of the rows are measured by the sizes that these rows of C had at the start, in natural units.
 */
#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "embed.h"
#include "pivots.h"

static const double LARGE = 0x1p-3;     /* the first order with such pivots is taken, */
static const double LARGE_ENOUGH = 0x1p-5;  /* or else, for a step to begin with, the first with these; x0 + D a then loses some five bits in
                                             * D and ten in M */
static const double SMALL = 0x1p-6;         /* for a step to end with: the general road counts less of a row as ill-conditioned, too */
static const double SHRUNK = 0x1p-4;    /* within a step: what lies between its ends is then no longer known from them */
static const double LIGHT = 0x1p-20;        /* of the diagonal of D^T M D: less of it has lost too many of its 53 bits */
static const double LONG = 1;               /* in natural units: a longer path is looked at in between, on the general road */

const zd_direct *zd_direct_of(const zd_system *system, const zd_formulation *formulation, enum zd_unit unit)
{
    if (zd_constraints(system) > system->nv || (formulation->settle && !formulation->may_have_entries(system))) return NULL;
    const zd_direct *found = NULL;
    for (int i = 0; i < system->directs; i++) {
        const zd_direct *direct = &system->direct[i];
        if (!(formulation->settle ? direct->embeddings : direct->orders)) continue;
        if (direct->lanes == 1 && direct->unit <= unit && (!found || direct->unit > found->unit)) found = direct;
    }
    return found;
}

void zd_direct_take(zd_motion *motion, zd_arena *arena, enum zd_unit unit)
{
    const zd_system *system = &motion->system;
    const zd_direct *direct = zd_direct_of(system, motion->formulation, unit);
    if (!direct) return;
    const int embeds = motion->formulation->settle != NULL, orders = embeds ? direct->embeddings : direct->orders;
    motion->path = (zd_path){
        .direct = direct,
        .first = embeds ? direct->embedding : direct->order,
        .orders = orders,
        .scale = zd_take_doubles(arena, (size_t)(orders * system->nv)),
        .pivots = zd_take_doubles(arena, (size_t)system->nv),
        .before = zd_take_doubles(arena, (size_t)system->nv),
        .pdot = zd_take_doubles(arena, (size_t)system->nq),
        .range = zd_take(arena, (size_t)system->nv * sizeof(zd_range)),
        .dp = zd_take_doubles(arena, (size_t)system->nq),
        .allowed = zd_take_doubles(arena, (size_t)system->mh),
    };
    if (embeds) zd_embed_take(&motion->path, arena, system);
}

static double *scale_of(const zd_motion *motion, const zd_elimination *order)
{
    return motion->path.scale + (order - motion->path.first) * motion->system.nv;
}

/* A determinant is a product of an entry from each of its rows and columns, and so is what it is measured by. Pivots of D^T M D are shares
 * already: they are weighed so that LARGE means LIGHT. */
static void measure(const zd_motion *motion, const zd_elimination *order)
{
    const zd_point *point = motion->point;
    double *scale = scale_of(motion, order);
    for (int k = 0; k < motion->system.nv; k++) scale[k] = k < order->solves ? 1 : LARGE / LIGHT;
    for (int k = 0; k < zd_constraints(&motion->system); k++)
        scale[order->solve[k]] *= point->unit[order->column[k]] * point->inverse_size[order->row[k]];
}

void zd_direct_measure(zd_motion *motion)
{
    for (int i = 0; i < motion->path.direct->orders; i++) measure(motion, motion->path.direct->order + i);
}

/* The smallest pivot of the rows at the point, in parts of what it is measured by; 0: D^T M D has lost too much, or one is no number */
static double smallest_pivot(const zd_motion *motion)
{
    const zd_elimination *order = motion->path.order;
    const double *pivots = motion->path.pivots, *scale = scale_of(motion, order);
    const int solves = order->solves, all = solves + motion->system.nv - zd_constraints(&motion->system);
    double smallest = INFINITY;
    for (int k = 0; k < solves; k++) {
        const double share = fabs(pivots[k]) * scale[k];
        if (!(share >= smallest)) smallest = share == share ? share : 0;
    }
    for (int k = solves; k < all; k++)
        if (!(pivots[k] >= LIGHT)) return 0;
    return smallest;
}

static int count_pivots(const zd_motion *motion)
{
    return motion->path.order->solves + motion->system.nv - zd_constraints(&motion->system);
}

/* Whether a step ends with the projection, after which the energy may be corrected, and nothing else is integrated or added. */
static int ends_with_projection(const zd_motion *motion)
{
    const zd_constraint_target *target = &motion->target;
    return !motion->is_stabilized && target->positions && target->velocities && target->in_mass_metric && motion->corrects == (ZD_PHI | ZD_C)
        && motion->rate.size == motion->formulation_size;
}

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static const zd_range NOWHERE = {UINT64_MAX, 0};    /* but at a number that is none */

/* Of another order: a glance says nothing of them until they have been compared. */
static void forget_pivots(zd_motion *motion)
{
    motion->path.ranges = count_pivots(motion);
    for (int k = 0; k < motion->system.nv; k++) {
        motion->path.pivots[k] = 0;
        motion->path.range[k] = NOWHERE;
    }
}

/* Where those of the next step may be for a glance to be enough, if the order is the first: large, and within a factor of four, so that of
 * two steps none has shrunk by more than sixteen in the second. */
static void remember_pivots(zd_motion *motion)
{
    zd_path *path = &motion->path;
    const double *scale = scale_of(motion, path->order), factor = 1 / sqrt(SHRUNK);
    if (path->order != path->first) return;
    for (int k = 0; k < count_pivots(motion); k++) {
        const double x = path->pivots[k], least = fmax(fabs(x) / factor, LARGE / scale[k]), most = fabs(x) * factor;
        const uint64_t from = bits_of(copysign(least, x)), to = bits_of(copysign(most, x));
        path->range[k] = least <= most ? (zd_range){from, to - from} : NOWHERE;
    }
}

static void use(zd_motion *motion, const zd_elimination *order)
{
    if (motion->path.order == order) return;
    motion->point->known &= ~ZD_ACCELERATED;
    motion->path.order = order;
    motion->path.continues = 0;
    if (order) forget_pivots(motion);
    motion->path.lands = order && order->land && ends_with_projection(motion);
    for (int k = 0; k < motion->system.mh; k++) motion->path.allowed[k] = motion->target.tolerance * motion->point->size[k];
    const int embeds = motion->path.embeds;
    motion->rate.evaluate = !order ? zd_motion_rate : embeds ? zd_motion_embedded_rate : zd_motion_direct_rate;
    motion->rate.direct = motion->is_stabilized || embeds || motion->rate.size > motion->formulation_size ? NULL : order;
}

void zd_direct_leave(zd_motion *motion)
{
    use(motion, NULL);
}

void zd_direct_remember_energy(zd_motion *motion)
{
    motion->path.energy_skipped = motion->statistics.energy_skipped;
    motion->path.energy_corrections = motion->statistics.energy_corrections;
    motion->path.energy_corrected = motion->statistics.energy_corrected;
    motion->path.skipped_since_row = motion->tally->energy_skipped;
}

void zd_direct_forget_energy(zd_motion *motion)
{
    motion->statistics.energy_skipped = motion->path.energy_skipped;
    motion->statistics.energy_corrections = motion->path.energy_corrections;
    motion->statistics.energy_corrected = motion->path.energy_corrected;
    motion->tally->energy_skipped = motion->path.skipped_since_row;
}

/* A step that begins at the point. */
static void begin(zd_motion *motion)
{
    zd_copy_all(count_pivots(motion), motion->path.pivots, motion->path.before);
    zd_direct_remember_energy(motion);
    if (motion->path.embeds) zd_embed_begin(motion);
}

/* Whether the pivots of an order are so large at the point. */
static int takes(zd_motion *motion, const zd_elimination *order, double enough)
{
    if (!(*scale_of(motion, order) > 0)) measure(motion, order);
    use(motion, order);
    if (zd_motion_accelerate(motion) || !(smallest_pivot(motion) >= enough)) return 0;
    begin(motion);
    return 1;
}

/* The first order whose pivots are so large at the point, if there is one. */
static int find_order(zd_motion *motion, double enough)
{
    const zd_path *path = &motion->path;
    for (int i = 0; i < path->orders; i++)
        if (takes(motion, path->first + i, enough)) return 1;
    return 0;
}

/* For a state in independent velocities there is one at most. */
static int find_embedding(zd_motion *motion)
{
    const zd_elimination *order = zd_embed_find(motion);
    return order && takes(motion, order, LARGE_ENOUGH);
}

void zd_direct_choose(zd_motion *motion)
{
    const zd_path *path = &motion->path;
    int all_count = motion->point->rank->most_rows == zd_constraints(&motion->system);
    /* Mostly it is the one of the step before, whose end this is. */
    if (all_count && path->order == path->first && (motion->point->known & ZD_ACCELERATED) && path->smallest >= LARGE) begin(motion);
    else if (!all_count || !(path->embeds ? find_embedding(motion) : find_order(motion, LARGE) || find_order(motion, LARGE_ENOUGH)))
        use(motion, NULL);
}

int zd_direct_compare(zd_motion *motion, double moved)
{
    zd_path *path = &motion->path;
    int status = zd_motion_accelerate(motion);
    if (status) return status;
    const double smallest = smallest_pivot(motion);
    if (!(moved <= LONG * LONG) || !(smallest >= SMALL)) return ZD_SINGULAR;
    const int count = count_pivots(motion);
    for (int k = 0; k < count; k++)     /* one that has changed its sign has shrunk, too */
        if (!(path->pivots[k] * path->before[k] >= SHRUNK * path->before[k] * path->before[k])) return ZD_SINGULAR;
    if (path->embeds && zd_embed_is_steep(motion)) return ZD_SINGULAR;
    path->smallest = smallest;
    path->was_taken = 1;
    remember_pivots(motion);
    return ZD_DONE;
}
