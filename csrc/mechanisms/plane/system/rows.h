/* The rows of C: constraints of joints, and relations. */
#ifndef ZD_PLANE_ROWS_H
#define ZD_PLANE_ROWS_H

#include "../plan.h"

/* Phi, C, Phi_t and xi, as far as they are wanted, from a frame that is placed and moving; C is zero before. Returns ZD_DONE or
 * ZD_CALLBACK. */
int zd_plane_rows_write(const zd_plane *self, const zd_plane_frame *frame, int want, double t, const zd_terms *out);
/* frame->wrench += scale times the wrenches of a unit multiplier of the row. */
void zd_plane_row_act(const zd_plane *self, const zd_plane_frame *frame, const zd_relation *row, const double *factors, double scale);

#endif
