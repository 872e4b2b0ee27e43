/* Evaluation path of a step: the closed-form path, by the system's closed-form functions, or the matrix path.
 *
 * Closed-form functions eliminate the constraints along a fixed order, without rank decisions and without pivoting. Loss of rank and
 * bifurcations show in their pivots. A step takes the closed-form path if the pivots of one elimination order are large enough at its
 * start; it is accepted if until its end they have kept their signs and have not shrunk by more than a factor. Otherwise the step takes
 * the matrix path, where C is ranked, matrices are factored, and orientations are compared.
 *
 * Pivots of constraints are measured by the sizes that these rows of C had at the start of the run, in characteristic scales.
 */
#include "path.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../step_limits.h"

static double *scale_of(const zd_motion *motion, int order)
{
    return motion->path.scale + order * motion->system.nv;
}

/* Scale of each pivot. A determinant is a sum of products of one entry from each row and column, and so is its scale. Pivots of D^T M D are
 * relative already; their factor makes ZD_LARGE_PIVOT mean ZD_LOST_PIVOT. */
static void measure(const zd_motion *motion, int i)
{
    const zd_point *point = motion->point;
    const zd_elimination *order = motion->path.first + i;
    double *scale = scale_of(motion, i);
    for (int k = 0; k < motion->system.nv; k++) scale[k] = k < order->solves ? 1 : ZD_LARGE_PIVOT / ZD_LOST_PIVOT;
    for (int k = 0; k < zd_constraints(&motion->system); k++)
        scale[order->solve[k]] *= point->unit[order->column[k]] * point->inverse_size[order->row[k]];
}

void zd_closed_form_find_scales(zd_motion *motion)
{
    for (int i = 0; i < motion->path.orders; i++) measure(motion, i);
}

/* Smallest relative pivot of the constraints at the point; 0 if D^T M D has lost too many bits, or a pivot is NaN */
static double smallest_pivot(const zd_motion *motion)
{
    const double *pivots = motion->path.pivots, *scale = scale_of(motion, motion->path.order);
    const int solves = zd_path_order(motion)->solves, all = solves + motion->system.nv - zd_constraints(&motion->system);
    double smallest = INFINITY;
    for (int k = 0; k < solves; k++) {
        const double share = fabs(pivots[k]) * scale[k];
        if (!(share >= smallest)) smallest = share == share ? share : 0;
    }
    for (int k = solves; k < all; k++)
        if (!(pivots[k] >= ZD_LOST_PIVOT)) return 0;
    return smallest;
}

static int count_pivots(const zd_motion *motion)
{
    return zd_path_order(motion)->solves + motion->system.nv - zd_constraints(&motion->system);
}

/* True if a step ends with the projection, optionally followed by the energy correction, and nothing else is integrated or added. */
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

static const zd_range NOWHERE = {UINT64_MAX, 0};    /* contains no finite number */

/* Clears pivots and ranges after a change of the order: the quick check fails until a full comparison has set them. */
static void discard_pivots(zd_motion *motion)
{
    motion->path.ranges = count_pivots(motion);
    for (int k = 0; k < motion->system.nv; k++) {
        motion->path.pivots[k] = 0;
        motion->path.range[k] = NOWHERE;
    }
}

/* Ranges in which pivots of the next step pass the quick check, if the order is the first: large, and within a factor of four, so that none
 * has shrunk by more than sixteen from one step to the next. */
static void save_pivots(zd_motion *motion)
{
    zd_path *path = &motion->path;
    const double *scale = scale_of(motion, path->order), factor = 1 / sqrt(ZD_SHRUNK_PIVOT);
    if (path->order) return;
    for (int k = 0; k < count_pivots(motion); k++) {
        const double x = path->pivots[k], least = fmax(fabs(x) / factor, ZD_LARGE_PIVOT / scale[k]), most = fabs(x) * factor;
        const uint64_t from = bits_of(copysign(least, x)), to = bits_of(copysign(most, x));
        path->range[k] = least <= most ? (zd_range){from, to - from} : NOWHERE;
    }
}

/* True if the order alone gives the rate of the state. */
static int gives_rate(const zd_motion *motion)
{
    const zd_path *path = &motion->path;
    return path->order >= 0 && !motion->is_stabilized && !path->embeds && motion->rate.size == motion->formulation_size;
}

void zd_path_bind(zd_motion *motion)
{
    if (zd_has_closed_form(motion)) motion->equations = motion->path.order < 0 ? &zd_equations_by_matrices : motion->path.equations;
    zd_motion_describe_rate(motion);
    motion->rate.closed_form = gives_rate(motion) ? zd_path_order(motion) : NULL;
    motion->rate.vdot = motion->path.is_plain ? motion->point->vdot : NULL;
}

