/* Integrated variables near a bifurcation: variables.c */
#ifndef ZD_VARIABLES_H
#define ZD_VARIABLES_H

#include "../constraints/rank.h"
#include "stepper.h"

/* (p, v), if it may have to replace the motion's variables; otherwise without a formulation. */
zd_variables zd_variables_of(const zd_motion *motion, const zd_integrator *integrator, const zd_system *independent);
/* True if the attempted step, with this status, must be repeated in (p, v). */
static inline int zd_variables_lose_digits(const zd_stepper *stepper, int status)
{
    const zd_motion *motion = stepper->motion;
    return stepper->dependent.formulation && motion->formulation == stepper->chosen.formulation && motion->point->rank->was_ill_conditioned
        && status != ZD_CALLBACK && status != ZD_NO_MEMORY;
}
/* Returns to the start of the step and changes to (p, v). */
int zd_variables_use_dependent(zd_stepper *stepper);
/* Changes to the given formulation before a state is restored. */
void zd_variables_restore(zd_stepper *stepper, const zd_formulation *formulation);
/* Changes back to the chosen formulation, unless the point is still near a bifurcation. */
int zd_variables_use_chosen(zd_stepper *stepper);

#endif
