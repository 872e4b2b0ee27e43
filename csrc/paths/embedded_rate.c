/* Equations of motion of states in independent velocities on the closed-form path: a rate has the independent entries of pdot and vdot. */
#include <string.h>

#include "../linalg/small.h"
#include "path.h"

static void write_rates(const zd_motion *motion, const double *v, const double *pdot, const double *vdot, double power, double *ydot)
{
    zd_embed_write(motion, motion->point->terms.A ? pdot : v, vdot, ydot);
    if (motion->balance.input) ydot[motion->rate.size - 1] = power;
}

/* The state that was read, with its rates and the power, unless NULL */
static int find_stage(zd_motion *motion, double t, double *power)
{
    const zd_path *path = &motion->path;
    return zd_embed_entries(motion, t, path->state.q != NULL, NULL, &(zd_embedded){.pdot = path->pdot_of_stage, .vdot = path->vdot,
                                                                                  .power = power});
}

/* Rate after the point has been moved to the state: the stabilization terms of (6) depend on its p and v. */
static int rate_of_point(zd_motion *motion, double t, double *ydot)
{
    zd_path *path = &motion->path;
    zd_point *point = motion->point;
    int status = find_stage(motion, t, NULL);
    if (status) return status;
    zd_point_move(point, t, path->p, path->v);
    if (motion->corrections_size) point->known &= ~ZD_ACCELERATED;
    status = zd_motion_accelerate(motion);
    if (status) return status;
    write_rates(motion, point->v, path->pdot, point->vdot, path->power, ydot);
    if (motion->corrections_size) zd_motion_extra_rates(motion, ydot);
    return ZD_DONE;
}

/* True if the state that was read is that of the point, and the acceleration there is known. */
static int is_known(const zd_motion *motion, double t)
{
    const zd_point *point = motion->point;
    const zd_path *path = &motion->path;
    const int r = point->system->nv - zd_constraints(point->system);
    int same = (point->known & ZD_ACCELERATED) && t == point->t;
    for (int j = 0; j < r; j++) same &= path->v[path->state.u[j]] == point->v[path->state.u[j]];
    return same && !memcmp(path->p, point->p, point->system->nq * sizeof(double));
}

static int rate(void *context, double t, const double *y, double *ydot)
{
    zd_motion *motion = context;
    zd_path *path = &motion->path;
    zd_embed_read(motion, t, y);
    if (motion->is_stabilized) {
        motion->state = y;
        return rate_of_point(motion, t, ydot);
    }
    if (is_known(motion, t)) {
        write_rates(motion, motion->point->v, path->pdot, motion->point->vdot, path->power, ydot);
        return ZD_DONE;
    }
    double power = 0;
    int status = find_stage(motion, t, motion->balance.input ? &power : NULL);
    if (!status) write_rates(motion, path->v, path->pdot_of_stage, path->vdot, power, ydot);
    return status;
}

static int accelerate(zd_motion *motion)
{
    return zd_closed_form_accelerate(motion, zd_embed_accelerate);
}

/* Stages of a step do not move the point. */
static int expand(void *context, double t, const double *y, double *whole)
{
    zd_motion *motion = context;
    const zd_path *path = &motion->path;
    zd_embed_read(motion, t, y);
    int status = find_stage(motion, t, NULL);
    zd_copy_few(motion->system.nq, path->p, whole);
    zd_copy_few(motion->system.nv, path->v, whole + motion->system.nq);
    return status;
}

static int reduce(void *context, double t, const double *whole, double *y)
{
    const zd_motion *motion = context;
    (void)t;
    zd_embed_write(motion, whole, whole + motion->system.nq, y);
    return ZD_DONE;
}

static int finish(zd_motion *motion, double *y, int within)
{
    (void)within;       /* variables do not change within a step */
    return zd_embed_pack(motion, y);
}

const zd_equations zd_equations_of_independent = {accelerate, rate, zd_embed_unpack, zd_embed_pack, finish, expand, reduce, 0, 0};
