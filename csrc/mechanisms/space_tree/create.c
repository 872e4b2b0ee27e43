/* From tables to a tree: parents of bodies, their order, and the indices of their coordinates. */
#include "tree.h"

#include <stdio.h>
#include <string.h>

#include "../../workspace.h"
#include "links.h"

typedef struct parts {
    zd_space_tree *tree;
    zd_space_link *link;
    int *order, *lengths, *quaternion;
    int quaternions, followers;
} parts;

static void create_parts(const zd_space_tables *tables, zd_arena *arena, parts *to)
{
    const size_t bodies = tables->bodies;
#define TAKE(member, count) to->member = zd_arena_bytes(arena, (count) * sizeof *to->member)
    TAKE(tree, 1);
    TAKE(link, bodies + 1);
    TAKE(order, bodies);
    TAKE(lengths, (ZD_BODY_COORDINATES + ZD_BODY_VELOCITIES) * bodies + ZD_SPACE_COORDINATES * (size_t)tables->joints);
    TAKE(quaternion, bodies);
#undef TAKE
}

/* ---- links ---- */

static zd_space_axes axes_of(const double frame[3][3])
{
    return (zd_space_axes){{zd_vector3_of(frame[0]), zd_vector3_of(frame[1]), zd_vector3_of(frame[2])}};
}

static int coordinates_of(enum zd_space_freedom_kind kind) { return kind == ZD_SPACE_SWINGS ? 4 : 1; }
static int velocities_of(enum zd_space_freedom_kind kind) { return kind == ZD_SPACE_SWINGS ? 3 : 1; }

/* Connection of a body to its parent by its inboard joint; a particle has no orientation, so that it has no rotation about a point. */
static zd_space_link hang_on(const zd_space_joint *joint, int is_second, int turns)
{
    const zd_space_joint_kind *kind = zd_space_joint_kind_of(joint->kind);
    zd_space_link link = {
        .inner = is_second ? joint->first : joint->second,
        .turns = turns,
        .near = zd_vector3_of(is_second ? joint->point1 : joint->point2), .far = zd_vector3_of(is_second ? joint->point2 : joint->point1),
        .near_axes = axes_of(is_second ? joint->frame1 : joint->frame2), .far_axes = axes_of(is_second ? joint->frame2 : joint->frame1),
    };
    for (int i = 0; i < kind->freedoms; i++) {
        const zd_space_freedom *freedom = kind->freedom + (is_second ? i : kind->freedoms - 1 - i);
        if (freedom->kind == ZD_SPACE_SWINGS && !turns) continue;
        link.freedom[link.freedoms++] = (zd_space_link_freedom){.kind = freedom->kind, .direction = freedom->direction,
                                                                .sign = is_second ? 1 : -1,
                                             .zero = freedom->zero == ZD_SPACE_ZERO_ALONG ? joint->along : 0, .length = joint->length};
    }
    return link;
}

/* Coordinates of a body are numbered in the order of its joint's table, whichever way it is taken. */
static void number_freedoms(zd_space_link *link, parts *to)
{
    const int is_backwards = link->freedoms && link->freedom[0].sign < 0;
    for (int i = 0; i < link->freedoms; i++) {
        zd_space_link_freedom *freedom = link->freedom + (is_backwards ? link->freedoms - 1 - i : i);
        freedom->p = link->p + link->nq;
        freedom->v = link->v + link->nv;
        if (freedom->kind == ZD_SPACE_SWINGS) to->quaternion[to->quaternions++] = freedom->p;
        link->nq += coordinates_of(freedom->kind);
        link->nv += velocities_of(freedom->kind);
    }
}

static void number_free(zd_space_link *link, parts *to)
{
    link->nq = link->turns ? ZD_BODY_COORDINATES : ZD_POINT_COORDINATES;
    link->nv = link->turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES;
    if (link->turns) to->quaternion[to->quaternions++] = link->p + ZD_POINT_COORDINATES;
}

static void plan_links(const zd_space_tables *tables, parts *to)
{
    int p = 0, v = 0;
    for (int body = 1; body <= tables->bodies; body++) {
        const zd_space_body *given = tables->body + body - 1;
        zd_space_link *link = to->link + body;
        *link = (zd_space_link){.is_free = 1, .turns = !given->is_particle};
        if (given->inboard >= 0)
            *link = hang_on(tables->joint + given->inboard, tables->joint[given->inboard].second == body, !given->is_particle);
        link->p = p;
        link->v = v;
        if (link->is_free) number_free(link, to);
        else number_freedoms(link, to);
        p += link->nq;
        v += link->nv;
    }
    *to->tree = (zd_space_tree){tables->bodies, p, v, to->link, to->order};
}

