#ifndef ZD_NONFINITE_H
#define ZD_NONFINITE_H

#include "run.h"

/* The term that is to blame for a failure, and where; 0: none is. */
int zd_run_not_finite(zd_run *run, int status, double *t);

#endif
