/* States between the samples of a finished run that saved every step. */
#ifndef ZD_RESAMPLE_H
#define ZD_RESAMPLE_H

#include "run.h"

typedef struct zd_resample {
    zd_run *run;            /* a run from the same start, not advanced yet */
    const zd_saved *saved;
    int64_t row;            /* sample at the start of the step repeated last; -1: none */
    int is_general;         /* true if that step leaves the closed-form path for the matrix path */
    int has_polynomial;     /* true if its dense output is available */
} zd_resample;

/* Moves the run to time t, between the first and the last sample. */
int zd_resample_move(zd_resample *self, double t);

#endif
