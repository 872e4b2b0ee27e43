/* Checks of bodies, joints and marker quantities in the plane; elements are checked in ../common/check.c. */
#include "tables.h"

#include <stddef.h>

#include "../common/check.h"

static int is_particle(const zd_plane_tables *tables, int body) { return body && tables->body[body - 1].is_particle; }

static int inboard_is_right(const zd_plane_tables *tables, int i, zd_complaint to)
{
    int inboard = tables->body[i].inboard, body = i + 1;
    if (inboard == -1) return 1;
    if (!zd_inboard_exists(body, inboard, tables->joints, to)) return 0;
    const zd_plane_joint *joint = tables->joint + inboard;
    const zd_plane_joint_kind *kind = zd_plane_joint_kind_of(joint->kind);
    if (!zd_inboard_connects(body, inboard, joint->first, joint->second, to)) return 0;
    if (kind->inboard == ZD_NOT_INBOARD)
        return zd_complain(to, "body %d: its inboard joint %d must be of a kind for trees, not a %s", body, inboard, kind->card.name);
    if (kind->inboard != ZD_TURNS && (is_particle(tables, joint->first) || is_particle(tables, joint->second)))
        return zd_complain(to, "body %d: its inboard joint %d must not be a %s, as a particle has no angle", body, inboard, kind->card.name);
    for (int other = 0; other < i; other++)
        if (tables->body[other].inboard == inboard)
            return zd_complain(to, "joint %d must be the inboard joint of one body, not of bodies %d and %d", inboard, other + 1, body);
    return 1;
}

static int body_is_right(const void *all, int i, zd_complaint to)
{
    const zd_plane_tables *tables = all;
    const zd_plane_body *body = tables->body + i;
    if (!zd_mass_is_right(i + 1, body->mass, to)) return 0;
    if (!zd_inertia_is_right(i + 1, body->inertia, body->is_particle, to)) return 0;
    return inboard_is_right(tables, i, to);
}

/* A particle has no axes: its point is its place. */
static int suits_particles(const zd_plane_tables *tables, int first, int second, const double *point1, const double *point2)
{
    return !(is_particle(tables, first) && (point1[0] != 0 || point1[1] != 0)) &&
           !(is_particle(tables, second) && (point2[0] != 0 || point2[1] != 0));
}

static int joint_is_right(const void *all, int i, zd_complaint to)
{
    const zd_plane_tables *tables = all;
    const zd_plane_joint *joint = tables->joint + i;
    const zd_plane_joint_kind *kind = zd_plane_joint_kind_of(joint->kind);
    if (!kind) return zd_complain(to, "joint %d: its kind must be from 0 to %d, not %d", i, zd_plane_joint_kinds() - 1, joint->kind);
    if (!zd_bodies_are_right("joint", i, joint->first, joint->second, tables->bodies, to)) return 0;
    if (joint->first == joint->second && !kind->row[0].nonholonomic)
        return zd_complain(to, "joint %d: its bodies must differ, and both are %d", i, joint->first);
    if (!suits_particles(tables, joint->first, joint->second, joint->point1, joint->point2))
        return zd_complain(to, "joint %d: its point on a particle must be the mass centre", i);
    return 1;
}

static int quantity_is_right(const void *all, int i, zd_complaint to)
{
    const zd_plane_tables *tables = all;
    const zd_plane_quantity *quantity = tables->quantity + i;
    if (!zd_is_in(quantity->kind, ZD_PLANE_QUANTITIES))
        return zd_complain(to, "marker quantity %d: its kind must be from 0 to %d, not %d", i, ZD_PLANE_QUANTITIES - 1, quantity->kind);
    if (!zd_bodies_are_right("marker quantity", i, quantity->first, quantity->second, tables->bodies, to)) return 0;
    if (!suits_particles(tables, quantity->first, quantity->second, quantity->point1, quantity->point2))
        return zd_complain(to, "marker quantity %d: its point on a particle must be the mass centre", i);
    return 1;
}

int zd_plane_tables_are_right(const zd_plane_tables *tables, char *message, int message_size)
{
    const zd_complaint to = {message, message_size};
    const zd_checked all[] = {     /* joints before the bodies whose inboard joints they are */
        {tables->joints, joint_is_right}, {tables->bodies, body_is_right}, {tables->quantities, quantity_is_right}};
    const int arrays = sizeof all / sizeof all[0];
    return zd_mechanism_is_right(tables, tables->bodies, arrays, all, &tables->elements, tables->joints, tables->quantities, to);
}
