/* A frame goes along the freedoms of each joint, from a point of the inner body to the joint's point of the outer one.
 *
 * In it stands what moves so far. With omega its angular velocity, a direction e of it has the rate omega x e, also where it turns about
 * e; so where vdot is zero, a turn at the rate s adds omega x (s e) to the angular acceleration, and a slide by the way d at the rate s adds
 * alpha x d + omega x (omega x d) + 2 omega x (s e) to the acceleration of the point.
 */
#include "links.h"

#include "../../include/zerodrift/sines.h"

/* ---- poses ---- */

static zd_space_axes turned_axes(const zd_rotation *R, const zd_space_axes *own)
{
    return (zd_space_axes){{zd_rotated3(R, own->d[0]), zd_rotated3(R, own->d[1]), zd_rotated3(R, own->d[2])}};
}

void zd_space_tree_turn_axes(zd_space_axes *F, int direction, double angle)
{
    const int i = (direction + 1) % 3, k = (direction + 2) % 3;
    double c, s;
    zd_sines(1, &angle, &s, &c);
    const zd_vector3 a = F->d[i], b = F->d[k];
    F->d[i] = zd_plus3(zd_times3(c, a), zd_times3(s, b));
    F->d[k] = zd_minus3(zd_times3(c, b), zd_times3(s, a));
}

static void swing_axes(zd_space_axes *F, const double *q)
{
    const zd_rotation R = zd_rotation_of(q), all = {F->d[0], F->d[1], F->d[2]};
    *F = (zd_space_axes){{zd_rotated3(&all, R.x), zd_rotated3(&all, R.y), zd_rotated3(&all, R.z)}};
}

/* Moves the joint's frame and origin by one freedom; column <- the axes of its velocities: linear for a slide, angular otherwise. */
static void go(const zd_space_link_freedom *freedom, const double *p, zd_space_axes *F, zd_vector3 *at, zd_space_twist *column)
{
    const double *x = p + freedom->p;
    const zd_vector3 e = F->d[freedom->direction], none = {0, 0, 0}, signed_e = zd_times3(freedom->sign, e);
    zd_space_twist *own = column + freedom->v;
    switch (freedom->kind) {
    case ZD_SPACE_SLIDES:
        *at = zd_plus3(*at, zd_times3(freedom->zero + x[0], signed_e));
        own[0] = (zd_space_twist){signed_e, none};
        break;
    case ZD_SPACE_ADVANCES:
        *at = zd_plus3(*at, zd_times3(freedom->zero + freedom->length * x[0], signed_e));
        zd_space_tree_turn_axes(F, freedom->direction, freedom->sign * x[0]);
        own[0] = (zd_space_twist){zd_times3(freedom->length, signed_e), signed_e};
        break;
    case ZD_SPACE_TURNS:
        zd_space_tree_turn_axes(F, freedom->direction, freedom->sign * x[0]);
        own[0] = (zd_space_twist){none, signed_e};
        break;
    case ZD_SPACE_SWINGS:
        swing_axes(F, x);
        for (int k = 0; k < 3; k++) own[k] = (zd_space_twist){none, F->d[k]};
        break;
    }
}

static const zd_rotation AS_DRAWN = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* The body whose axes are `own` in its joint's frame F: its axis j is the sum of the frame's directions,
 * each with its j-th component in the body. */
static zd_rotation rotation_from(const zd_space_axes *F, const zd_space_axes *own)
{
    const zd_rotation all = {F->d[0], F->d[1], F->d[2]};
    const zd_vector3 *o = own->d;
    return (zd_rotation){zd_rotated3(&all, (zd_vector3){o[0].x, o[1].x, o[2].x}), zd_rotated3(&all, (zd_vector3){o[0].y, o[1].y, o[2].y}),
                         zd_rotated3(&all, (zd_vector3){o[0].z, o[1].z, o[2].z})};
}

static void place_hanging(const zd_space_link *link, const double *p, const zd_space_pose *inner, zd_space_pose *pose, zd_space_way *way,
                          zd_space_twist *column)
{
    zd_space_axes F = turned_axes(&inner->turned, &link->near_axes);
    zd_vector3 at = zd_plus3(inner->at, zd_rotated3(&inner->turned, link->near));
    for (int i = 0; i < link->freedoms; i++) {
        way->at[i] = at;
        go(link->freedom + i, p, &F, &at, column);
    }
    way->at[link->freedoms] = at;
    pose->turned = link->turns ? rotation_from(&F, &link->far_axes) : AS_DRAWN;
    pose->at = zd_minus3(at, zd_rotated3(&pose->turned, link->far));
    for (int i = 0; i < link->freedoms; i++) {     /* velocity of the mass centre due to the rotations */
        const zd_space_link_freedom *freedom = link->freedom + i;
        const zd_vector3 arm = zd_minus3(pose->at, way->at[i]);
        for (zd_space_twist *own = column + freedom->v; own < column + freedom->v + (freedom->kind == ZD_SPACE_SWINGS ? 3 : 1); own++)
            own->speed = zd_plus3(own->speed, zd_cross3(own->spin, arm));
    }
}