/* Orders the bodies so that parents come before children, and sets their depths. Returns 0 if the tree has a loop. */
static int order_bodies(const zd_space_tree *tree, zd_space_link *link, int *order)
{
    int count = 0, before = -1;
    while (count > before) {
        before = count;
        for (int body = 1; body <= tree->bodies; body++) {
            int is_known = 0, inner_is_known = tree->link[body].inner == 0;
            for (int i = 0; i < count; i++) {
                is_known |= order[i] == body;
                inner_is_known |= order[i] == tree->link[body].inner;
            }
            if (is_known || !inner_is_known) continue;
            link[body].depth = link[link[body].inner].depth + 1;
            order[count++] = body;
        }
    }
    return count == tree->bodies;
}

/* Which entries of p are lengths, and of v lengths by time. */
static void write_lengths(const zd_space_tree *tree, int *lengths)
{
    for (const zd_space_link *link = tree->link + 1; link <= tree->link + tree->bodies; link++) {
        for (int k = 0; link->is_free && k < ZD_POINT_COORDINATES; k++) lengths[link->p + k] = lengths[tree->nq + link->v + k] = 1;
        for (int i = 0; i < link->freedoms; i++)
            if (link->freedom[i].kind == ZD_SPACE_SLIDES) lengths[link->freedom[i].p] = lengths[tree->nq + link->freedom[i].v] = 1;
    }
}

/* ---- the system ---- */

/* Which coordinate of a link is its joint's angle of that number, in the order of the joint's table. */
static int place_of_angle(const zd_space_link *link, int number)
{
    const int is_backwards = link->freedoms && link->freedom[0].sign < 0;
    for (int i = 0; i < link->freedoms; i++) {
        const zd_space_link_freedom *freedom = link->freedom + (is_backwards ? link->freedoms - 1 - i : i);
        const int turns = freedom->kind == ZD_SPACE_TURNS || freedom->kind == ZD_SPACE_ADVANCES;
        if (turns && number-- == 0) return freedom->p;
    }
    return -1;
}

/* Angles of joints outside the tree are dependent coordinates, after those of the tree. */
static void place_angles(zd_space *self, parts *to)
{
    const int end = to->tree->nq;
    for (int k = 0; k < self->unwrapped.count; k++) {
        const zd_space_planned_joint *joint = self->planned + self->unwrapped.joint[k];
        self->unwrapped.place[k] = joint->carried ? place_of_angle(to->link + joint->carried, k - joint->angles) : end + to->followers++;
    }
    to->tree->nq += to->followers;
}

/* The mechanism with its system in the coordinates of the tree: matrices are dense. */
static void carry_bodies(zd_space *self, const parts *from)
{
    const zd_space_tree *tree = from->tree;
    memset(self->point_joints.has_row, 0, self->elements.m * sizeof *self->point_joints.has_row);
    self->point_joints.count = self->point_joints.turns = self->point_joints.are_all = 0;
    self->carrying = (zd_carrying){zd_space_tree_place, zd_space_tree_move, zd_space_tree_act, zd_space_tree_reaction,
                                   zd_space_tree_frame_size(tree->bodies, tree->nv),
                                   from->tree};
    zd_system *system = &self->system;
    system->nq = tree->nq;
    system->nv = tree->nv;
    if (!from->quaternions && !from->followers) system->provides &= ~ZD_A;
    zd_space_frame_divide(self);
    system->evaluate = zd_space_tree_evaluate;
    system->lengths = from->lengths;
    system->structure = NULL;
    system->operations = NULL;
    system->quaternions = from->quaternions;
    system->quaternion = from->quaternion;
    system->followers = from->followers;
    system->follow = from->followers ? zd_space_tree_follow : NULL;
    system->magnitudes = zd_space_tree_magnitudes;
    system->magnitudes_scratch = system->scratch;
    system->force_magnitudes = zd_space_tree_force_magnitudes;
}

static zd_space *refuse(zd_space *space, void *memory, const char *why, char *message, int message_size)
{
    snprintf(message, message_size, "%s", why);
    zd_release(memory);
    zd_space_free(space);
    return NULL;
}

zd_space *zd_space_tree_create(const zd_space_tables *tables, char *message, int message_size)
{
    zd_space *self = zd_space_create(tables, message, message_size);
    if (!self) return NULL;
    zd_arena arena = {0};
    parts all = {.quaternions = 0};
    create_parts(tables, &arena, &all);
    if (!zd_arena_allocate(&arena)) return refuse(self, NULL, "there is no memory for the mechanism", message, message_size);
    create_parts(tables, &arena, &all);
    plan_links(tables, &all);
    if (!order_bodies(all.tree, all.link, all.order)) return refuse(self, arena.base, "the tree of inboard joints must have no loop",
                                                                    message, message_size);
    place_angles(self, &all);
    write_lengths(all.tree, all.lengths);
    carry_bodies(self, &all);
    return self;
}
