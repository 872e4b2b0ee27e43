/* What is integrated near a bifurcation. */
#ifndef ZD_VARIABLES_H
#define ZD_VARIABLES_H

#include "../constraints/rank.h"
#include "step.h"

/* (p, v), where it may have to take the place of the motion's variables; else without a formulation. */
zd_variables zd_variables_of(const zd_motion *motion, const zd_integrator *integrator, const zd_system *independent);
/* Whether the step just tried, with this status, has to be made in (p, v). */
static inline int zd_variables_lose_digits(const zd_stepper *stepper, int status)
{
    const zd_motion *motion = stepper->motion;
    return stepper->dependent.formulation && motion->formulation == stepper->chosen.formulation && motion->point->rank->was_ill_conditioned
        && status != ZD_CALLBACK && status != ZD_NO_MEMORY;
}
/* From where the step began. */
int zd_variables_use_dependent(zd_stepper *stepper);
/* Where the motion is about to be placed: that of the two which it was in before. */
void zd_variables_restore(zd_stepper *stepper, const zd_formulation *formulation);
/* From where the motion is, if it is no longer near a bifurcation. */
int zd_variables_change_back(zd_stepper *stepper);
static inline int zd_variables_use_chosen(zd_stepper *stepper)
{
    return stepper->motion->formulation == stepper->chosen.formulation ? ZD_DONE : zd_variables_change_back(stepper);
}

#endif
