#ifndef ZD_CREATE_H
#define ZD_CREATE_H

#include "run.h"

/* A run standing at (t, p, v), with the rank there found, but not yet checked. NULL if there is no memory, which status and message
 * then say; otherwise status is what came of finding the rank. */
zd_run *zd_run_open(const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size);

#endif
