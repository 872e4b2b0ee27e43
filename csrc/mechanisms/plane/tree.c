/* Outward and inward recursions over a tree of bodies in the plane; the mass matrix by composite bodies (Featherstone, Rigid Body
 * Dynamics Algorithms, 2008, chapters 5 and 6), with absolute angles as coordinates. */
#include "tree.h"

#include "../../include/zerodrift/sines.h"

/* ---- outward ---- */

static void turn_with(zd_plane_pose *pose, const zd_plane_pose *inner, const zd_plane_link *link)
{
    pose->angle = inner->angle + link->angle;
    pose->cosine = inner->cosine * link->cosine - inner->sine * link->sine;
    pose->sine = inner->sine * link->cosine + inner->cosine * link->sine;
}

static void place_free(const double *own, zd_plane_pose *pose)
{
    pose->at = (zd_vector){own[0], own[1]};
}

static void place_hanging(const zd_plane_link *link, const double *own, const zd_plane_pose *inner, zd_plane_pose *pose)
{
    pose->near = zd_rotated(inner->cosine, inner->sine, link->near);
    if (link->hang == ZD_HANGS_SLIDING) {
        pose->axis = zd_rotated(inner->cosine, inner->sine, link->axis);
        pose->near = zd_plus(pose->near, zd_times(own[0] + link->along, pose->axis));
    }
    pose->far = zd_rotated(pose->cosine, pose->sine, link->far);
    pose->at = zd_plus(inner->at, zd_plus(pose->near, pose->far));
}

static int has_angle(const zd_plane_link *link) { return link->hang == ZD_HANGS_TURNING || link->hang == ZD_HANGS_FREE; }

void zd_plane_tree_turn(const zd_plane_tree *tree, const double *p, double *memory)
{
    const int n = tree->angles;
    double *angle = memory, *sine = angle + n, *cosine = sine + n;
    for (int k = 0; k < n; k++) angle[k] = p[tree->angle[k]];
    ZD_SIZED(zd_sines, n, angle, sine, cosine);
}

void zd_plane_tree_place(const zd_plane_tree *tree, const double *p, const double *memory, zd_plane_pose *pose)
{
    const double *angle = memory, *sine = angle + tree->angles, *cosine = sine + tree->angles;
    pose[0] = (zd_plane_pose){.cosine = 1};
    for (int i = 1, k = 0; i <= tree->bodies; i++) {
        const zd_plane_link *link = tree->link + i;
        const double *own = p + link->coordinate;
        if (has_angle(link)) {
            pose[i].angle = angle[k];
            pose[i].sine = sine[k];
            pose[i].cosine = cosine[k++];
        } else if (link->hang == ZD_HANGS_SLIDING || link->hang == ZD_HANGS_FIXED) {
            turn_with(pose + i, pose + link->inner, link);
        } else {
            pose[i].angle = pose[i].sine = 0;
            pose[i].cosine = 1;
        }
        if (link->hang <= ZD_HANGS_FREE_POINT) place_free(own, pose + i);
        else place_hanging(link, own, pose + link->inner, pose + i);
    }
}

static double turn_of(const zd_plane_link *link, const double *own, double inner)
{
    switch (link->hang) {
    case ZD_HANGS_FREE: return own[2];
    case ZD_HANGS_TURNING: return own[0];
    case ZD_HANGS_SLIDING:
    case ZD_HANGS_FIXED: return inner;
    default: return 0;
    }
}

