/* States between the rows of a run in which every step was saved, after the run. */
#ifndef ZD_RESAMPLE_H
#define ZD_RESAMPLE_H

#include "run.h"

typedef struct zd_resample {
    zd_run *run;            /* from the same start, of which no step was made */
    const zd_saved *saved;
    int64_t row;            /* the step made again last begins there; -1: none was */
    int is_general;         /* whether it leaves the direct road */
    int has_polynomial;     /* whether one leads through it */
} zd_resample;

/* Takes the motion of the run to t, which is from the first to the last row. */
int zd_resample_move(zd_resample *self, double t);

#endif
