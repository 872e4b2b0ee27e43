/* A row is named after its joint, with the marker quantity that it sets to zero if the joint has several rows: "pin.x". */
#include "made.h"

#include <stdio.h>

int zd_block_names_check(const zd_block_layout *layout, zd_complaint to)
{
    const int names = zd_block_count(layout, ZD_BLOCK_NAMES);
    const int needed = zd_block_count(layout, ZD_BLOCK_BODIES) + zd_block_count(layout, ZD_BLOCK_JOINTS)
                       + zd_block_count(layout, ZD_BLOCK_RELATIONS);
    if (names && names != needed) return zd_complain(to, "names must be of all bodies, joints and relations, %d, not %d", needed, names);
    for (int i = 0; i < names; i++)
        if (!zd_block_text(layout, *zd_block_entry(layout, ZD_BLOCK_NAMES, i))) return zd_complain(to, "name %d: its text must exist", i);
    return 1;
}

void zd_block_name_row(const void *names, int row, char *to, int size)
{
    const zd_block_names *self = names;
    const zd_block_layout *layout = self->layout;
    const zd_constraint_owner *owner = self->owner + row;
    const int is_of_joint = owner->owner == ZD_OF_JOINT;
    const int before = zd_block_count(layout, ZD_BLOCK_BODIES) + (is_of_joint ? 0 : zd_block_count(layout, ZD_BLOCK_JOINTS));
    to[0] = 0;
    if (!zd_block_count(layout, ZD_BLOCK_NAMES)) return;
    const char *name = zd_block_text(layout, *zd_block_entry(layout, ZD_BLOCK_NAMES, before + owner->index));
    if (!is_of_joint) snprintf(to, size, "%s", name);
    else layout->of->name_of_constraint(layout, owner->index, owner->component, name, to, size);
}
