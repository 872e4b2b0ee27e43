/* User functions of a block: checks, and evaluation. */
#ifndef ZD_BLOCK_LAWS_H
#define ZD_BLOCK_LAWS_H

#include "layout.h"

typedef struct zd_block_laws {
    const zd_block_layout *layout;
    const double *speed;        /* (inputs, 3) */
    double *value;              /* values of instructions, as many as the longest law has */
} zd_block_laws;

/* Number of instructions of the longest law, or -1 with the reason if an entry is wrong. */
int zd_block_laws_check(const zd_block_layout *layout, zd_complaint to);
/* True if a law has these numbers of marker quantities and results. */
int zd_block_law_suits(const zd_block_layout *layout, int law, int terms, int results);
/* A zd_law; its owner is a zd_block_laws. */
int zd_block_law(void *owner, int law, double t, const double *x, const double *xdot, double *out);

#endif