void zd_plane_tree_move(const zd_plane_tree *tree, const zd_plane_pose *pose, const double *v, zd_plane_twist *twist)
{
    twist[0] = (zd_plane_twist){.turn = 0};
    for (int i = 1; i <= tree->bodies; i++) {
        const zd_plane_link *link = tree->link + i;
        const zd_plane_twist *inner = twist + link->inner;
        const double *own = v + link->coordinate;
        double turn = twist[i].turn = turn_of(link, own, inner->turn);
        zd_vector near = pose[i].near, far = pose[i].far;
        if (link->hang <= ZD_HANGS_FREE_POINT) {
            twist[i].speed = (zd_vector){own[0], own[1]};
            twist[i].bias = (zd_vector){0, 0};
            continue;
        }
        twist[i].speed = zd_plus(inner->speed, zd_plus(zd_turned(inner->turn, near), zd_turned(turn, far)));
        twist[i].bias = zd_minus(inner->bias, zd_plus(zd_times(inner->turn * inner->turn, near), zd_times(turn * turn, far)));
        if (link->hang != ZD_HANGS_SLIDING) continue;
        zd_vector sliding = zd_times(own[0], pose[i].axis);
        twist[i].speed = zd_plus(twist[i].speed, sliding);
        twist[i].bias = zd_plus(twist[i].bias, zd_turned(2 * turn, sliding));
    }
}

void zd_plane_tree_accelerate(const zd_plane_tree *tree, const zd_plane_pose *pose, const zd_plane_twist *twist, const double *vdot,
                              zd_spin *spin)
{
    spin[0] = (zd_spin){.turn = 0};
    for (int i = 1; i <= tree->bodies; i++) {
        const zd_plane_link *link = tree->link + i;
        const zd_spin *inner = spin + link->inner;
        const double *own = vdot + link->coordinate;
        spin[i].turn = turn_of(link, own, inner->turn);
        if (link->hang <= ZD_HANGS_FREE_POINT) {
            spin[i].speed = (zd_vector){own[0], own[1]};
            continue;
        }
        double turn = twist[link->inner].turn, own_turn = twist[i].turn;
        zd_vector centripetal = zd_plus(zd_times(turn * turn, pose[i].near), zd_times(own_turn * own_turn, pose[i].far));
        zd_vector relative = zd_plus(zd_turned(inner->turn, pose[i].near), zd_turned(spin[i].turn, pose[i].far));
        spin[i].speed = zd_minus(zd_plus(inner->speed, relative), centripetal);
        if (link->hang != ZD_HANGS_SLIDING) continue;
        zd_vector coriolis = zd_minus(twist[i].bias, zd_minus(twist[link->inner].bias, centripetal));
        spin[i].speed = zd_plus(spin[i].speed, zd_plus(coriolis, zd_times(own[0], pose[i].axis)));
    }
}

/* ---- inward ---- */

void zd_plane_tree_act_on_free(const zd_plane_link *link, double scale, zd_plane_wrench what, double *own)
{
    own[0] += scale * what.force.x;
    own[1] += scale * what.force.y;
    if (link->hang == ZD_HANGS_FREE) own[2] += scale * what.torque;
}

/* Adds a body's share of a wrench to its own coordinates; returns the wrench that is transmitted to the parent. */
static zd_plane_wrench pass_inward(const zd_plane_link *link, const zd_plane_pose *pose, zd_plane_wrench what, double scale, double *row)
{
    double *own = row + link->coordinate, torque = what.torque + zd_cross(pose->far, what.force);     /* about the joint */
    switch (link->hang) {
    case ZD_HANGS_TURNING:
        own[0] += scale * torque;
        torque = 0;
        break;
    case ZD_HANGS_FREE:
    case ZD_HANGS_FREE_POINT:
        zd_plane_tree_act_on_free(link, scale, what, own);
        return (zd_plane_wrench){.torque = 0};
    case ZD_HANGS_SLIDING:
        own[0] += scale * zd_inner(pose->axis, what.force);
        break;
    case ZD_HANGS_FIXED: break;
    case ZD_HANGS_PINNED: torque = 0;
    }
    return (zd_plane_wrench){what.force, torque + zd_cross(pose->near, what.force)};
}

void zd_plane_tree_inward(const zd_plane_tree *tree, const zd_plane_pose *pose, int body, double scale, zd_plane_wrench what, double *row)
{
    for (int i = body; i && (what.torque != 0 || what.force.x != 0 || what.force.y != 0); i = tree->link[i].inner)
        what = pass_inward(tree->link + i, pose + i, what, scale, row);
}

