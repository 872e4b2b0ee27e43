/* Magnitudes before cancellation: see zd_system. Those of the gradients of constraints are for joint coordinates of the plane. */
#ifndef ZD_PLANE_MAGNITUDES_H
#define ZD_PLANE_MAGNITUDES_H

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);
int zd_plane_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch);

#endif
