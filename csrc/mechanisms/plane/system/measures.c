/* Numerics of measures in the plane: see ../../common/output_spec.h. */
#include "system.h"

#include "../../../linalg/small.h"
#include "../../common/output_spec.h"
#include "../tree.h"

#define MECHANISM zd_plane
#define OF(name) zd_plane_##name
#define FORCES 2
#define TORQUES 1
#define VELOCITIES 3
#define MINUS zd_minus
#define POINT_OF zd_point_of

static void place(const void *mechanism, const void *frame, const double *p)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    zd_plane_tree_turn(&self->tree, p, at->sines);
    zd_plane_tree_place(&self->tree, p, at->sines, at->pose);
}

static void move(const void *mechanism, const void *frame, const double *v)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    zd_plane_tree_move(&self->tree, at->pose, v, at->twist);
}

static void write_row(const void *mechanism, const void *frame, int index, double scale, double *row, double *value)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    const zd_plane_quantity *quantity = self->quantity + index;
    const zd_plane_reading reading = zd_plane_quantity_read(quantity, at->pose);
    if (value) *value = reading.value;
    zd_clear(self->tree.nv, row);
    zd_plane_tree_inward(&self->tree, at->pose, quantity->first, scale, reading.first, row);
    zd_plane_tree_inward(&self->tree, at->pose, quantity->second, scale, reading.second, row);
}

static void write_vector(zd_vector what, double *to)
{
    to[0] = what.x, to[1] = what.y;
}

static void write_wrench(zd_plane_wrench from, double *to)
{
    write_vector(from.force, to);
    to[ZD_WRENCH_FORCE] = from.torque;
}

static int act_on_body(const zd_plane *self, const zd_plane_frame *frame, int body, double scale, zd_plane_wrench what, double *own)
{
    (void)frame;
    memset(own, 0, VELOCITIES * sizeof *own);
    if (!body) return -1;
    zd_plane_tree_act_on_free(self->tree.link + body, scale, what, own);
    return self->tree.link[body].coordinate;
}

#include "../../common/measures_of_dimension.h"
