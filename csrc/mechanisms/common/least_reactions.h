/* Multipliers of the least reactions, where constraints are redundant. */
#ifndef ZD_COMMON_LEAST_REACTIONS_H
#define ZD_COMMON_LEAST_REACTIONS_H

#include "output_spec.h"

/* to (m,) <- multipliers with the same generalized force C^T lambda, for which the sum over all joints and relations of force^2 +
 * (moment / length)^2 is least. The frame is placed and moving. Returns ZD_DONE, ZD_NO_MEMORY or ZD_CALLBACK. */
int zd_least_reactions(const zd_measuring *self, const zd_measured_state *at, double *to);

/* N (m, m) <- `count` redundant multipliers, C^T n = 0, one after another; total <- norm of the weighted wrenches S N. As above. */
int zd_redundant_multipliers(const zd_measuring *self, const zd_measured_state *at, double *N, int *count, double *total);

#endif
