/* Copies of the state of a run, to which it returns so that the bits of the next step do not change. */
#pragma once

#include "stepper.h"

/* Sections of a snapshot besides the state of the motion, which it always has. */
enum {
    ZD_ACCELERATIONS = 1,   /* accelerations there, if known and functions of p and v only: a step from there evaluates none */
    ZD_VARIABLES = 2,          /* the formulation's choice of variables and constraints, where only values within the step follow */
    ZD_MEMORY = 4           /* the same, and what the integrator passes to the next step */
};

typedef struct zd_snapshot {
    zd_state state;         /* p and v are in y if the integrated state begins with them */
    int sections;
    int has_accelerations;  /* true if accelerations are functions of p and v only */
    zd_cached_accelerations accelerations;
    int is_factored;        /* true if the leading matrix is factored there, and accelerations are not known */
    void *of_integrator, *of_chosen;    /* copies of memory_of_integrator and memory_of_chosen */
    double *y;              /* (size,): integrated state; u recomputed from v = D u would differ by rounding */
    int is_dependent;       /* true if (p, v) have replaced the chosen variables */
    int was_ill_conditioned, was_deficient, was_doubtful;   /* flags of zd_rank */
} zd_snapshot;

zd_snapshot zd_snapshot_create(zd_arena *arena, const zd_stepper *stepper);
/* Takes these sections, instead of what it held. */
void zd_snapshot_take(zd_snapshot *self, zd_stepper *stepper, int sections);
/* Returns the motion to the state, with all that was taken. */
int zd_snapshot_restore(zd_snapshot *self, zd_stepper *stepper);
