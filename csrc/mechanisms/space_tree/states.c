/* Between poses of bodies and coordinates. */
#include "links.h"
#include "tree.h"

static const double TURN = 6.283185307179586;
enum { POSE = 12, TWIST = 6 };      /* doubles */

static void write_vector(zd_vector3 a, double *to) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }

void zd_space_tree_poses(const zd_space *space, const double *p, const double *v, double *poses, double *twists, double *scratch)
{
    zd_space_frame frame;
    zd_space_frame_of(space, scratch, &frame);
    zd_space_frame_place(space, &frame, p);
    if (v) zd_space_frame_move(space, &frame, v);
    for (int body = 1; body <= space->bodies; body++, poses += POSE) {
        const zd_rotation *R = &frame.pose[body].turned;
        write_vector(frame.pose[body].at, poses);
        write_vector(R->x, poses + 3);
        write_vector(R->y, poses + 6);
        write_vector(R->z, poses + 9);
        if (!v) continue;
        write_vector(frame.twist[body].speed, twists);
        write_vector(frame.twist[body].spin, twists + 3);
        twists += TWIST;
    }
}

/* ---- back ---- */

static zd_space_pose given_pose(const double *poses, int body)
{
    if (!body) return (zd_space_pose){{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const double *x = poses + POSE * (body - 1);
    return (zd_space_pose){zd_vector3_of(x), {zd_vector3_of(x + 3), zd_vector3_of(x + 6), zd_vector3_of(x + 9)}};
}

static zd_space_twist given_twist(const double *twists, int body)
{
    if (!body || !twists) return (zd_space_twist){{0, 0, 0}, {0, 0, 0}};
    return (zd_space_twist){zd_vector3_of(twists + TWIST * (body - 1)), zd_vector3_of(twists + TWIST * (body - 1) + 3)};
}

/* Quaternion, with a scalar part that is not negative, of the rotation whose entry (i, k) is a_i . b_k. Four formulas differ by a factor
 * only; the one without cancellation is selected and normalized. */
static void write_quaternion(const zd_space_axes *a, const zd_space_axes *b, double *q)
{
#define R(i, k) zd_inner3(a->d[i], b->d[k])
    const double x = R(2, 1) - R(1, 2), y = R(0, 2) - R(2, 0), z = R(1, 0) - R(0, 1);
    const double d0 = R(0, 0), d1 = R(1, 1), d2 = R(2, 2), xy = R(0, 1) + R(1, 0), xz = R(0, 2) + R(2, 0), yz = R(1, 2) + R(2, 1);
#undef R
    const double all[4][4] = {
        {1 + d0 + d1 + d2, x, y, z}, {x, 1 + d0 - d1 - d2, xy, xz}, {y, xy, 1 - d0 + d1 - d2, yz}, {z, xz, yz, 1 - d0 - d1 + d2}};
    int best = 0;
    for (int i = 1; i < 4; i++)
        if (all[i][i] > all[best][best]) best = i;
    double size = 0;
    for (int i = 0; i < 4; i++) size += all[best][i] * all[best][i];
    size = all[best][0] < 0 ? -sqrt(size) : sqrt(size);
    for (int i = 0; i < 4; i++) q[i] = all[best][i] / size;
}

/* Pose and motion of a joint's frame on one of its bodies. */
typedef struct side {
    zd_space_axes F;
    zd_vector3 at, speed, spin;
} side;

static side side_of(zd_space_pose pose, zd_space_twist twist, zd_vector3 point, const zd_space_axes *axes)
{
    const zd_vector3 arm = zd_rotated3(&pose.turned, point);
    side of = {.at = zd_plus3(pose.at, arm), .speed = zd_plus3(twist.speed, zd_cross3(twist.spin, arm)), .spin = twist.spin};
    for (int k = 0; k < 3; k++) of.F.d[k] = zd_rotated3(&pose.turned, axes->d[k]);
    return of;
}

/* Angle of the outer frame about a direction of the moving frame, measured on a direction that the later rotation, about `next`, leaves
 * unchanged. */
static double angle_between(const zd_space_axes *F, const zd_space_axes *outer, int direction, int next)
{
    const int i = (direction + 1) % 3, k = (direction + 2) % 3, seen = next == direction ? i : next;
    const double x = zd_inner3(F->d[i], outer->d[seen]), y = zd_inner3(F->d[k], outer->d[seen]);
    return atan2(seen == i ? y : -x, seen == i ? x : y);
}

/* The direction about which the frame turns next after a freedom; that of the freedom where it does not. */
static int next_turn(const zd_space_link *link, int i)
{
    for (int k = i + 1; k < link->freedoms; k++)
        if (link->freedom[k].kind == ZD_SPACE_TURNS || link->freedom[k].kind == ZD_SPACE_ADVANCES) return link->freedom[k].direction;
    return link->freedom[i].direction;
}

/* The angle plus the multiple of 2 pi that brings it nearest to `wished`, the angle of a screw's displacement. */
static double nearest_turn(double angle, double wished) { return angle + TURN * nearbyint((wished - angle) / TURN); }

/* A freedom's coordinates and velocities, from the inner side, as far as the frame has come, to the outer one; then it comes along. */
static void read_freedom(const zd_space_link *link, int i, const side *outer, side *now, double *p, double *v)
{
    const zd_space_link_freedom *freedom = link->freedom + i;
    const zd_vector3 e = now->F.d[freedom->direction], apart = zd_minus3(outer->at, now->at), turning = zd_minus3(outer->spin, now->spin);
    const double along = freedom->sign * zd_inner3(apart, e) - freedom->zero;
    if (freedom->kind == ZD_SPACE_SLIDES) {
        const double rate = zd_inner3(zd_minus3(outer->speed, now->speed), e) + zd_inner3(apart, zd_cross3(now->spin, e));
        p[freedom->p] = along;
        v[freedom->v] = freedom->sign * rate;
    } else if (freedom->kind == ZD_SPACE_SWINGS) {
        write_quaternion(&now->F, &outer->F, p + freedom->p);
        for (int k = 0; k < 3; k++) v[freedom->v + k] = zd_inner3(turning, outer->F.d[k]);
        now->F = outer->F;
        now->spin = outer->spin;
    } else {
        const double angle = angle_between(&now->F, &outer->F, freedom->direction, next_turn(link, i)), own = freedom->sign * angle;
        p[freedom->p] = freedom->kind == ZD_SPACE_ADVANCES ? nearest_turn(own, along / freedom->length) : own;
        v[freedom->v] = freedom->sign * zd_inner3(turning, e);
        zd_space_tree_turn_axes(&now->F, freedom->direction, angle);
        now->spin = zd_plus3(now->spin, zd_times3(zd_inner3(turning, e), e));
    }
}

static void write_turned(zd_space_axes own, double *q)
{
    static const zd_space_axes drawn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    write_quaternion(&drawn, &own, q);
}

void zd_space_tree_quaternion(const double *axes, double *q)
{
    write_turned((zd_space_axes){{zd_vector3_of(axes), zd_vector3_of(axes + 3), zd_vector3_of(axes + 6)}}, q);
}

static void read_free(const zd_space_link *link, zd_space_pose pose, zd_space_twist twist, double *p, double *v)
{
    write_vector(pose.at, p + link->p);
    write_vector(twist.speed, v + link->v);
    if (!link->turns) return;
    write_turned((zd_space_axes){{pose.turned.x, pose.turned.y, pose.turned.z}}, p + link->p + ZD_POINT_COORDINATES);
    write_vector(zd_rotated_back3(&pose.turned, twist.spin), v + link->v + ZD_POINT_COORDINATES);
}

void zd_space_tree_state(const zd_space *space, const double *poses, const double *twists, double *p, double *v)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    for (int body = 1; body <= tree->bodies; body++) {
        const zd_space_link *link = tree->link + body;
        const zd_space_pose pose = given_pose(poses, body);
        const zd_space_twist twist = given_twist(twists, body);
        if (link->is_free) {
            read_free(link, pose, twist, p, v);
            continue;
        }
        const side outer = side_of(pose, twist, link->far, &link->far_axes);
        side now = side_of(given_pose(poses, link->inner), given_twist(twists, link->inner), link->near, &link->near_axes);
        for (int i = 0; i < link->freedoms; i++) read_freedom(link, i, &outer, &now, p, v);
    }
    zd_space_tree_follow(space, p);
}
