/* Magnitudes of the gradients of constraints and of generalized forces before cancellation.
 *
 * In joint coordinates a constraint that the tree already satisfies, as a brace between bodies that are welded together, has a gradient that
 * is the difference of equal terms: rounding. Its size is therefore not taken from C but from the terms: a unit vector for a velocity of a
 * mass centre; for an angular velocity a unit vector times a lever arm, at most the mechanism's length and the distances of both points from
 * the origin. A force on a body has a moment with the mechanism's length and the distance of the body from the origin as lever arm.
 */
#include "plan.h"

#include "../../linalg/roots.h"
#include "../common/actions.h"
#include "tree.h"

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

static zd_plane_frame placed(const zd_plane *self, const double *p, const double *v, double *scratch)
{
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    zd_plane_tree_turn(&self->tree, p, frame.sines);
    zd_plane_tree_place(&self->tree, p, frame.sines, frame.pose);
    zd_plane_tree_move(&self->tree, frame.pose, v, frame.twist);
    return frame;
}

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_plane *self = data;
    const zd_plane_frame frame = placed(self, p, v, scratch);
    const zd_readings readings = zd_plane_frame_readings(self, &frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    return zd_rows_magnitudes(&actions, t, magnitude);
}

/* ---- generalized forces: force.x of a body's wrench is the sum of magnitudes of forces on it, and torque that of moments ---- */

static void add_size(const zd_plane *self, const zd_plane_frame *frame, int body, double size, zd_plane_wrench unit)
{
    const double force = size * zd_hypotenuse(unit.force.x, unit.force.y);
    const double lever = self->system.length + zd_hypotenuse(frame->pose[body].at.x, frame->pose[body].at.y);
    frame->wrench[body].force.x += force;
    frame->wrench[body].torque += size * fabs(unit.torque) + lever * force;
}

static void add_force(const zd_readings *at, void *unused, int index, double value)
{
    (void)unused;
    const zd_plane *self = at->mechanism;
    const zd_plane_frame *frame = at->frame;
    const zd_plane_quantity *quantity = self->quantity + index;
    const zd_plane_reading reading = zd_plane_quantity_read(quantity, frame->pose);
    add_size(self, frame, quantity->first, fabs(value), reading.first);
    add_size(self, frame, quantity->second, fabs(value), reading.second);
}

/* Sizes on each body reach its parent, too, with the distance between both as lever arm. */
static void pass_inward(const zd_plane *self, const zd_plane_frame *frame)
{
    for (int i = self->tree.bodies; i; i--) {
        const int parent = self->tree.link[i].inner;
        const zd_vector arm = zd_minus(frame->pose[i].at, frame->pose[parent].at);
        const zd_plane_wrench *outer = frame->wrench + i;
        frame->wrench[parent].force.x += outer->force.x;
        frame->wrench[parent].torque += outer->torque + zd_hypotenuse(arm.x, arm.y) * outer->force.x;
    }
}

int zd_plane_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch)
{
    const zd_plane *self = data;
    zd_plane_frame frame = placed(self, p, v, scratch);
    frame.inputs = inputs;
    const zd_readings readings = zd_plane_frame_readings(self, &frame);
    const zd_actions actions = {&self->elements, &readings, add_force, NULL};
    memset(frame.wrench, 0, (size_t)(self->tree.bodies + 1) * sizeof *frame.wrench);
    for (int i = 1; i <= self->tree.bodies; i++)
        add_size(self, &frame, i, self->tree.link[i].mass, (zd_plane_wrench){self->gravity, 0});
    const int status = zd_forces_act(&actions, t);
    pass_inward(self, &frame);
    for (int k = 0; k < self->tree.nv; k++) {
        const zd_plane_wrench *on = frame.wrench + self->coordinate[k].body;
        magnitude[k] = self->system.lengths[k] ? on->force.x : on->torque;
    }
    return status;
}
