/* The named functions of a mechanism's motion. */
#ifndef ZD_PLANE_MEASURES_H
#define ZD_PLANE_MEASURES_H

#include "../plan.h"

/* Names and sizes of the mechanism's measures, in `measure`. */
zd_measures zd_plane_measures(const zd_plane *self, zd_measure *measure);

#endif
