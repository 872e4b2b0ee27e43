/* A system some of whose coordinates or velocities are held where they are: what assembling a mechanism needs. */
#ifndef ZD_HELD_H
#define ZD_HELD_H

#include "../include/zerodrift/system.h"

typedef struct zd_held {
    const zd_system *inner;
    const int *hold;        /* nonzero where held; NULL: nowhere */
    const double *value;    /* what is held */
} zd_held;

/* The holonomic constraints of `inner` and p_i = value_i. */
zd_system zd_hold_positions(zd_held *held, const zd_system *inner, const int *hold, const double *p);
/* All constraints of `inner` and v_i = value_i. */
zd_system zd_hold_velocities(zd_held *held, const zd_system *inner, const int *hold, const double *v);

#endif
