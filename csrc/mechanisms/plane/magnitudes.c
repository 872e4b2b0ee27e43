/* Magnitudes of the gradients of constraints before cancellation.
 *
 * In joint coordinates a constraint that the tree already satisfies, as a brace between bodies that are welded together, has a gradient that
 * is the difference of equal terms: rounding. Its size is therefore not taken from C but from the terms: a unit vector for a velocity of a
 * mass centre; for an angular velocity a unit vector times a lever arm, at most the mechanism's length and the distances of both points from
 * the origin.
 */
#include "magnitudes.h"

#include "../common/actions.h"
#include "../../linalg/roots.h"
#include "marker_quantity.h"
#include "plan.h"

static double distance_of(const zd_plane_pose *pose, const double *point)
{
    return zd_hypotenuse(pose->at.x, pose->at.y) + zd_hypotenuse(point[0], point[1]);
}

static void add(const zd_readings *at, void *to, int quantity, double factor)
{
    const zd_plane *self = at->mechanism;
    const zd_plane_pose *pose = ((const zd_plane_frame *)at->frame)->pose;
    const zd_plane_quantity *of = self->quantity + quantity;
    double *magnitude = to;
    const double size = fabs(factor);
    if (of->kind == ZD_PLANE_ANGLE) {
        magnitude[1] += size;
        return;
    }
    const double lever = distance_of(pose + of->first, of->point1) + distance_of(pose + of->second, of->point2);
    magnitude[0] += size;
    magnitude[1] += size * (self->system.length + lever);
}

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_plane *self = data;
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    const zd_readings readings = zd_plane_frame_readings(self, &frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    zd_plane_tree_turn(&self->tree, p, frame.sines);
    zd_plane_tree_place(&self->tree, p, frame.sines, frame.pose);
    zd_plane_tree_move(&self->tree, frame.pose, v, frame.twist);
    return zd_rows_magnitudes(&actions, t, magnitude);
}
