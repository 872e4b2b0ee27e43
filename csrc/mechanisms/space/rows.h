/* The rows of C: constraints of joints, and relations. */
#ifndef ZD_SPACE_ROWS_H
#define ZD_SPACE_ROWS_H

#include "plan.h"

/* Phi, C, Phi_t and xi of rows that are of no socket, as far as they are wanted, from a frame that is placed and moving; C is zero before.
 * Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_rows_write(const zd_space *self, const zd_space_frame *frame, int want, double t, const zd_terms *out);
#endif
