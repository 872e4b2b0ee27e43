/* The end of a step, and what becomes of one within which a bifurcation lies. */
#ifndef ZD_PASSAGE_H
#define ZD_PASSAGE_H

#include "step_loop.h"

/* Lands at t1 what has been integrated, and judges it. If a bifurcation lies within the step, it is made again, through that, where
 * this is wanted and the motion leads there; else that is ZD_BIFURCATION_PASSED. */
int zd_passage_land(zd_step_loop *loop, double t1);

#endif
