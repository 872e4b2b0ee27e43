/* Magnitudes of the gradients of constraints before cancellation, as in the plane (../plane/magnitudes.c). */
#include "magnitudes.h"

#include "../common/laws.h"
#include "../space/marker_quantity.h"
#include "../space/plan.h"

static double norm(zd_vector3 a) { return sqrt(zd_inner3(a, a)); }

static double distance_of(const zd_space_pose *pose, const double *point) { return norm(pose->at) + norm(zd_vector3_of(point)); }

static void add(const zd_space *self, const zd_space_frame *frame, int quantity, double factor, double *magnitude)
{
    const zd_space_quantity *of = self->quantity + quantity;
    const double size = fabs(factor);
    if (of->kind == ZD_SPACE_COSINE || of->kind == ZD_SPACE_ANGLE) {
        magnitude[1] += size;
        return;
    }
    const double lever = distance_of(frame->pose + of->first, of->point1) + distance_of(frame->pose + of->second, of->point2);
    magnitude[0] += size;
    magnitude[1] += size * (self->system.length + lever);
}

int zd_space_tree_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_space *self = data;
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    const zd_readings readings = zd_space_frame_readings(self, &frame);
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
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
