/* The equations of motion (1), (2), (3), (5), (6) in joint coordinates: rows are those of joints outside the tree, and relations. */
#include "links.h"

#include "../../linalg/small.h"
#include "../space/system/system.h"

enum { ROWS = ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI };

/* True if a wanted term depends on velocities. */
static int is_moving(const zd_space *self, int want)
{
    return want & (ZD_BIAS | ZD_XI | ZD_POWER) || (want & ZD_FORCE && self->elements.has_velocity_forces)
        || (want & ROWS && self->elements.law);
}

static int write_force(const zd_space *self, const zd_space_frame *frame, double t, double *f)
{
    const int status = zd_space_forces_apply(self, frame, t);
    zd_space_tree_gather(self, frame, f);
    return status;
}

int zd_space_tree_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_space *self = data;
    const zd_space_tree *tree = zd_space_tree_of(self);
    zd_space_frame frame;
    zd_space_frame_of(self, out->scratch, &frame);
    frame.inputs = out->inputs;
    if (want & ZD_MOVED) zd_space_frame_place(self, &frame, p);
    if (is_moving(self, want)) zd_space_tree_move(self, &frame, v);
    if (want & ZD_A) {
        zd_clear(tree->nq * tree->nv, out->A);
        zd_space_tree_write_A(tree, p, out->A);
        zd_space_tree_write_rates(self, &frame, out->A);
    }
    if (want & ZD_M) zd_space_tree_mass(self, &frame, out->M);
    if (want & ZD_BIAS) zd_space_tree_bias(self, &frame, out->d);
    if (want & ZD_POTENTIAL) *out->V = zd_space_potential(self, &frame);
    int status = want & ZD_FORCE ? write_force(self, &frame, t, out->f) : ZD_DONE;
    if (!status && (want & ZD_POWER)) status = zd_space_power(self, &frame, t, out->power);
    if (status) return status;
    if (want & ZD_C) zd_clear(self->elements.m * tree->nv, out->C);
    return want & ROWS ? zd_space_rows_write(self, &frame, want, t, out) : ZD_DONE;
}
