/* State of integrator and formulation that a step passes to the next, saved while steps are made that do not belong to the run. */
#ifndef ZD_CHECKPOINT_H
#define ZD_CHECKPOINT_H

#include "stepper.h"

typedef struct zd_checkpoint {
    int is_set;             /* true if a state is saved */
    int has_integrator;     /* true if the integrator's state is included */
    void *of_integrator, *of_chosen;    /* copies of memory_of_integrator and memory_of_chosen */
    double *y;              /* (size,): integrated state; u recomputed from v = D u would differ by rounding */
    const zd_formulation *formulation;
    int was_ill_conditioned, was_deficient, was_doubtful;   /* flags of zd_rank */
} zd_checkpoint;

zd_checkpoint zd_checkpoint_create(zd_arena *arena, const zd_stepper *stepper);
/* Save, at the end of a step of the run. The second saves the formulation's choice of variables only, which suffices if no steps are made
 * before it is restored. */
void zd_checkpoint_set(zd_checkpoint *self, const zd_stepper *stepper);
void zd_checkpoint_set_variables(zd_checkpoint *self, const zd_stepper *stepper);
/* Restores it, at the state `end` */
int zd_checkpoint_return(zd_checkpoint *self, zd_stepper *stepper, const zd_state *end);

#endif
