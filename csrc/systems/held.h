/* A system with some of its coordinates or velocities held at given values, for the assembly of mechanisms. */
#pragma once

#include "../include/zerodrift/system.h"
#include "../workspace.h"

typedef struct zd_held {
    const zd_system *inner;
    const int *hold;        /* nonzero where held; NULL: nowhere */
    const double *value;    /* values of held coordinates or velocities */
    int of_positions;       /* true: coordinates are held; false: velocities */
    int size_of_C;          /* stored entries in C of the constraints of `inner`; those of held quantities follow */
    zd_structure structure; /* that of `inner`, if declared, with one more group for each body with held quantities */
} zd_held;

/* System with the holonomic constraints of `inner` and p_i = value_i, in memory of the store; NULL without memory. */
const zd_system *zd_hold_positions(zd_store *store, const zd_system *inner, const int *hold, const double *p);
/* System with all constraints of `inner` and v_i = value_i. */
const zd_system *zd_hold_velocities(zd_store *store, const zd_system *inner, const int *hold, const double *v);
