/* The named functions of a mechanism's motion. */
#ifndef ZD_PLANE_MEASURES_H
#define ZD_PLANE_MEASURES_H

#include "plan.h"

/* Fills in the names and sizes of the measures that the mechanism has been told. */
zd_measures zd_plane_measures(const zd_plane *self, zd_measure *measure);

#endif
