#ifndef ZD_CREATE_H
#define ZD_CREATE_H

#include "run.h"

/* Creates a run at (t, p, v) and finds the rank of C there; the start is not checked yet. NULL without memory, with status and message;
 * otherwise `status` is that of finding the rank. */
zd_run *zd_run_open(const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size);

#endif
