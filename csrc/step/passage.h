/* Passage through a bifurcation within a step. */
#ifndef ZD_PASSAGE_H
#define ZD_PASSAGE_H

#include "step_loop.h"

/* Finds the bifurcation in the step to t1; *found: true if the motion is continuous where the sign of the orientation changes. `make`: makes
 * a step to a time from the start of the last one, corrected but without checks. */
int zd_passage_find(zd_step_loop *loop, double t1, int (*make)(zd_step_loop *loop, double t), int *found);

#endif