static void place_free(const zd_space_link *link, const double *p, zd_space_pose *pose, zd_space_twist *column)
{
    const zd_vector3 none = {0, 0, 0};
    const zd_vector3 drawn[] = {AS_DRAWN.x, AS_DRAWN.y, AS_DRAWN.z};
    pose->at = zd_vector3_of(p + link->p);
    pose->turned = link->turns ? zd_rotation_of(p + link->p + 3) : AS_DRAWN;
    const zd_vector3 own[] = {pose->turned.x, pose->turned.y, pose->turned.z};
    for (int k = 0; k < 3; k++) column[link->v + k] = (zd_space_twist){drawn[k], none};
    for (int k = 3; k < link->nv; k++) column[link->v + k] = (zd_space_twist){none, own[k - 3]};
}

void zd_space_tree_place(const zd_space *space, const zd_space_frame *frame, const double *p)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const zd_space_tree_frame own = zd_space_tree_frame_of(tree, frame);
    frame->pose[0] = (zd_space_pose){{0, 0, 0}, AS_DRAWN};
    for (int i = 0; i < tree->bodies; i++) {
        const int body = tree->order[i];
        const zd_space_link *link = tree->link + body;
        if (link->is_free) place_free(link, p, frame->pose + body, own.column);
        else place_hanging(link, p, frame->pose + link->inner, frame->pose + body, own.way + body, own.column);
    }
}

zd_rotation zd_space_tree_attitude(const zd_space_tree *tree, int body, const double *p)
{
    const zd_space_link *link = tree->link + body;
    if (!body || !link->turns) return AS_DRAWN;
    if (link->is_free) return zd_rotation_of(p + link->p + 3);
    const zd_rotation inner = zd_space_tree_attitude(tree, link->inner, p);
    zd_space_axes F = turned_axes(&inner, &link->near_axes);
    for (const zd_space_link_freedom *freedom = link->freedom; freedom < link->freedom + link->freedoms; freedom++) {
        if (freedom->kind == ZD_SPACE_SWINGS) swing_axes(&F, p + freedom->p);
        else if (freedom->kind != ZD_SPACE_SLIDES) zd_space_tree_turn_axes(&F, freedom->direction, freedom->sign * p[freedom->p]);
    }
    return rotation_from(&F, &link->far_axes);
}

/* ---- velocities ---- */

/* A point, and the frame that it is the origin of, on their way from body to body. */
typedef struct traveller {
    zd_vector3 at, speed, change;   /* change: acceleration where vdot is zero */
    zd_space_twist turning;              /* spin, and its change in the place of the speed */
} traveller;

/* From the point to another one of the same frame, which is `arm` away. */
static void carry(traveller *to, zd_vector3 arm)
{
    const zd_vector3 rate = zd_cross3(to->turning.spin, arm);
    to->speed = zd_plus3(to->speed, rate);
    to->change = zd_plus3(to->change, zd_plus3(zd_cross3(to->turning.speed, arm), zd_cross3(to->turning.spin, rate)));
}

static void slide(traveller *to, zd_vector3 rate)
{
    to->speed = zd_plus3(to->speed, rate);
    to->change = zd_plus3(to->change, zd_times3(2, zd_cross3(to->turning.spin, rate)));
}

static void turn(traveller *to, zd_vector3 rate)
{
    to->turning.speed = zd_plus3(to->turning.speed, zd_cross3(to->turning.spin, rate));
    to->turning.spin = zd_plus3(to->turning.spin, rate);
}

/* Adds the velocity of a freedom along its `column`: the linear part for a slide, the angular part otherwise. */
static void travel(traveller *to, const zd_space_link_freedom *freedom, const zd_space_twist *column, const double *v, zd_vector3 arm)
{
    const double *rate = v + freedom->v;
    const zd_space_twist *own = column + freedom->v;
    carry(to, arm);
    switch (freedom->kind) {
    case ZD_SPACE_SLIDES: slide(to, zd_times3(rate[0], own->speed)); break;
    case ZD_SPACE_ADVANCES: slide(to, zd_times3(freedom->length * rate[0], own->spin));   /* fall through */
    case ZD_SPACE_TURNS: turn(to, zd_times3(rate[0], own->spin)); break;
    case ZD_SPACE_SWINGS:
        turn(to, zd_plus3(zd_plus3(zd_times3(rate[0], own[0].spin), zd_times3(rate[1], own[1].spin)), zd_times3(rate[2], own[2].spin)));
        break;
    }
}

