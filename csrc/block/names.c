/* A row is named after its joint, with the marker quantity that it sets to zero if the joint has several rows: "pin.x". */
#include "names.h"

#include <stdio.h>

#include "../mechanisms/plane/joints/joint.h"
#include "../mechanisms/space/joints/joint.h"

static int count_of(const zd_block_layout *layout, int section) { return layout->part[section].count; }

int zd_block_names_check(const zd_block_layout *layout, zd_complaint to)
{
    const int names = count_of(layout, ZD_BLOCK_NAMES);
    const int needed = count_of(layout, ZD_BLOCK_BODIES) + count_of(layout, ZD_BLOCK_JOINTS) + count_of(layout, ZD_BLOCK_RELATIONS);
    if (names && names != needed) return zd_complain(to, "names must be of all bodies, joints and relations, %d, not %d", needed, names);
    for (int i = 0; i < names; i++)
        if (!zd_block_text(layout, *zd_block_entry(layout, ZD_BLOCK_NAMES, i))) return zd_complain(to, "name %d: its text must exist", i);
    return 1;
}

static void name_in_plane(const zd_block_layout *layout, int joint, int component, const char *name, char *to, size_t size)
{
    static const char *const word[] = {"x", "y", "angle", "along", "across", "distance", "glide", "skid"};
    const zd_plane_joint_kind *kind = zd_plane_joint_kind_of((int)*zd_block_entry(layout, ZD_BLOCK_JOINTS, joint));
    if (kind->rows == 1) snprintf(to, size, "%s", name);
    else snprintf(to, size, "%s.%s", name, word[kind->row[component].quantity]);
}

static void name_in_space(const zd_block_layout *layout, int joint, int component, const char *name, char *to, size_t size)
{
    static const char *const axis[] = {"x", "y", "z"}, *const direction[] = {"axis", "normal", "third"};
    const zd_space_joint_kind *kind = zd_space_joint_kind_of((int)*zd_block_entry(layout, ZD_BLOCK_JOINTS, joint));
    const zd_space_pick *pick = &kind->row[component].pick;
    const int of = pick->quantity == ZD_SPACE_COSINE ? 3 - pick->of_first - pick->of_second : pick->of_first;
    if (kind->rows == 1) snprintf(to, size, "%s", name);
    else if (pick->quantity <= ZD_SPACE_Z) snprintf(to, size, "%s.%s", name, axis[pick->quantity]);
    else snprintf(to, size, "%s.%s %s", name, pick->quantity == ZD_SPACE_COSINE ? "about" : "along", of >= 0 && of < 3 ? direction[of] : "");
}

void zd_block_name_row(const void *names, int row, char *to, int size)
{
    const zd_block_names *self = names;
    const zd_block_layout *layout = self->layout;
    const zd_row_owner *owner = self->owner + row;
    const int is_of_joint = owner->owner == ZD_OF_JOINT;
    const int before = count_of(layout, ZD_BLOCK_BODIES) + (is_of_joint ? 0 : count_of(layout, ZD_BLOCK_JOINTS));
    to[0] = 0;
    if (!count_of(layout, ZD_BLOCK_NAMES)) return;
    const char *name = zd_block_text(layout, *zd_block_entry(layout, ZD_BLOCK_NAMES, before + owner->index));
    if (!is_of_joint) snprintf(to, (size_t)size, "%s", name);
    else if (layout->dimension == 2) name_in_plane(layout, owner->index, owner->component, name, to, (size_t)size);
    else name_in_space(layout, owner->index, owner->component, name, to, (size_t)size);
}
