/* The rows of C: constraints of joints, and relations. */
#ifndef ZD_PLANE_ROWS_H
#define ZD_PLANE_ROWS_H

#include "../plan.h"

/* Phi, C, Phi_t and xi, as far as they are wanted, from a frame that is placed and moving; C is zero before. Returns ZD_DONE or
 * ZD_CALLBACK. */
int zd_plane_rows_write(const zd_plane *self, const zd_plane_frame *frame, int want, double t, const zd_terms *out);
/* Second derivative of a marker quantity at vdot = 0; of zd_plane, in a moving zd_plane_frame. */
double zd_plane_bias(const void *mechanism, const void *frame, int quantity);

#endif
