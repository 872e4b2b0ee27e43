/* Blocks of mechanisms in space. */
#include "made.h"

#include <stdio.h>
#include <string.h>

#include "../mechanisms/space_tree/tree.h"

#define MECHANISM zd_space
#define OF(name) zd_space_##name

#include "of_dimension.h"

static const zd_block_structure structure[] = {
    [ZD_BLOCK_BODIES] = ZD_STRUCTURE(zd_space_body,
        BODY(mass, 1), BODY(inertia, 3), BODY_INT(is_particle), BODY_INT(inboard)),
    [ZD_BLOCK_JOINTS] = ZD_STRUCTURE(zd_space_joint,
        JOINT_INT(kind), JOINT_INT(first), JOINT_INT(second), JOINT(point1, 3), JOINT(point2, 3), JOINT(frame1, 9), JOINT(frame2,
        9), JOINT(semiaxes, 3), JOINT(along, 1), JOINT(length, 1)),
    [ZD_BLOCK_QUANTITIES] = ZD_STRUCTURE(zd_space_quantity,
        QUANTITY_INT(kind), QUANTITY_INT(first), QUANTITY_INT(second), QUANTITY(point1, 3), QUANTITY(point2, 3), QUANTITY(a, 3),
        QUANTITY(o, 3), QUANTITY(b, 3), QUANTITY(shape, 9), QUANTITY(zero, 1), QUANTITY_INT(counted)),
};

static int make(zd_block *self, void *const *section, const zd_elements *elements, zd_complaint to)
{
    const zd_space_tables tables = tables_of(&self->layout, section, elements);
    int has_tree = 0;
    for (int i = 0; i < tables.bodies; i++) has_tree |= tables.body[i].inboard >= 0;
    return set_mechanism(self, (has_tree ? zd_space_tree_create : zd_space_create)(&tables, to.message, to.size));
}

static void poses(const void *mechanism, const double *p, double *poses, double *scratch)
{
    zd_space_tree_poses(mechanism, p, NULL, poses, NULL, scratch);
}

static void name_of_constraint(const zd_block_layout *layout, int joint, int component, const char *name, char *to, size_t size)
{
    static const char *const axis[] = {"x", "y", "z"}, *const direction[] = {"axis", "normal", "third"};
    const zd_space_joint_kind *kind = zd_space_joint_kind_of((int)*zd_block_entry(layout, ZD_BLOCK_JOINTS, joint));
    const zd_space_pick *pick = &kind->row[component].pick;
    const int of = pick->quantity == ZD_SPACE_COSINE ? 3 - pick->of_first - pick->of_second : pick->of_first;
    if (kind->rows == 1) snprintf(to, size, "%s", name);
    else if (pick->quantity <= ZD_SPACE_Z) snprintf(to, size, "%s.%s", name, axis[pick->quantity]);
    else snprintf(to, size, "%s.%s %s", name, pick->quantity == ZD_SPACE_COSINE ? "about" : "along", of >= 0 && of < 3 ? direction[of] : "");
}

static void state(const zd_block *block, const double *poses, double *p)
{
    for (int body = 0; body < zd_block_count(&block->layout, ZD_BLOCK_BODIES); body++, poses += 12) {
        for (int k = 0; k < 3; k++) *p++ = poses[k];
        if (zd_block_is(zd_block_entry(&block->layout, ZD_BLOCK_BODIES, body)[4], 1)) continue;       /* a particle */
        zd_space_tree_quaternion(poses + 3, p);
        p += 4;
    }
}

const zd_block_dimension zd_block_space = {
    .dimension = 3, .structure = structure, .make = make, .release = release, .pose = 12, .poses = poses,
    .name_of_constraint = name_of_constraint,
    .state = state,
};
