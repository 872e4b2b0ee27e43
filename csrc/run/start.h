#ifndef ZD_START_H
#define ZD_START_H

#include "run.h"

/* Refuses a start that violates the constraints, or a system or tolerance that nothing can be done with; else the first step may begin.
 * `status` is what came of finding the rank. */
int zd_run_start(zd_run *run, int status, const double *p0, const double *v0);
/* The same for a run that is not to be advanced: from another start, with other data, whose units, energy and first step it has then; the
 * acceleration, too, if it has no direct functions, which whoever has them asks for that. Where the start is not one that they or blocks
 * can begin with, that is a status, too. */
size_t zd_run_start_memory(const zd_run *run);      /* bytes that this needs meanwhile */
int zd_run_start_elsewhere(zd_run *run, void *memory, const void *data, const double *p0, const double *v0);

#endif
