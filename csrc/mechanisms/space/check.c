/* Checks of bodies, joints and marker quantities in space; elements are checked in ../common/check.c. */
#include "tables.h"

#include <stddef.h>

#include "../common/check.h"
#include "plan.h"

static int is_particle(const zd_space_tables *tables, int body) { return body && tables->body[body - 1].is_particle; }

/* True if the freedom is a rotation about a point, which a particle, having no axes, cannot have. */
static int swings(const zd_space_joint_kind *kind, int freedom)
{
    return kind->freedoms && kind->freedom[freedom].kind == ZD_SPACE_SWINGS;
}

static int inboard_is_right(const zd_space_tables *tables, int i, zd_complaint to)
{
    const int inboard = tables->body[i].inboard, body = i + 1;
    if (inboard == -1) return 1;
    if (!zd_inboard_exists(body, inboard, tables->joints, to)) return 0;
    const zd_space_joint *joint = tables->joint + inboard;
    const zd_space_joint_kind *kind = zd_space_joint_kind_of(joint->kind);
    if (!zd_inboard_connects(body, inboard, joint->first, joint->second, to)) return 0;
    if (!kind->is_inboard)
        return zd_complain(to, "body %d: its inboard joint %d must be of a kind for trees, not a %s", body, inboard, kind->card.name);
    if ((is_particle(tables, joint->first) && !swings(kind, 0)) || (is_particle(tables, joint->second) && !swings(kind, kind->freedoms - 1)))
        return zd_complain(to, "body %d: its inboard joint %d must not be a %s, as a particle has no axes", body, inboard, kind->card.name);
    for (int other = 0; other < i; other++)
        if (tables->body[other].inboard == inboard)
            return zd_complain(to, "joint %d must be the inboard joint of one body, not of bodies %d and %d", inboard, other + 1, body);
    return 1;
}

static int body_is_right(const void *all, int i, zd_complaint to)
{
    const zd_space_tables *tables = all;
    const zd_space_body *body = tables->body + i;
    if (!zd_mass_is_right(i + 1, body->mass, to)) return 0;
    for (int k = 0; k < 3; k++)
        if (!zd_inertia_is_right(i + 1, body->inertia[k], body->is_particle, to)) return 0;
    return inboard_is_right(tables, i, to);
}

/* A particle has no axes: its point is its place. */
static int suits_particle(const zd_space_tables *tables, int body, const double *point)
{
    return !(body && tables->body[body - 1].is_particle) || (point[0] == 0 && point[1] == 0 && point[2] == 0);
}

static int joint_is_right(const void *all, int i, zd_complaint to)
{
    const zd_space_tables *tables = all;
    const zd_space_joint *joint = tables->joint + i;
    if (!zd_space_joint_kind_of(joint->kind))
        return zd_complain(to, "joint %d: its kind must be from 0 to %d, not %d", i, zd_space_joint_kinds() - 1, joint->kind);
    if (!zd_bodies_are_right("joint", i, joint->first, joint->second, tables->bodies, to)) return 0;
    if (joint->first == joint->second) return zd_complain(to, "joint %d: its bodies must differ, and both are %d", i, joint->first);
    return (suits_particle(tables, joint->first, joint->point1) && suits_particle(tables, joint->second, joint->point2)) ||
           zd_complain(to, "joint %d: its point on a particle must be the mass centre", i);
}

static int angles_of(const zd_space_tables *tables)
{
    int angles = 0;
    for (int i = 0; i < tables->joints; i++) angles += zd_unwrapped_angles_of(tables->joint + i);
    return angles;
}

static int quantity_is_right(const void *all, int i, zd_complaint to)
{
    const zd_space_tables *tables = all;
    const zd_space_quantity *quantity = tables->quantity + i;
    if (!zd_is_in(quantity->kind, ZD_SPACE_QUANTITIES))
        return zd_complain(to, "marker quantity %d: its kind must be from 0 to %d, not %d", i, ZD_SPACE_QUANTITIES - 1, quantity->kind);
    if (!zd_bodies_are_right("marker quantity", i, quantity->first, quantity->second, tables->bodies, to)) return 0;
    if (quantity->counted && (quantity->kind != ZD_SPACE_ANGLE || !zd_is_in(quantity->counted - 1, angles_of(tables))))
        return zd_complain(to, "marker quantity %d: it must count the turns of an angle of a joint, not of angle %d", i,
                           quantity->counted - 1);
    return (suits_particle(tables, quantity->first, quantity->point1) && suits_particle(tables, quantity->second, quantity->point2)) ||
           zd_complain(to, "marker quantity %d: its point on a particle must be the mass centre", i);
}

int zd_space_tables_are_right(const zd_space_tables *tables, char *message, int message_size)
{
    const zd_complaint to = {message, message_size};
    const zd_checked all[] = {     /* joints before the bodies whose inboard joints they are */
        {tables->joints, joint_is_right}, {tables->bodies, body_is_right}, {tables->quantities, quantity_is_right}};
    const int arrays = sizeof all / sizeof all[0];
    return zd_mechanism_is_right(tables, tables->bodies, arrays, all, &tables->elements, tables->joints, tables->quantities, to);
}
