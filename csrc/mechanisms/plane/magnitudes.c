/* Magnitudes of the gradients of constraints before cancellation.
 *
 * In joint coordinates a constraint that the tree already satisfies, as a brace between bodies that are welded together, has a gradient that
 * is the difference of equal terms: rounding. Its size is therefore not taken from C but from the terms: a unit vector for a velocity of a
 * mass centre; for an angular velocity a unit vector times a lever arm, at most the mechanism's length and the distances of both points from
 * the origin.
 */
#include "magnitudes.h"

#include "../common/laws.h"
#include "../../linalg/roots.h"
#include "marker_quantity.h"
#include "plan.h"

static double distance_of(const zd_plane_pose *pose, const double *point)
{
    return zd_hypotenuse(pose->at.x, pose->at.y) + zd_hypotenuse(point[0], point[1]);
}

static void add(const zd_plane *self, const zd_plane_frame *frame, int quantity, double factor, double *magnitude)
{
    const zd_plane_quantity *of = self->quantity + quantity;
    const double size = fabs(factor);
    if (of->kind == ZD_PLANE_ANGLE) {
        magnitude[1] += size;
        return;
    }
    const double lever = distance_of(frame->pose + of->first, of->point1) + distance_of(frame->pose + of->second, of->point2);
    magnitude[0] += size;
    magnitude[1] += size * (self->system.length + lever);
}

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_plane *self = data;
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    const zd_readings readings = zd_plane_frame_readings(self, &frame);
    zd_plane_tree_turn(&self->tree, p, frame.sines);
    zd_plane_tree_place(&self->tree, p, frame.sines, frame.pose);
    zd_plane_tree_move(&self->tree, frame.pose, v, frame.twist);
    for (int i = 0; i < self->elements.m; i++, magnitude += 2) {
        const zd_relation *row = self->elements.row + i;
        zd_combined all;
        const int status = zd_combine(&self->elements, &readings, row, t, &all);
        if (status) return status;
        magnitude[0] = magnitude[1] = 0;
        for (int k = 0; k < row->terms; k++) add(self, &frame, self->elements.term[row->first + k].quantity, all.factors[k], magnitude);
    }
    return ZD_DONE;
}
