/* The table of force elements. A new entry is a new file and one word here. */
#include "element.h"

#include <stddef.h>

#define ELEMENTS(X) X(zd_plane_spring) X(zd_plane_bushing) X(zd_plane_torsion_spring) X(zd_plane_force) X(zd_plane_torque)

#define DECLARE_ELEMENT(name) extern const zd_plane_element_kind name;
#define ADDRESS(name) &name,

ELEMENTS(DECLARE_ELEMENT)

static const zd_plane_element_kind *const elements[] = {ELEMENTS(ADDRESS)};

enum { ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_plane_element_kinds(void) { return ELEMENT_COUNT; }

const zd_plane_element_kind *zd_plane_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? elements[row] : NULL; }
