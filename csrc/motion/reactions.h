/* User functions of forces that read reactions and accelerations, which are solved together with the accelerations. */
#ifndef ZD_REACTIONS_H
#define ZD_REACTIONS_H

#include "motion.h"

/* Solves for what these user functions read at each evaluation of the accelerations; `inputs` of a run, or NULL. */
void zd_reactions_take(zd_motion *motion, zd_arena *arena, const zd_inputs *inputs);

#endif
