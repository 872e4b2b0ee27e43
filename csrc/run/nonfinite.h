#ifndef ZD_NONFINITE_H
#define ZD_NONFINITE_H

#include "run.h"

/* Bit of the non-finite term that caused a failure, and *t <- its time; 0: there is none. */
int zd_run_not_finite(zd_run *run, int status, double *t);

#endif