/* Sets the path of this elimination order, negative: by matrices, and all that follows from it: functions, rate, ranges of the pivots. */
static void set_order(zd_motion *motion, int i)
{
    zd_path *path = &motion->path;
    if (path->order == i) return;
    const zd_elimination *order = i < 0 ? NULL : path->first + i;
    motion->point->known &= ~ZD_ACCELERATED;
    path->order = i;
    path->continues = 0;
    if (order) discard_pivots(motion);
    path->finishes = order && order->finish && ends_with_projection(motion);
    for (int k = 0; k < motion->system.mh; k++) path->allowed[k] = motion->target.tolerance * motion->point->size[k];
    path->is_plain = path->finishes && gives_rate(motion) && motion->target.every == 1 && !motion->point->terms.A
        && !motion->system.quaternions;
    zd_path_bind(motion);
}

int zd_closed_form_leave(zd_motion *motion)
{
    const int was_taken = motion->path.order >= 0;
    set_order(motion, -1);
    return was_taken;
}

void zd_closed_form_discard(zd_motion *motion)
{
    const zd_path *path = &motion->path;
    zd_closed_form_leave(motion);
    zd_clear(path->orders * motion->system.nv, path->scale);
}

void zd_closed_form_save_energy(zd_motion *motion)
{
    motion->path.energy_skipped = motion->statistics.energy_skipped;
    motion->path.energy_corrections = motion->statistics.energy_corrections;
    motion->path.energy_corrected = motion->statistics.energy_corrected;
    motion->path.skipped_since_row = motion->tally->energy_skipped;
}

int zd_closed_form_leave_step(zd_motion *motion)
{
    if (!zd_closed_form_leave(motion)) return 0;
    motion->path.was_taken = 0;
    motion->statistics.energy_skipped = motion->path.energy_skipped;
    motion->statistics.energy_corrections = motion->path.energy_corrections;
    motion->statistics.energy_corrected = motion->path.energy_corrected;
    motion->tally->energy_skipped = motion->path.skipped_since_row;
    return 1;
}

/* Saves pivots and energy counters at the start of a step. */
static void begin(zd_motion *motion)
{
    zd_copy_few(count_pivots(motion), motion->path.pivots, motion->path.before);
    zd_closed_form_save_energy(motion);
    if (motion->path.embeds) zd_embed_begin(motion);
}

/* Selects the order and returns true if its relative pivots at the point are at least `enough`. */
static int takes(zd_motion *motion, int order, double enough)
{
    if (!(*scale_of(motion, order) > 0)) measure(motion, order);
    set_order(motion, order);
    if (zd_motion_accelerate(motion) || !(smallest_pivot(motion) >= enough)) return 0;
    begin(motion);
    return 1;
}

/* Selects the first order whose relative pivots at the point are at least `enough`; 0 if there is none. */
static int find_order(zd_motion *motion, double enough)
{
    for (int i = 0; i < motion->path.orders; i++)
        if (takes(motion, i, enough)) return 1;
    return 0;
}

/* Selects the order for a state in independent velocities: at most one fits. */
static int find_embedding(zd_motion *motion)
{
    const int order = zd_embed_find(motion);
    return order >= 0 && takes(motion, order, ZD_SUFFICIENT_PIVOT);
}

int zd_closed_form_choose(zd_motion *motion)
{
    const zd_path *path = &motion->path;
    int all_count = motion->point->rank->max_rank == zd_constraints(&motion->system);
    /* Usually the order of the previous step, which ended at this point. */
    if (all_count && path->order == 0 && (motion->point->known & ZD_ACCELERATED) && path->smallest >= ZD_LARGE_PIVOT) begin(motion);
    else if (!all_count || !(path->embeds ? find_embedding(motion) : find_order(motion, ZD_LARGE_PIVOT) ||
                             find_order(motion, ZD_SUFFICIENT_PIVOT)))
        set_order(motion, -1);
    return path->order >= 0;
}

int zd_closed_form_resume(zd_motion *motion)
{
    motion->path.was_taken = 1;
    return zd_closed_form_choose(motion);
}

int zd_closed_form_compare(zd_safeguards *safeguards, double h, double moved)
{
    (void)h;
    zd_motion *motion = safeguards->guard.motion;
    zd_path *path = &motion->path;
    int status = zd_motion_accelerate(motion);
    if (status) return status;
    const double smallest = smallest_pivot(motion);
    if (!(moved <= ZD_FAR_PATH * ZD_FAR_PATH) || !(smallest >= ZD_SMALL_PIVOT)) return ZD_SINGULAR;
    const int count = count_pivots(motion);
    for (int k = 0; k < count; k++)     /* a pivot that has changed its sign fails, too */
        if (!(path->pivots[k] * path->before[k] >= ZD_SHRUNK_PIVOT * path->before[k] * path->before[k])) return ZD_SINGULAR;
    if (path->embeds && zd_embed_is_steep(motion)) return ZD_SINGULAR;
    path->smallest = smallest;
    path->was_taken = 1;
    save_pivots(motion);
    return ZD_DONE;
}
