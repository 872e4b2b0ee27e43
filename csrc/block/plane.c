/* Blocks of mechanisms in the plane. */
#include "made.h"

#include <stdio.h>
#include <string.h>

#include "../mechanisms/plane/tables.h"

#define MECHANISM zd_plane
#define OF(name) zd_plane_##name

#include "of_dimension.h"

static const zd_block_structure structure[] = {
    [ZD_BLOCK_BODIES] = ZD_STRUCTURE(zd_plane_body,
        BODY(mass, 1), BODY(inertia, 1), BODY_INT(is_particle), BODY_INT(inboard)),
    [ZD_BLOCK_JOINTS] = ZD_STRUCTURE(zd_plane_joint,
        JOINT_INT(kind), JOINT_INT(first), JOINT_INT(second), JOINT(point1, 2), JOINT(point2, 2), JOINT(axis, 2), JOINT(along, 1),
        JOINT(across, 1), JOINT(angle, 1), JOINT(length, 1)),
    [ZD_BLOCK_QUANTITIES] = ZD_STRUCTURE(zd_plane_quantity,
        QUANTITY_INT(kind), QUANTITY_INT(first), QUANTITY_INT(second), QUANTITY(point1, 2), QUANTITY(point2, 2), QUANTITY(axis,
        2), QUANTITY(zero, 1)),
};

static int make(zd_block *self, void *const *section, const zd_elements *elements, zd_complaint to)
{
    const zd_plane_tables tables = tables_of(&self->layout, section, elements);
    return set_mechanism(self, zd_plane_create(&tables, to.message, to.size));
}

static void poses(const void *mechanism, const double *p, double *poses, double *scratch)
{
    zd_plane_poses(mechanism, p, NULL, poses, NULL, scratch);
}

static const zd_plane_joint_kind *kind_of(const zd_block_layout *layout, int joint)
{
    return zd_plane_joint_kind_of((int)*zd_block_entry(layout, ZD_BLOCK_JOINTS, joint));
}

static void name_of_constraint(const zd_block_layout *layout, int joint, int component, const char *name, char *to, size_t size)
{
    static const char *const word[] = {"x", "y", "angle", "along", "across", "distance", "glide", "skid"};
    const zd_plane_joint_kind *kind = kind_of(layout, joint);
    if (kind->rows == 1) snprintf(to, size, "%s", name);
    else snprintf(to, size, "%s.%s", name, word[kind->row[component].quantity]);
}

static void state(const zd_block *block, const double *poses, double *p) { zd_plane_state(block->mechanism, poses, NULL, p, NULL); }

static int freedoms(const zd_block_layout *layout, int joint, int is_particle)
{
    switch (kind_of(layout, joint)->inboard) {
    case ZD_TURNS: return !is_particle;
    case ZD_SLIDES: return 1;
    case ZD_FIXED: return 0;
    default: return -1;
    }
}

static int is_angle_row(const zd_block_layout *layout, int joint, int component)
{
    return kind_of(layout, joint)->row[component].quantity == ZD_PLANE_ANGLE;
}

const zd_block_dimension zd_block_plane = {
    .dimension = 2, .structure = structure, .make = make, .release = release, .pose = 3, .poses = poses,
    .name_of_constraint = name_of_constraint,
    .state = state, .freedoms = freedoms, .is_angle_row = is_angle_row,
};
