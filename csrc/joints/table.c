/* The table of joints and that of elements. A new row is a new file and one word here. */
#include "joint.h"

#include <stddef.h>

#define JOINTS(X) X(zd_revolute) X(zd_prismatic) X(zd_weld) X(zd_rod) X(zd_slot) X(zd_rolling) X(zd_knife_edge_joint)
#define ELEMENTS(X) X(zd_spring) X(zd_torsion_spring) X(zd_bushing) X(zd_force) X(zd_torque)

#define DECLARE_JOINT(name) extern const zd_joint_kind name;
#define DECLARE_ELEMENT(name) extern const zd_element_kind name;
#define ADDRESS(name) &name,

JOINTS(DECLARE_JOINT)
ELEMENTS(DECLARE_ELEMENT)

static const zd_joint_kind *const joints[] = {JOINTS(ADDRESS)};
static const zd_element_kind *const elements[] = {ELEMENTS(ADDRESS)};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0], ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_joint_kinds(void) { return JOINT_COUNT; }

const zd_joint_kind *zd_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? joints[row] : NULL; }

int zd_element_kinds(void) { return ELEMENT_COUNT; }

const zd_element_kind *zd_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? elements[row] : NULL; }
