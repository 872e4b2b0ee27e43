/* Magnitudes of the gradients of constraints before cancellation, in joint coordinates of the plane: see zd_system. */
#ifndef ZD_PLANE_MAGNITUDES_H
#define ZD_PLANE_MAGNITUDES_H

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);

#endif
