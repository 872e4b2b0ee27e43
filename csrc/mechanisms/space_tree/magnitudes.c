/* Magnitudes of the gradients of constraints before cancellation, as in the plane (../plane/magnitudes.c). */
#include "magnitudes.h"

#include "../common/actions.h"
#include "../space/marker_quantity.h"
#include "../space/plan.h"

static double norm(zd_vector3 a) { return sqrt(zd_inner3(a, a)); }

static double distance_of(const zd_space_pose *pose, const double *point) { return norm(pose->at) + norm(zd_vector3_of(point)); }

static void add(const zd_readings *at, void *to, int quantity, double factor)
{
    const zd_space *self = at->mechanism;
    const zd_space_pose *pose = ((const zd_space_frame *)at->frame)->pose;
    const zd_space_quantity *of = self->quantity + quantity;
    double *magnitude = to;
    const double size = fabs(factor);
    if (of->kind == ZD_SPACE_COSINE || of->kind == ZD_SPACE_ANGLE || of->kind == ZD_SPACE_ROTATION) {
        magnitude[1] += size;
        return;
    }
    const double lever = distance_of(pose + of->first, of->point1) + distance_of(pose + of->second, of->point2);
    magnitude[0] += size;
    magnitude[1] += size * (self->system.length + lever);
}

int zd_space_tree_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_space *self = data;
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    const zd_readings readings = zd_space_frame_readings(self, &frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
    return zd_rows_magnitudes(&actions, t, magnitude);
}
