/* The mass matrix by composite bodies, and the bias by recursive Newton-Euler equations: R. Featherstone, Rigid Body Dynamics Algorithms,
 * 2008, chapters 5 and 6; here in the drawing's axes, and about mass centres. */
#include "links.h"

#include "../../linalg/small.h"

/* ---- composite bodies ---- */

static zd_vector3 times_second(const double *J, zd_vector3 a)
{
    return (zd_vector3){J[0] * a.x + J[3] * a.y + J[4] * a.z, J[3] * a.x + J[1] * a.y + J[5] * a.z, J[4] * a.x + J[5] * a.y + J[2] * a.z};
}

/* J += s (2 a . b - a b^T - b a^T): where a = b, what a point mass of 2 s there has. */
static void add_product(double s, zd_vector3 a, zd_vector3 b, double *J)
{
    const double x = a.x * b.x, y = a.y * b.y, z = a.z * b.z;
    J[0] += s * 2 * (y + z);
    J[1] += s * 2 * (x + z);
    J[2] += s * 2 * (x + y);
    J[3] -= s * (a.x * b.y + a.y * b.x);
    J[4] -= s * (a.x * b.z + a.z * b.x);
    J[5] -= s * (a.y * b.z + a.z * b.y);
}

static zd_space_composite alone(const zd_space_planned_body *body, const zd_rotation *R)
{
    zd_space_composite own = {.mass = body->mass};
    const zd_vector3 axis[] = {R->x, R->y, R->z};
    const double I[] = {body->inertia.x, body->inertia.y, body->inertia.z};
    for (int k = 0; body->turns && k < 3; k++) {
        const zd_vector3 a = axis[k];
        const double products[] = {a.x * a.x, a.y * a.y, a.z * a.z, a.x * a.y, a.x * a.z, a.y * a.z};
        for (int i = 0; i < 6; i++) own.second[i] += I[k] * products[i];
    }
    return own;
}

/* Adds a composite to that of its parent. A particle contributes its mass alone, as it transmits no torque. */
static void add_to_inner(const zd_space_link *link, zd_vector3 arm, const zd_space_composite *own, zd_space_composite *inner)
{
    inner->mass += own->mass;
    inner->first = zd_plus3(inner->first, zd_times3(own->mass, arm));
    add_product(own->mass / 2, arm, arm, inner->second);
    if (!link->turns) return;
    inner->first = zd_plus3(inner->first, own->first);
    add_product(1, own->first, arm, inner->second);
    for (int i = 0; i < 6; i++) inner->second[i] += own->second[i];
}

/* The momentum of a composite body that moves so, about its first body's mass centre. */
static zd_space_wrench momentum(const zd_space_composite *own, const zd_space_twist *by)
{
    return (zd_space_wrench){zd_plus3(zd_times3(own->mass, by->speed), zd_cross3(by->spin, own->first)),
                        zd_plus3(times_second(own->second, by->spin), zd_cross3(own->first, by->speed))};
}

/* Row k of a body's own velocities up to k, and of those further in; and the columns that are the same. */
static void write_row(const zd_space *space, const zd_space_frame *frame, int body, int k, zd_space_wrench what, double *M)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const zd_space_twist *column = zd_space_tree_frame_of(tree, frame).column;
    const int nv = tree->nv;
    for (int i = body; i; i = tree->link[i].inner) {
        const zd_space_link *link = tree->link + i;
        const int end = i == body ? k + 1 : link->v + link->nv;
        for (int j = link->v; j < end; j++)
            M[k * nv + j] = M[j * nv + k] = zd_inner3(what.force, column[j].speed) + zd_inner3(what.torque, column[j].spin);
        what = zd_space_tree_pass(link, frame->pose, i, what);
    }
}

void zd_space_tree_mass(const zd_space *space, const zd_space_frame *frame, double *M)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const zd_space_tree_frame own = zd_space_tree_frame_of(tree, frame);
    const zd_space_pose *pose = frame->pose;
    zd_clear(tree->nv * tree->nv, M);
    for (int body = 0; body <= tree->bodies; body++) own.composite[body] = alone(space->body + body, &pose[body].turned);
    for (int i = tree->bodies - 1; i >= 0; i--) {
        const int body = tree->order[i];
        const zd_space_link *link = tree->link + body;
        for (int k = link->v; k < link->v + link->nv; k++)
            write_row(space, frame, body, k, momentum(own.composite + body, own.column + k), M);
        if (!link->is_free)
            add_to_inner(link, zd_minus3(pose[body].at, pose[link->inner].at), own.composite + body, own.composite + link->inner);
    }
}

/* ---- inertia ---- */

zd_space_wrench zd_space_tree_need(const zd_space_planned_body *body, const zd_space_pose *pose, const zd_space_twist *twist,
                                   const zd_space_twist *change)
{
    zd_space_wrench need = {zd_times3(body->mass, change->speed), {0, 0, 0}};
    if (!body->turns) return need;
    const zd_vector3 spin = zd_rotated_back3(&pose->turned, twist->spin), rate = zd_rotated_back3(&pose->turned, change->spin);
    const zd_vector3 I = body->inertia, turning = {I.x * spin.x, I.y * spin.y, I.z * spin.z};
    const zd_vector3 own = zd_plus3((zd_vector3){I.x * rate.x, I.y * rate.y, I.z * rate.z}, zd_cross3(spin, turning));
    need.torque = zd_rotated3(&pose->turned, own);
    return need;
}

void zd_space_tree_bias(const zd_space *space, const zd_space_frame *frame, double *d)
{
    const zd_space_wrench none = {{0, 0, 0}, {0, 0, 0}};
    frame->wrench[0] = none;
    for (int body = 1; body <= space->bodies; body++)
        frame->wrench[body] = zd_space_tree_need(space->body + body, frame->pose + body, frame->twist + body, frame->bias + body);
    zd_space_tree_gather(space, frame, d);
}
