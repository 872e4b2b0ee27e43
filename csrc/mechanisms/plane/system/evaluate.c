/* The equations of motion (2), (3), (5), (6) of a mechanism, from its tables. */
#include "system.h"

#include "../../../linalg/small.h"
#include "../structure/packing.h"

enum { ROWS = ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI };

/* d of (2): what it takes to move the bodies while the coordinates' accelerations are zero */
static void write_bias(const zd_plane *self, const zd_plane_frame *frame, double *d)
{
    for (int i = 0; i <= self->tree.bodies; i++)
        frame->wrench[i] = (zd_plane_wrench){zd_times(self->tree.link[i].mass, frame->twist[i].bias), 0};
    zd_plane_tree_gather(&self->tree, frame->pose, frame->wrench, d);
}

static int write_force(const zd_plane *self, const zd_plane_frame *frame, double t, double *f)
{
    int status = zd_plane_forces_apply(self, frame, t);
    zd_plane_tree_gather(&self->tree, frame->pose, frame->wrench, f);
    return status;
}

/* Clears the arrays that are accumulated, well before they are: adding right after a wide store stalls the processor. */
static void clear(const zd_plane *self, int want, const zd_terms *out)
{
    size_t nv = self->tree.nv, size_of_C = self->packing ? (size_t)self->packing->packed.size_of_C : (size_t)self->elements.m * nv;
    if ((want & ZD_M) && !self->packing) memset(out->M, 0, nv * nv * sizeof *out->M);
    if (want & ZD_BIAS) memset(out->d, 0, nv * sizeof *out->d);
    if ((want & ZD_FORCE) && (self->elements.forces || !self->packing)) memset(out->f, 0, nv * sizeof *out->f);
    if ((want & ZD_C) && !(self->packing && self->packing->revolutes.are_all)) memset(out->C, 0, size_of_C * sizeof *out->C);
}

/* The diagonals of the bodies, one after another */
static void write_packed_mass(const zd_plane_tree *tree, double *M)
{
    for (const zd_plane_link *link = tree->link + 1; link <= tree->link + tree->bodies; link++) {
        *M++ = link->mass;
        *M++ = link->mass;
        if (link->hang == ZD_HANGS_FREE) *M++ = link->inertia;
    }
}

/* The wanted terms that need poses of bodies; the others follow from sines and cosines alone. */
static int terms_of_bodies(const zd_plane *self, int want)
{
    if (self->packing) {
        const int known = ZD_M | (self->packing->is_complete ? ROWS : 0) | (self->elements.forces ? 0 : ZD_FORCE);
        return want & ~known & (ROWS | ZD_FORCE | ZD_POTENTIAL | ZD_POWER);
    }
    int left = want & (ROWS | ZD_M | ZD_BIAS | ZD_FORCE | ZD_POTENTIAL | ZD_POWER);
    if (!self->hinged.is_complete) return left;
    if (2 * self->hinged.closures == self->elements.m) left &= ~ROWS;
    return left & ~(ZD_M | ZD_BIAS | (self->elements.forces ? 0 : ZD_FORCE));
}

/* Bodies are placed once for each (t, p), when first a term needs it. */
static void place(const zd_plane *self, const zd_plane_frame *frame, int left, const double *p, const double *v)
{
    if (*frame->is_placed == 0) zd_plane_tree_place(&self->tree, p, frame->sines, frame->pose);
    *frame->is_placed = 1;
    int is_moving = left & (ZD_BIAS | ZD_XI | ZD_POWER) || self->elements.has_velocity_forces || self->elements.law;
    if (is_moving) zd_plane_tree_move(&self->tree, frame->pose, v, frame->twist);
}

/* Terms that follow from sines and cosines alone. */
static void write_hinged(const zd_plane *self, const zd_plane_frame *frame, int want, const double *v, const zd_terms *out)
{
    const zd_hinged *hinged = &self->hinged;
    if (want & ZD_M) zd_hinged_mass(hinged, &self->tree, frame->sines, out->M);
    if (want & ZD_BIAS) zd_hinged_bias(hinged, &self->tree, frame->sines, v, out->d);
    if ((want & ZD_FORCE) && !self->elements.forces) zd_hinged_weight(hinged, &self->tree, frame->sines, self->gravity, out->f);
    if (want & ROWS) zd_hinged_close(hinged, &self->tree, frame->sines, v, want, out);
}

/* Packed terms that do not need poses of bodies. */
static void write_packed(const zd_plane *self, const zd_plane_frame *frame, int want, double t, const double *p, const double *v,
                         const zd_terms *out)
{
    if (want & ZD_MOVED) zd_revolute_joints_turn(&self->packing->revolutes, self, frame);
    if (want & ZD_M) write_packed_mass(&self->tree, out->M);
    if ((want & ZD_FORCE) && !self->elements.forces) zd_copy_all(self->tree.nv, self->packing->weight, out->f);
    zd_revolute_joints_write(&self->packing->revolutes, self, frame, want, p, v, out);
    zd_lines_write(&self->packing->lines, &self->packing->revolutes, self, frame, want, t, p, v, out);
}

int zd_plane_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_plane *self = data;
    zd_plane_frame frame;
    zd_plane_frame_of(self, out->scratch, &frame);
    frame.inputs = out->inputs;
    int left = terms_of_bodies(self, want);
    clear(self, want, out);
    if (want & ZD_MOVED) {
        zd_plane_tree_turn(&self->tree, p, frame.sines);
        *frame.is_placed = 0;
    }
    if (self->packing) write_packed(self, &frame, want, t, p, v, out);
    if (left) place(self, &frame, left, p, v);
    if (self->hinged.is_complete) write_hinged(self, &frame, want, v, out);
    if (left & ZD_M) zd_plane_tree_mass(&self->tree, frame.pose, frame.composite, out->M);
    if (left & ZD_BIAS) write_bias(self, &frame, out->d);
    if (left & ZD_POTENTIAL) *out->V = zd_plane_potential(self, &frame);
    int status = left & ZD_FORCE ? write_force(self, &frame, t, out->f) : ZD_DONE;
    if (!status && (left & ZD_POWER)) status = zd_plane_power(self, &frame, t, out->power);
    if (status) return status;
    return left & ROWS ? zd_plane_rows_write(self, &frame, left, t, out) : ZD_DONE;
}
