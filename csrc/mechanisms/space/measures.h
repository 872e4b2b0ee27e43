/* What can be measured of a mechanism in space. */
#ifndef ZD_SPACE_MEASURES_H
#define ZD_SPACE_MEASURES_H

#include "plan.h"

/* Those of self->observed, self->measures.count of them, of which `measure` has room for the descriptions. */
zd_measures zd_space_measures(const zd_space *self, zd_measure *measure);

#endif
