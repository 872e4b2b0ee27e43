/* What goes from one step of a run into the next besides where it ends, set aside while steps are made that are none of the run's. */
#ifndef ZD_CHECKPOINT_H
#define ZD_CHECKPOINT_H

#include "step.h"

typedef struct zd_checkpoint {
    int is_set;
    int has_integrator;     /* whether what the integrator remembers is in it */
    void *of_integrator, *of_chosen;    /* copies of the memories that the stepper and the motion name */
    double *y;              /* (size,): an own D gives u of v = D u back but for rounding */
    const zd_formulation *formulation;
    int was_ill_conditioned, was_deficient, was_doubtful;   /* as the rank has them */
} zd_checkpoint;

zd_checkpoint zd_checkpoint_take(zd_arena *arena, const zd_stepper *stepper);
/* At the end of a step of the run. The second keeps the formulation's choice of variables alone, which is enough where no steps are made
 * meanwhile. */
void zd_checkpoint_set(zd_checkpoint *self, const zd_stepper *stepper);
void zd_checkpoint_set_variables(zd_checkpoint *self, const zd_stepper *stepper);
/* Back to it, where the place says it is */
int zd_checkpoint_return(zd_checkpoint *self, zd_stepper *stepper, const zd_state *end);

#endif
