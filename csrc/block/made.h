/* A block that has become a mechanism. */
#ifndef ZD_BLOCK_MADE_H
#define ZD_BLOCK_MADE_H

#include "laws.h"
#include "names.h"

struct zd_block {
    double *word;               /* its own copy */
    size_t size;                /* bytes */
    zd_block_layout layout;
    zd_block_laws laws;
    zd_block_names names;
    void *mechanism;            /* zd_plane or zd_space */
    zd_relation *row;           /* (m,) planned rows of the mechanism */
    zd_generalized_force *force;
    int *output;                /* (outputs,) */
    zd_outputs outputs;
    zd_system system;
};

/* Checks of inputs and parameters; 1, or 0 with the reason. */
int zd_block_inputs_check(const zd_block *block, zd_complaint to);
int zd_block_parameters_check(const zd_block_layout *layout, zd_complaint to);

#endif
