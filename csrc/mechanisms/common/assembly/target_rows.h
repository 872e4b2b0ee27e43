/* Rows of targets: measures of the start. */
#ifndef ZD_TARGET_ROWS_H
#define ZD_TARGET_ROWS_H

#include "rows.h"

/* Residuals and rows (not scaled) of the targets of these roles at p, of positions or of velocities, after those that there are */
void zd_assembly_add_targets(zd_assembly *self, int roles, int is_rate, const double *p);
/* Values at p of targets of positions that stay */
void zd_assembly_keep(zd_assembly *self, const double *p);

#endif
