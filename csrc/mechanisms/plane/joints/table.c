/* Tables of joints and force elements. A new entry is a new file and one word here. */
#include "joint.h"

#include <stddef.h>

#define JOINTS(X) \
    X(zd_plane_revolute) X(zd_plane_prismatic) X(zd_plane_weld) X(zd_plane_rod) X(zd_plane_slot) X(zd_plane_rolling) X(zd_plane_knife_edge)
#define ELEMENTS(X) X(zd_plane_spring) X(zd_plane_bushing) X(zd_plane_torsion_spring) X(zd_plane_force) X(zd_plane_torque)

#define DECLARE_JOINT(name) extern const zd_plane_joint_kind name;
#define DECLARE_ELEMENT(name) extern const zd_plane_element_kind name;
#define ADDRESS(name) &name,

JOINTS(DECLARE_JOINT)
ELEMENTS(DECLARE_ELEMENT)

static const zd_plane_joint_kind *const joints[] = {JOINTS(ADDRESS)};
static const zd_plane_element_kind *const elements[] = {ELEMENTS(ADDRESS)};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0], ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_plane_joint_kinds(void) { return JOINT_COUNT; }

const zd_plane_joint_kind *zd_plane_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? joints[row] : NULL; }

int zd_plane_element_kinds(void) { return ELEMENT_COUNT; }

const zd_plane_element_kind *zd_plane_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? elements[row] : NULL; }
