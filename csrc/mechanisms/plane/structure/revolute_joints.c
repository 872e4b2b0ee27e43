/* With u and w the vectors from the mass centres of both bodies to their points, in global axes,
 *
 *     Phi = x2 + w - x1 - u,      C = [-I  -k x u | I  k x w],      xi = omega2^2 w - omega1^2 u.         (3), (5), (6)
 *
 * Marker quantities along x and y are the same constraints individually, but rotate both points twice. Vectors over the coordinates have
 * three entries for each body and for the ground, whose entries are zero, so that no branch depends on the bodies of a joint. */
#include "packing.h"

static int is_plain(const zd_plane *mechanism, const zd_relation *row, int kind)
{
    const zd_quantity_term *term = mechanism->elements.term + row->first;
    return row->law < 0 && !row->nonholonomic && row->terms == 1 && row->constant == 0 && row->slope == 0 && term->coefficient == 1
        && mechanism->quantity[term->quantity].kind == kind;
}

static int are_alike(const double *a, const double *b) { return a[0] == b[0] && a[1] == b[1]; }

int zd_is_revolute_joint_at(const zd_plane *mechanism, int row)
{
    if (row + 1 >= mechanism->elements.mh) return 0;
    const zd_relation *x = mechanism->elements.row + row, *y = x + 1;
    if (!is_plain(mechanism, x, ZD_PLANE_X) || !is_plain(mechanism, y, ZD_PLANE_Y)) return 0;
    const zd_plane_quantity *a = mechanism->quantity + mechanism->elements.term[x->first].quantity,
        *b = mechanism->quantity + mechanism->elements.term[y->first].quantity;
    return a->first == b->first && a->second == b->second && are_alike(a->point1, b->point1) && are_alike(a->point2, b->point2);
}

/* ---- where the points are ---- */

void zd_revolute_joints_turn(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame)
{
    const zd_plane_tree *tree = &mechanism->tree;
    const double *sine = frame->sines + tree->angles, *cosine = sine + tree->angles;
    zd_vector *axis = frame->axis;          /* x axis of each body */
    axis[0] = (zd_vector){1, 0};
    for (int i = 1, k = 0; i <= tree->bodies; i++) {
        const int turns = self->have_angles || tree->link[i].hang == ZD_HANGS_FREE;
        axis[i] = turns ? (zd_vector){cosine[k], sine[k]} : axis[0];
        k += turns;
    }
    for (int k = 0; k < self->count; k++) {
        const zd_vector a = axis[self->between[k].first], b = axis[self->between[k].second];
        frame->arm[2 * k] = zd_rotated(a.x, a.y, self->points[k].first);
        frame->arm[2 * k + 1] = zd_rotated(b.x, b.y, self->points[k].second);
    }
}

const double *zd_revolute_joints_expand(const zd_revolute_joints *self, const zd_plane_tree *tree, const double *x, double *to)
{
    if (self->have_angles) return x;
    double *of = to;
    for (int i = 1; i <= tree->bodies; i++, of += 3) {
        const double *own = x + tree->link[i].coordinate;
        of[0] = own[0];
        of[1] = own[1];
        of[2] = tree->link[i].hang == ZD_HANGS_FREE ? own[2] : 0;
    }
    return to;
}

/* ---- terms ---- */

static void write_Phi(const zd_revolute_joints *self, const zd_plane_frame *frame, const double *p, double *Phi)
{
    for (int k = 0; k < self->count; k++) {
        const zd_revolute_bodies *joint = self->between + k;
        const double *a = zd_of_body(p, joint->first), *b = zd_of_body(p, joint->second);
        const zd_vector u = frame->arm[2 * k], w = frame->arm[2 * k + 1], zero = self->joint[k].zero;
        Phi[joint->row] = b[0] + w.x - (a[0] + u.x) - zero.x;
        Phi[joint->row + 1] = b[1] + w.y - (a[1] + u.y) - zero.y;
    }
}

static void write_xi(const zd_revolute_joints *self, const zd_plane_frame *frame, const double *v, double *xi)
{
    for (int k = 0; k < self->count; k++) {
        const zd_revolute_bodies *joint = self->between + k;
        const double turn1 = zd_of_body(v, joint->first)[2], turn2 = zd_of_body(v, joint->second)[2], square1 = turn1 * turn1,
            square2 = turn2 * turn2;
        const zd_vector u = frame->arm[2 * k], w = frame->arm[2 * k + 1];
        xi[joint->row] = square2 * w.x - square1 * u.x;
        xi[joint->row + 1] = square2 * w.y - square1 * u.y;
    }
}

/* Both rows of a body: sign [I  k x arm] */
ZD_INLINE void write_body(double *x, int width, double sign, zd_vector arm, int turns)
{
    double *y = x + width;
    x[0] = y[1] = sign;
    x[1] = y[0] = 0;
    if (!turns) return;
    x[2] = -sign * arm.y;
    y[2] = sign * arm.x;
}

static void write_C(const zd_revolute_joints *self, const zd_plane_frame *frame, double *C)
{
    for (int k = 0; k < self->count; k++) {
        const zd_revolute_joint *joint = self->joint + k;
        if (joint->near >= 0) write_body(C + joint->C + joint->near, joint->width, -1, frame->arm[2 * k], joint->near_turns);
        if (joint->far >= 0) write_body(C + joint->C + joint->far, joint->width, 1, frame->arm[2 * k + 1], joint->far_turns);
    }
}

void zd_revolute_joints_write(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame, int want,
                              const double *p, const double *v,
                   const zd_terms *out)
{
    if (want & ZD_PHI) write_Phi(self, frame, zd_revolute_joints_expand(self, &mechanism->tree, p, frame->spread), out->Phi);
    if (want & ZD_XI) write_xi(self, frame, zd_revolute_joints_expand(self, &mechanism->tree, v, frame->spread), out->xi);
    if (want & ZD_C) write_C(self, frame, out->C);
    for (int k = 0; (want & ZD_PHI_T) && k < self->count; k++) out->Phi_t[self->between[k].row] = out->Phi_t[self->between[k].row + 1] = 0;
}
