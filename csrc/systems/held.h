/* A system some of whose coordinates or velocities are held where they are: what assembling a mechanism needs. */
#ifndef ZD_HELD_H
#define ZD_HELD_H

#include "../include/zerodrift/system.h"
#include "../workspace.h"

typedef struct zd_held {
    const zd_system *inner;
    const int *hold;        /* nonzero where held; NULL: nowhere */
    const double *value;    /* what is held */
    int of_positions;       /* or of velocities */
    int size_of_C;          /* how many entries the rows of `inner` have that count here; those of what is held stand behind them */
    zd_structure structure; /* that of `inner`, where it has one, and a group more for each body of which something is held */
} zd_held;

/* The holonomic constraints of `inner` and p_i = value_i. NULL where there is no memory, which is that of the store. */
const zd_system *zd_hold_positions(zd_store *store, const zd_system *inner, const int *hold, const double *p);
/* All constraints of `inner` and v_i = value_i. */
const zd_system *zd_hold_velocities(zd_store *store, const zd_system *inner, const int *hold, const double *v);

#endif