void zd_plane_tree_gather(const zd_plane_tree *tree, const zd_plane_pose *pose, zd_plane_wrench *wrench, double *to)
{
    for (int i = tree->bodies; i; i--)
        zd_plane_add_wrench(wrench + tree->link[i].inner, 1, pass_inward(tree->link + i, pose + i, wrench[i], 1, to));
}

void zd_plane_tree_transmit(const zd_plane_tree *tree, const zd_plane_pose *pose, zd_plane_wrench *wrench)
{
    for (int i = tree->bodies; i; i--) {
        zd_vector arm = zd_plus(pose[i].near, pose[i].far), force = wrench[i].force;
        if (tree->link[i].hang > ZD_HANGS_FREE_POINT)
            zd_plane_add_wrench(wrench + tree->link[i].inner, 1, (zd_plane_wrench){force, wrench[i].torque + zd_cross(arm, force)});
    }
}

/* ---- the mass matrix ---- */

/* Adds the composite of a body to that of its parent; one that turns relative to it is a point mass at its joint. */
static void add_to_inner(const zd_plane_link *link, const zd_plane_pose *pose, const zd_plane_composite *own, zd_plane_composite *inner)
{
    int turns_with = link->hang == ZD_HANGS_SLIDING || link->hang == ZD_HANGS_FIXED;
    zd_vector arm = turns_with ? zd_plus(pose->near, pose->far) : pose->near;
    inner->first = zd_plus(inner->first, zd_times(link->carried, arm));
    inner->inertia += link->carried * zd_inner(arm, arm);
    if (!turns_with) return;
    inner->first = zd_plus(inner->first, own->first);
    inner->inertia += own->inertia + 2 * zd_inner(own->first, arm);
}

/* Momentum of a body's composite at unit rate of the body's own coordinate. */
static zd_plane_wrench momentum(const zd_plane_link *link, const zd_plane_pose *pose, const zd_plane_composite *own)
{
    if (link->hang == ZD_HANGS_SLIDING) return (zd_plane_wrench){zd_times(link->carried, pose->axis), zd_cross(own->first, pose->axis)};
    zd_vector first = zd_plus(zd_times(link->carried, pose->far), own->first);
    return (zd_plane_wrench){zd_turned(1, first), own->inertia + zd_inner(own->first, pose->far)};
}

/* The rows of a free body: nothing is further in. */
static void write_free(const zd_plane_link *link, const zd_plane_composite *own, int nv, double *M)
{
    int k = link->coordinate;
    M[k * nv + k] = M[(k + 1) * nv + k + 1] = link->carried;
    if (link->hang == ZD_HANGS_FREE_POINT) return;
    M[(k + 2) * nv + k + 2] = own->inertia;
    M[(k + 2) * nv + k] = -own->first.y;
    M[(k + 2) * nv + k + 1] = own->first.x;
}

static void mirror(int nv, double *M)
{
    for (int i = 0; i < nv; i++)
        for (int j = 0; j < i; j++) M[j * nv + i] = M[i * nv + j] = M[i * nv + j] + M[j * nv + i];
}

void zd_plane_tree_mass(const zd_plane_tree *tree, const zd_plane_pose *pose, zd_plane_composite *composite, double *M)
{
    int nv = tree->nv;
    for (int i = 0; i <= tree->bodies; i++) composite[i] = (zd_plane_composite){.inertia = tree->link[i].inertia};
    for (int i = tree->bodies; i; i--) {
        const zd_plane_link *link = tree->link + i;
        if (link->hang <= ZD_HANGS_FREE_POINT) {
            write_free(link, composite + i, nv, M);
            continue;
        }
        if (link->hang <= ZD_HANGS_SLIDING)
            zd_plane_tree_inward(tree, pose, i, 1, momentum(link, pose + i, composite + i), M + link->coordinate * nv);
        add_to_inner(link, pose + i, composite + i, composite + link->inner);
    }
    mirror(nv, M);
}
