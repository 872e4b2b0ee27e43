/* One step: integrated, landed at its end and corrected there, or taken back. */
#ifndef ZD_STEP_H
#define ZD_STEP_H

#include "../integrators/integrator.h"
#include "../motion/motion.h"
#include "../motion/state.h"

/* A formulation, and with it what is integrated. */
typedef struct zd_variables {
    const zd_formulation *formulation;
    void *solver;
    int size;               /* of its part of the state */
} zd_variables;

typedef struct zd_stepper {
    zd_motion *motion;
    zd_variables chosen;    /* those of the settings */
    zd_variables dependent; /* (p, v), where those lose digits; without a formulation where none can, without a solver until
                             * then: see variables.c */
    zd_system independent;  /* the sizes that its solver is laid out for */
    int capacity;           /* the largest size of the state */
    const zd_integrator *integrator;
    void *memory;           /* the integrator's, */
    zd_span memory_of_integrator;   /* and all that was laid out for it */
    double *y;              /* the integrated state: the formulation's, what corrections add, the energy input (28) */
    double t;               /* where the motion has got to */
    zd_last last;           /* the step being made */
} zd_stepper;

/* Lays out the stepper in place, with the integrator's parameters, and gives the motion its state. */
void zd_stepper_take(zd_stepper *self, zd_arena *arena, zd_motion *motion, const zd_integrator *integrator, const void *given,
                     zd_variables dependent, const zd_system *independent);
/* From t to t + h as the integrator does it, and no more. */
int zd_stepper_make(zd_stepper *self, double h);
/* y from t to t + h, where the step began being remembered. */
int zd_stepper_integrate(zd_stepper *self, double h);
/* The point at t1, with the corrections that are due in this step, or with all if it is `forced`; and y to match. */
int zd_stepper_land(zd_stepper *self, double t1, int64_t step, int forced);
/* The same with all corrections, in the variables that the step was made in. */
int zd_stepper_land_within(zd_stepper *self, double t);
/* A shorter step to a time between steps, at which all corrections are made. */
int zd_stepper_make_substep(zd_stepper *self, double t);
/* Point and y to where the step began. */
int zd_stepper_return(zd_stepper *self);

/* Point and y to (t, p, v). */
int zd_stepper_place(zd_stepper *self, double t, const double *p, const double *v);
zd_state zd_state_take(zd_arena *arena, const zd_motion *motion);
void zd_stepper_keep_place(const zd_stepper *self, zd_state *place);
int zd_stepper_return_to(zd_stepper *self, const zd_state *place);
/* The acceleration at the place where the motion is, if it is known, and if nothing but p and v says what it is; and back to it there. */
zd_cached_accelerations zd_rates_take(zd_arena *arena, const zd_motion *motion);
void zd_stepper_keep_rates(const zd_stepper *self, zd_cached_accelerations *rates);
void zd_stepper_restore_rates(zd_stepper *self, const zd_cached_accelerations *rates);

#endif
