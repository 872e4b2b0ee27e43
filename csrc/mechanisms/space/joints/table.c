/* The table of joints in space. A new entry is a new file and one word here. */
#include "joint.h"

#include <stddef.h>

#define JOINTS(X) \
    X(zd_space_revolute) X(zd_space_prismatic) X(zd_space_weld) X(zd_space_cylindrical) X(zd_space_screw) X(zd_space_universal) \
    X(zd_space_spherical) X(zd_space_planar) X(zd_space_rod) X(zd_space_slot) X(zd_space_rolling) \
    X(zd_space_knife_edge)


#define DECLARE_JOINT(name) extern const zd_space_joint_kind name;
#define ADDRESS(name) &name,

JOINTS(DECLARE_JOINT)

static const zd_space_joint_kind *const joints[] = {JOINTS(ADDRESS)};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0] };

int zd_space_joint_kinds(void) { return JOINT_COUNT; }

const zd_space_joint_kind *zd_space_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? joints[row] : NULL; }