static void move_hanging(const zd_space *space, const zd_space_frame *frame, const zd_space_tree_frame *own, int body, const double *v)
{
    const zd_space_link *link = zd_space_tree_of(space)->link + body;
    const zd_space_twist *inner = frame->twist + link->inner, *bias = frame->bias + link->inner;
    const zd_vector3 *at = own->way[body].at, none = {0, 0, 0};
    traveller to = {.speed = inner->speed, .change = bias->speed, .turning = {.speed = bias->spin, .spin = inner->spin}};
    carry(&to, zd_minus3(at[0], frame->pose[link->inner].at));
    for (int i = 0; i < link->freedoms; i++) travel(&to, link->freedom + i, own->column, v, zd_minus3(at[i + 1], at[i]));
    carry(&to, zd_minus3(frame->pose[body].at, at[link->freedoms]));
    frame->twist[body] = (zd_space_twist){to.speed, link->turns ? to.turning.spin : none};
    frame->bias[body] = (zd_space_twist){to.change, link->turns ? to.turning.speed : none};
}

static zd_space_twist sum_of_columns(const zd_space_link *link, const zd_space_twist *column, const double *v)
{
    zd_space_twist sum = {{0, 0, 0}, {0, 0, 0}};
    for (int k = link->v; k < link->v + link->nv; k++) {
        sum.speed = zd_plus3(sum.speed, zd_times3(v[k], column[k].speed));
        sum.spin = zd_plus3(sum.spin, zd_times3(v[k], column[k].spin));
    }
    return sum;
}

static const zd_space_twist AT_REST = {{0, 0, 0}, {0, 0, 0}};

void zd_space_tree_move(const zd_space *space, const zd_space_frame *frame, const double *v)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const zd_space_tree_frame own = zd_space_tree_frame_of(tree, frame);
    frame->twist[0] = frame->bias[0] = AT_REST;
    for (int i = 0; i < tree->bodies; i++) {
        const int body = tree->order[i];
        const zd_space_link *link = tree->link + body;
        if (!link->is_free) {
            move_hanging(space, frame, &own, body, v);
            continue;
        }
        frame->twist[body] = sum_of_columns(link, own.column, v);
        frame->bias[body] = AT_REST;
    }
}

void zd_space_tree_accelerate(const zd_space *space, const zd_space_frame *frame, const double *vdot)
{
    const zd_space_tree *tree = zd_space_tree_of(space);
    const zd_space_tree_frame own = zd_space_tree_frame_of(tree, frame);
    zd_space_twist *by_vdot = own.change;
    by_vdot[0] = AT_REST;
    for (int i = 0; i < tree->bodies; i++) {
        const int body = tree->order[i], inner = tree->link[body].inner;
        const zd_space_link *link = tree->link + body;
        zd_space_twist sum = sum_of_columns(link, own.column, vdot);
        if (!link->is_free) {
            const zd_vector3 arm = zd_minus3(frame->pose[body].at, frame->pose[inner].at);
            sum.speed = zd_plus3(sum.speed, zd_plus3(by_vdot[inner].speed, zd_cross3(by_vdot[inner].spin, arm)));
            sum.spin = link->turns ? zd_plus3(sum.spin, by_vdot[inner].spin) : AT_REST.spin;
        }
        by_vdot[body] = sum;
    }
    for (int body = 1; body <= tree->bodies; body++) {
        by_vdot[body].speed = zd_plus3(by_vdot[body].speed, frame->bias[body].speed);
        by_vdot[body].spin = zd_plus3(by_vdot[body].spin, frame->bias[body].spin);
    }
}

/* ---- (1) ---- */

static void write_ones(int p, int v, int count, int nv, double *A)
{
    for (int k = 0; k < count; k++) A[(p + k) * nv + v + k] = 1;
}

void zd_space_tree_write_A(const zd_space_tree *tree, const double *p, double *A)
{
    const int nv = tree->nv;
    for (const zd_space_link *link = tree->link + 1; link <= tree->link + tree->bodies; link++) {
        if (link->is_free) {
            write_ones(link->p, link->v, ZD_POINT_COORDINATES, nv, A);
            if (link->turns) zd_write_turns(p + link->p + 3, nv, A + (link->p + 3) * nv + link->v + 3);
            continue;
        }
        for (const zd_space_link_freedom *freedom = link->freedom; freedom < link->freedom + link->freedoms; freedom++) {
            if (freedom->kind == ZD_SPACE_SWINGS) zd_write_turns(p + freedom->p, nv, A + freedom->p * nv + freedom->v);
            else write_ones(freedom->p, freedom->v, 1, nv, A);
        }
    }
}
