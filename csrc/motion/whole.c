/* All of p and v, and states in independent velocities: for integrators whose polynomial is that of (p, v). */
#include "../linalg/small.h"
#include "embed.h"

/* Stages of a step on the closed-form path do not move the point. */
static int expand_directly(zd_motion *motion, double t, const double *y)
{
    const zd_path *path = &motion->path;
    zd_embed_read(motion, t, y);
    return zd_embed_entries(motion, t, path->state.q != NULL, NULL, &(zd_embedded){.pdot = path->pdot_of_stage, .vdot = path->vdot});
}

int zd_motion_expand(void *context, double t, const double *y, double *whole)
{
    zd_motion *motion = context;
    const zd_point *point = motion->point;
    const int is_direct = zd_is_embedded(motion);
    int status = is_direct ? expand_directly(motion, t, y) : motion->formulation->enter(motion->solver, motion->point, t, y);
    zd_copy_all(motion->system.nq, is_direct ? motion->path.p : point->p, whole);
    zd_copy_all(motion->system.nv, is_direct ? motion->path.v : point->v, whole + motion->system.nq);
    return status;
}

int zd_motion_reduce(void *context, double t, const double *whole, double *y)
{
    zd_motion *motion = context;
    const double *v = whole + motion->system.nq;
    if (zd_is_embedded(motion)) {
        zd_embed_write(motion, whole, v, y);
        return ZD_DONE;
    }
    zd_point_move(motion->point, t, whole, v);
    return motion->formulation->express(motion->solver, motion->point, y);
}
