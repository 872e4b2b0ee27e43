#ifndef ZD_START_H
#define ZD_START_H

#include "run.h"

/* Refuses a start that violates the constraints, or a system or tolerance that nothing can be done with; else the first step may begin.
 * `status` is what came of finding the rank. */
int zd_run_start(zd_run *run, int status, const double *p0, const double *v0);

#endif
