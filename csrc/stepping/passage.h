/* End of a step, with passage through a bifurcation. */
#ifndef ZD_PASSAGE_H
#define ZD_PASSAGE_H

#include "step_loop.h"

/* Corrects and checks the integrated step at t1. A step with a bifurcation in it is repeated through that, if the settings allow it and the
 * motion is continuous there. ZD_BIFURCATION_PASSED: the settings do not allow it; ZD_BRANCH: the motion is not continuous. */
int zd_passage_land(zd_step_loop *loop, double t1);

#endif
