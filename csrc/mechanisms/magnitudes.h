/* Magnitudes of the gradients of constraints before cancellation, in joint coordinates of the plane: see zd_system. */
#ifndef ZD_MAGNITUDES_H
#define ZD_MAGNITUDES_H

int zd_mechanism_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);

#endif
