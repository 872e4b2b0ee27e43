/* Magnitudes of the gradients of constraints and of generalized forces before cancellation, in joint coordinates of space: see zd_system. */
#ifndef ZD_SPACE_TREE_MAGNITUDES_H
#define ZD_SPACE_TREE_MAGNITUDES_H

int zd_space_tree_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);
int zd_space_tree_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                                   double *scratch);

#endif
