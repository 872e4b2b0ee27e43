/* The table of joints. A new entry is a new file and one word here. */
#include "joint.h"

#include <stddef.h>

#define JOINTS(X) \
    X(zd_plane_revolute) X(zd_plane_prismatic) X(zd_plane_weld) X(zd_plane_rod) X(zd_plane_slot) X(zd_plane_rolling) X(zd_plane_knife_edge)

#define DECLARE_JOINT(name) extern const zd_plane_joint_kind name;
#define ADDRESS(name) &name,

JOINTS(DECLARE_JOINT)

static const zd_plane_joint_kind *const joints[] = {JOINTS(ADDRESS)};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0] };

int zd_plane_joint_kinds(void) { return JOINT_COUNT; }

const zd_plane_joint_kind *zd_plane_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? joints[row] : NULL; }
