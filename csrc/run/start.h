#ifndef ZD_START_H
#define ZD_START_H

#include "run.h"

/* Checks the start, the system and the tolerance, and prepares the first step. `status` is that of finding the rank. */
int zd_run_start(zd_run *run, int status, const double *p0, const double *v0);
/* The same from another start with other data, for a run that is not advanced afterwards: sets its scales, energy and first step, and the
 * acceleration if it has no closed-form functions. ZD_SINGULAR if neither closed-form functions nor blocks apply at this start. */
size_t zd_run_start_memory(const zd_run *run);      /* bytes of temporary memory for zd_run_start_elsewhere() */
int zd_run_start_elsewhere(zd_run *run, void *memory, const void *data, const double *p0, const double *v0);
/* Measures sizes anew at the present point, and compares positions with them: the largest violation, and true if a start may have it. */
int zd_start_measure(zd_run *run, double *violation, int *is_allowed);

#endif
