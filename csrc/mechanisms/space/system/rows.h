/* The rows of C: constraints of joints, and relations. */
#ifndef ZD_SPACE_ROWS_H
#define ZD_SPACE_ROWS_H

#include "../plan.h"

/* Phi, C, Phi_t and xi of all rows except those of point joints, as far as wanted, from a frame that is placed and moving; C must be zero
 * before. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_rows_write(const zd_space *self, const zd_space_frame *frame, int want, double t, const zd_terms *out);
/* Second derivative of a marker quantity at vdot = 0; of zd_space, in a moving zd_space_frame. */
double zd_space_bias(const void *mechanism, const void *frame, int quantity);

#endif
