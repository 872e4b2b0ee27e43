/* The table of force elements in space. A new entry is a new file and one word here. */
#include "element.h"

#include <stddef.h>

#define ELEMENTS(X) X(zd_space_spring) X(zd_space_bushing) X(zd_space_torsion_spring) X(zd_space_force) X(zd_space_torque)

#define DECLARE_ELEMENT(name) extern const zd_space_element_kind name;
#define ADDRESS(name) &name,

ELEMENTS(DECLARE_ELEMENT)

static const zd_space_element_kind *const elements[] = {ELEMENTS(ADDRESS)};

enum { ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_space_element_kinds(void) { return ELEMENT_COUNT; }

const zd_space_element_kind *zd_space_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? elements[row] : NULL; }
