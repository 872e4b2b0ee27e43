/* User functions of forces that read reactions and accelerations, which are solved together with the accelerations. */
#ifndef ZD_REACTIONS_H
#define ZD_REACTIONS_H

#include "motion.h"

/* Solves for what user functions of the system read, if any do so, at each evaluation of the accelerations. */
void zd_reactions_create(zd_motion *motion, zd_arena *arena);
/* u (functions,) <- values of the user functions at a state where vdot and lambda are given. Returns ZD_DONE, ZD_SEVERAL_MOTIONS,
 * ZD_NO_MEMORY, or what a user function returns that failed. */
int zd_reactions_given(const zd_system *system, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                       double *u);

#endif
