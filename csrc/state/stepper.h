/* The integrated state of a run: integrate it, save it, return to it. */
#pragma once

#include "../constraints/rank.h"
#include "../integrators/integrator.h"
#include "../motion/motion.h"

/* A formulation, which determines the integrated variables. */
typedef struct zd_variables {
    const zd_formulation *formulation;
    void *solver;
    int size;               /* entries of its part of the state */
} zd_variables;

typedef struct zd_stepper {
    zd_motion *motion;
    zd_variables chosen;    /* formulation of the settings */
    zd_variables dependent; /* (p, v), used where the chosen variables lose digits: variables.c. No formulation if they never do */
    int capacity;           /* the largest size of the state */
    const zd_integrator *integrator;
    void *memory;           /* memory of the integrator */
    zd_span memory_of_integrator;   /* the span of all its memory */
    double *y;              /* the integrated state: the formulation's, what corrections add, the energy input (28) */
    double t;               /* s: time of the point */
    zd_last last;           /* the current step */
} zd_stepper;

/* Initializes the stepper in place, with the integrator's parameters, and attaches its state to the motion. */
void zd_stepper_create(zd_stepper *self, zd_arena *arena, zd_motion *motion, const zd_integrator *integrator, const void *given,
                     zd_variables dependent, const zd_system *independent);
/* Integrates y from t to t + h. */
int zd_stepper_make(zd_stepper *self, double h);
/* pdot (nq,) and vdot (nv,) at the point */
int zd_stepper_rates(const zd_stepper *self, double *pdot, double *vdot);
/* Saves the start of a step of size h, so that it can be undone. */
void zd_stepper_save_start(zd_stepper *self, double h);
/* Returns point and y to the start of the step. */
int zd_stepper_return(zd_stepper *self);

/* Moves point and y to (t, p, v). */
int zd_stepper_set_state(zd_stepper *self, double t, const double *p, const double *v);
zd_state zd_state_create(zd_arena *arena, const zd_motion *motion);
void zd_stepper_save_state(const zd_stepper *self, zd_state *place);
int zd_stepper_return_to(zd_stepper *self, const zd_state *place);

/* Integrated variables near a bifurcation: variables.c */

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
/* Changes back to the chosen formulation before a state is restored. */
void zd_variables_restore(zd_stepper *stepper);
/* Changes back to the chosen formulation, unless the point is still near a bifurcation. */
int zd_variables_use_chosen(zd_stepper *stepper);
