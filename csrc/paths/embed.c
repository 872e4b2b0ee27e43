/* Closed-form path of formulations in independent velocities. The state consists of entries of p and v; a system's embed() computes the
 * dependent ones and the accelerations:
 *
 *     w = -W^-1 (U u + Phi_t)                 (14), (16): dependent velocities w, C = [U W]
 *     p <- p - dp until every |Phi| is small  (18), if p is not part of the state; dp changes dependent coordinates only
 *
 * The formulation chooses the independent entries, on the matrix path: a step at whose end a dependent velocity depends more steeply on
 * the independent ones than the formulation allows is repeated there.
 */
#include "path.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/point.h"

enum { MAX_ITERATIONS = 8 };
static const double CONSTRAINT_ROUNDING = 16 * 0x1p-52; /* residual of Phi after convergence, relative to the sizes of Phi and p */
static const double MIN_TERMS = 16; /* number of terms of a constraint up to which CONSTRAINT_ROUNDING suffices */

void zd_embed_create(zd_motion *motion, zd_arena *arena)
{
    const zd_system *system = &motion->system;
    zd_path *path = &motion->path;
    const size_t nv = system->nv, m = zd_constraints(system), mh = system->mh;
    path->embeds = 1;
    if (motion->solver) motion->formulation->entries(motion->solver, &path->state);
    path->p = zd_arena_doubles(arena, system->nq);
    path->v = zd_arena_doubles(arena, nv);
    path->vdot = zd_arena_doubles(arena, nv);
    path->pdot_of_stage = zd_arena_doubles(arena, system->nq);
    path->Phi = zd_arena_doubles(arena, mh);
    path->unbounded = zd_arena_doubles(arena, mh);
    path->D = zd_arena_doubles(arena, m * (nv - m));
    for (size_t k = 0; path->unbounded && k < mh; k++) path->unbounded[k] = INFINITY;
}

/* ---- the order for the state's velocities ---- */

static int solves_for(const zd_elimination *order, int m, int j)
{
    for (int k = 0; k < m; k++)
        if (order->column[k] == j) return 1;
    return 0;
}

int zd_embed_find(zd_motion *motion)
{
    const int m = zd_constraints(&motion->system), r = motion->system.nv - m;
    zd_path *path = &motion->path;
    if (!motion->formulation->entries || !motion->formulation->entries(motion->solver, &path->state)) return -1;
    for (int i = 0; i < path->orders; i++) {
        int serves = 1;
        for (int j = 0; j < r; j++) serves &= !solves_for(path->first + i, m, path->state.u[j]);
        if (serves) return i;
    }
    return -1;
}

void zd_embed_begin(zd_motion *motion)
{
    const zd_point *point = motion->point;
    if (!motion->path.state.q) return;
    const double of_p = fmax(1, zd_max_scaled(point->system->nq, point->p, point->inverse_unit_p));
    const double terms = fmax(1, point->system->nv / MIN_TERMS);
    for (int k = 0; k < point->system->mh; k++) motion->path.allowed[k] = CONSTRAINT_ROUNDING * terms * of_p * point->size[k];
}

int zd_embed_is_steep(const zd_motion *motion)
{
    const zd_point *point = motion->point;
    const zd_elimination *order = zd_path_order(motion);
    const int m = zd_constraints(&motion->system), n = motion->system.nv;
    const double *D = motion->path.D;
    double steepest = 0;
    for (int j = 0; j < n; j++) {
        if (solves_for(order, m, j)) continue;
        for (int k = 0; k < m; k++) steepest = fmax(steepest, fabs(D[k * (n - m)]) * point->inverse_unit[order->column[k]] * point->unit[j]);
        D++;
    }
    return !(steepest <= motion->path.state.steepest);
}

/* ---- conversion between the state and p, v ---- */

/* Number of entries of p in the state */
static int positions(const zd_motion *motion)
{
    const zd_system *system = &motion->system;
    return motion->path.state.q ? system->nv - system->mh : system->nq;
}

/* p <- estimate at time t, by extrapolation from the point. */
static void predict(const zd_motion *motion, double t, double *p)
{
    const zd_point *point = motion->point;
    const double h = t - point->t, half = point->known & ZD_ACCELERATED ? h / 2 : 0;
    for (int i = 0; i < point->system->nq; i++) p[i] = point->p[i] + h * (point->v[i] + half * (half != 0 ? point->vdot[i] : 0));
}

