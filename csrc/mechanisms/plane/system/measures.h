/* The named functions of a mechanism's motion. */
#ifndef ZD_PLANE_MEASURES_H
#define ZD_PLANE_MEASURES_H

#include "../plan.h"

/* Names and sizes of the mechanism's measures, in `measure`. */
zd_measures zd_plane_measures(const zd_plane *self, zd_measure *measure);
/* zd_reading.evaluate() */
int zd_plane_read(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                  double *scratch);

#endif
