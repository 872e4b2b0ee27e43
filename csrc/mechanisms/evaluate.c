/* The equations of motion (2), (3), (5), (6) of a mechanism, from its tables. */
#include "evaluate.h"

#include "efforts.h"
#include "rows.h"
#include "structure.h"

enum { ROWS = ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI };

/* d of (2): what it takes to move the bodies while the coordinates' accelerations are zero */
static void write_bias(const zd_mechanism *self, const zd_frame *frame, double *d)
{
    for (int i = 0; i <= self->tree.bodies; i++)
        frame->wrench[i] = (zd_wrench){zd_times(self->tree.link[i].mass, frame->twist[i].bias), 0};
    zd_tree_gather(&self->tree, frame->pose, frame->wrench, d);
}

static int write_force(const zd_mechanism *self, const zd_frame *frame, double t, double *f)
{
    int status = zd_efforts_apply(self, frame, t);
    zd_tree_gather(&self->tree, frame->pose, frame->wrench, f);
    return status;
}

/* What is added up, long before it is: the machine waits where it adds to what a wider store has just cleared. */
static void clear(const zd_mechanism *self, int want, const zd_terms *out)
{
    size_t nv = (size_t)self->tree.nv, size_of_C = self->packing ? (size_t)self->packing->size_of_C : (size_t)self->m * nv;
    if ((want & ZD_M) && !self->packing) memset(out->M, 0, nv * nv * sizeof *out->M);
    if (want & ZD_BIAS) memset(out->d, 0, nv * sizeof *out->d);
    if (want & ZD_FORCE) memset(out->f, 0, nv * sizeof *out->f);
    if (want & ZD_C) memset(out->C, 0, size_of_C * sizeof *out->C);
}

/* The diagonals of the bodies, one after another */
static void write_packed_mass(const zd_tree *tree, double *M)
{
    for (const zd_link *link = tree->link + 1; link <= tree->link + tree->bodies; link++) {
        *M++ = link->mass;
        *M++ = link->mass;
        if (link->hang == ZD_HANGS_FREE) *M++ = link->inertia;
    }
}

int zd_mechanism_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_mechanism *self = data;
    const zd_frame frame = zd_frame_of(self, out->scratch);
    int is_moving = want & (ZD_BIAS | ZD_XI | ZD_POWER) || self->has_velocity_forces || self->law;
    clear(self, want, out);
    if (want & ZD_MOVED) zd_tree_place(&self->tree, p, frame.sines, frame.pose);
    if (is_moving) zd_tree_move(&self->tree, frame.pose, v, frame.twist);
    if ((want & ZD_M) && self->packing) write_packed_mass(&self->tree, out->M);
    else if (want & ZD_M) zd_tree_mass(&self->tree, frame.pose, frame.composite, out->M);
    if (want & ZD_BIAS) write_bias(self, &frame, out->d);
    if (want & ZD_POTENTIAL) *out->V = zd_efforts_potential(self, &frame);
    if ((want & ZD_FORCE) && write_force(self, &frame, t, out->f)) return ZD_CALLBACK;
    if ((want & ZD_POWER) && zd_efforts_power(self, &frame, t, out->power)) return ZD_CALLBACK;
    return want & ROWS ? zd_rows_write(self, &frame, want, t, out) : ZD_DONE;
}