void zd_embed_read(zd_motion *motion, double t, const double *y)
{
    zd_path *path = &motion->path;
    const zd_system *system = &motion->system;
    const int k = positions(motion), r = system->nv - zd_constraints(system);
    if (path->state.q) predict(motion, t, path->p);
    for (int i = 0; i < k; i++) path->p[path->state.q ? path->state.q[i] : i] = y[i];
    /* Dependent velocities start from zero, so that their bits depend on the independent ones only. */
    zd_clear(system->nv, path->v);
    for (int j = 0; j < r; j++) path->v[path->state.u[j]] = y[k + j];
}

static void read_point(zd_motion *motion)
{
    const zd_point *point = motion->point;
    zd_path *path = &motion->path;
    const int r = point->system->nv - zd_constraints(point->system);
    zd_copy_few(point->system->nq, point->p, path->p);
    zd_clear(point->system->nv, path->v);
    for (int j = 0; j < r; j++) path->v[path->state.u[j]] = point->v[path->state.u[j]];
}

void zd_embed_write(const zd_motion *motion, const double *p, const double *v, double *y)
{
    const zd_entries *state = &motion->path.state;
    const int k = positions(motion), r = motion->system.nv - zd_constraints(&motion->system);
    for (int i = 0; i < k; i++) y[i] = p[state->q ? state->q[i] : i];
    for (int j = 0; j < r; j++) y[k + j] = v[state->u[j]];
}

/* ---- dependent coordinates, velocities and accelerations ---- */

typedef struct embedding {
    zd_iterate it;
    const double *added, *allowed;
    const zd_embedded *to;
} embedding;

ZD_INLINE int call_embed(const zd_iterate *it)
{
    const embedding *self = (const embedding *)it;
    const zd_embedded *to = self->to;
    const zd_motion *motion = it->motion;
    const zd_elimination *order = zd_path_order(motion);
    return order->embed(order, motion->system.data, motion->rate.inputs, it->t, it->p, it->v, self->added, self->allowed, motion->path.Phi,
                        motion->path.dp, to->D, to->pdot, to->vdot, to->lambda, to->power, to->pivots);
}

int zd_embed_entries(zd_motion *motion, double t, int finds_p, const double *added, const zd_embedded *to)
{
    const zd_path *path = &motion->path;
    const embedding self = {{motion, &t, path->p, path->v}, added, finds_p ? path->allowed : path->unbounded, to};
    double left;
    int iterations;
    const int status = zd_iterate_in_closed_form(&self.it, call_embed, finds_p ? MAX_ITERATIONS : 0, path->Phi, &iterations, &left);
    if (!status) motion->statistics.embedding_iterations += iterations;
    return !status || status == ZD_CALLBACK ? status : ZD_NO_EMBEDDING;
}

/* The same with D, accelerations, multipliers, power and pivots of the point. */
static int embed_point(zd_motion *motion, double t, int finds_p, const double *added)
{
    zd_path *path = &motion->path;
    const zd_embedded of_point = {path->D, path->pdot, motion->point->vdot, motion->point->lambda,
                                  motion->balance.input ? &path->power : NULL, path->pivots};
    return zd_embed_entries(motion, t, finds_p, added, &of_point);
}

int zd_embed_accelerate(zd_motion *motion, const double *added)
{
    read_point(motion);
    return embed_point(motion, motion->point->t, 0, added);
}

/* ---- the end of a step ---- */

static void move_there(zd_motion *motion, double t)
{
    zd_point_move(motion->point, t, motion->path.p, motion->path.v);
    if (!motion->is_stabilized) motion->point->known |= ZD_ACCELERATED;
    else motion->point->known &= ~ZD_ACCELERATED;       /* it lacks the stabilization terms of (6) */
}

int zd_embed_unpack(zd_motion *motion, double t, double *y)
{
    zd_path *path = &motion->path;
    zd_embed_read(motion, t, y);
    const int finds_p = path->state.q != NULL, is_corrected_first = !finds_p && motion->corrections < 2;
    if (!finds_p) zd_quaternions_normalise(&motion->system, path->p);
    int status = is_corrected_first ? ZD_DONE : embed_point(motion, t, finds_p, NULL);
    if (status) return status;
    move_there(motion, t);
    if (is_corrected_first) motion->point->known &= ~ZD_ACCELERATED;
    return ZD_DONE;
}

int zd_embed_update(zd_motion *motion)
{
    const zd_point *point = motion->point;
    if (point->known & ZD_ACCELERATED) return ZD_DONE;
    read_point(motion);
    int status = embed_point(motion, point->t, 0, NULL);
    if (!status) move_there(motion, point->t);
    return status;
}

int zd_embed_pack(zd_motion *motion, double *y)
{
    zd_embed_write(motion, motion->point->p, motion->point->v, y);
    return zd_embed_update(motion);
}
