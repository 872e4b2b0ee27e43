/* Tables of joints and force elements in space. A new entry is a new file and one word here. */
#include "joint.h"

#include <stddef.h>

#define JOINTS(X) \
    X(zd_space_revolute) X(zd_space_prismatic) X(zd_space_weld) X(zd_space_cylindrical) X(zd_space_screw) X(zd_space_universal) \
    X(zd_space_spherical) X(zd_space_planar) X(zd_space_rod) X(zd_space_slot) X(zd_space_rolling) \
    X(zd_space_knife_edge)

#define ELEMENTS(X) X(zd_space_spring) X(zd_space_bushing) X(zd_space_torsion_spring) X(zd_space_force) X(zd_space_torque)

#define DECLARE_JOINT(name) extern const zd_space_joint_kind name;
#define DECLARE_ELEMENT(name) extern const zd_space_element_kind name;
#define ADDRESS(name) &name,

JOINTS(DECLARE_JOINT)
ELEMENTS(DECLARE_ELEMENT)

static const zd_space_joint_kind *const joints[] = {JOINTS(ADDRESS)};
static const zd_space_element_kind *const elements[] = {ELEMENTS(ADDRESS)};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0], ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_space_joint_kinds(void) { return JOINT_COUNT; }

const zd_space_joint_kind *zd_space_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? joints[row] : NULL; }

int zd_space_element_kinds(void) { return ELEMENT_COUNT; }

const zd_space_element_kind *zd_space_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? elements[row] : NULL; }
